// medium_bricks.comp -- least and largest value over each brick.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_BLOCK 0
#define SHAPES 1
#define ATLAS 2
#include "medium_shapes.glsl"
#include "medium_args.h"
#include "medium_bricks.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 3) uniform sampler3D first_tex;  // density or sigma_s
layout(set = 0, binding = 4) uniform sampler3D second_tex; // sigma_a
layout(set = 0, binding = 5, rg32f) writeonly uniform image3D bricks_image;
layout(push_constant, scalar) uniform push { bricks_args args; };

// Texels that interpolation reads anywhere in the brick: its own and one more around.
vec2 brick_of_textures(ivec3 brick)
{
    ivec3 size = ivec3(medium.size);
    ivec3 first = max(brick * TYN_BRICK - 1, ivec3(0));
    ivec3 last = min(brick * TYN_BRICK + TYN_BRICK, size - 1);
    vec2 range = BRICK_NOTHING;
    for (int z = first.z; z <= last.z; z++) {
        for (int y = first.y; y <= last.y; y++) {
            for (int x = first.x; x <= last.x; x++) {
                vec3 value = texelFetch(first_tex, ivec3(x, y, z), 0).rgb;
                if (args.textures == 2u) {
                    value += texelFetch(second_tex, ivec3(x, y, z), 0).rgb;
                    value.r = max(max(value.r, value.g), value.b);
                }
                range = brick_add(range, value.r);
            }
        }
    }
    return range;
}

void main()
{
    ivec3 brick = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(brick, ivec3(medium.bricks)))) {
        return;
    }
    vec3 lo = vec3(brick) * medium.brick_size, hi = min(lo + medium.brick_size, medium.extent);
    vec2 range = brick_of_shapes(lo, hi);
    if (args.textures > 0u) {
        vec2 texels = brick_of_textures(brick);
        range = vec2(min(range.x, texels.x), max(range.y, texels.y));
    }
    imageStore(bricks_image, brick, vec4(range, 0.0, 0.0));
}
