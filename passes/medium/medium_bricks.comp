// medium_bricks.comp -- least and largest value over each brick.
#define MEDIUM_BLOCK 0
#define SHAPES 1
#define ATLAS 2
#define COLORS 4
#include "medium_shapes.glsl"
#include "medium_args.h"
#include "medium_bricks.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 3, rg32f) writeonly uniform image3D bricks_image;
TYN_ARGS(bricks_args args);

void main()
{
    ivec3 brick = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(brick, ivec3(medium.bricks)))) {
        return;
    }
    vec3 lo = vec3(brick) * medium.brick_size, hi = lo + medium.brick_size;
    vec3 grow = args.grow * medium.voxel;
    vec2 range = brick_of_shapes(max(lo - grow, vec3(0.0)), min(hi + grow, medium.extent));
    imageStore(bricks_image, brick, vec4(range, 0.0, 0.0));
}
