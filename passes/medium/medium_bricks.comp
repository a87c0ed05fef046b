// medium_bricks.comp -- least and largest value over each brick; one workgroup per brick.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_BLOCK 0
#define SHAPES 1
#define ATLAS 2
#include "medium_shapes.glsl"
#include "medium_args.h"
#include "medium_bricks.glsl"

layout(local_size_x = TYN_BRICK_THREADS) in;
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
    uvec3 count = uvec3(last - first + 1);
    vec2 range = BRICK_NOTHING;
    for (uint i = gl_LocalInvocationIndex; i < count.x * count.y * count.z; i += TYN_BRICK_THREADS) {
        ivec3 texel = first + ivec3(i % count.x, i / count.x % count.y, i / (count.x * count.y));
        vec3 value = texelFetch(first_tex, texel, 0).rgb;
        if (args.textures == 1u) {
            range = brick_add(range, value.r);
        } else {
            value += texelFetch(second_tex, texel, 0).rgb;
            range = brick_add(range, max(max(value.r, value.g), value.b));
        }
    }
    return brick_reduce(range);
}

void main()
{
    ivec3 brick = ivec3(gl_WorkGroupID);
    vec3 lo = vec3(brick) * medium.brick_size, hi = min(lo + medium.brick_size, medium.extent);
    vec2 range = brick_of_shapes(lo, hi);
    if (args.textures > 0u) {
        vec2 texels = brick_of_textures(brick);
        range = vec2(min(range.x, texels.x), max(range.y, texels.y));
    }
    if (gl_LocalInvocationIndex == 0u) {
        imageStore(bricks_image, brick, vec4(range, 0.0, 0.0));
    }
}
