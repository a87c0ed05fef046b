// medium_distance.comp -- one axis of the Chebyshev distance to the nearest brick that is not empty.
//
// max(|dx|, |dy|, |dz|) is separable: the least over x of |dx|, then over y of max(|dy|, that), then z.
#include "shaders/common/scene_args.h"
#include "medium_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_UNIFORM(0, medium, medium_block medium);
layout(set = 0, binding = 1) uniform sampler3D bricks_tex; // bricks (first axis) or distances
layout(set = 0, binding = 2, r32f) writeonly uniform image3D distance_image;
TYN_ARGS(distance_args args);

const float FARTHEST = 255.0;

float distance_before(ivec3 brick)
{
    vec2 value = texelFetch(bricks_tex, brick, 0).rg;
    return args.axis == 0u ? (value.g > 0.0 ? 0.0 : FARTHEST) : value.r;
}

void main()
{
    ivec3 brick = ivec3(gl_GlobalInvocationID);
    ivec3 count = ivec3(medium.bricks);
    if (any(greaterThanEqual(brick, count))) {
        return;
    }
    uint axis = args.axis;
    int n = count[axis], here = brick[axis];
    bool periodic = medium.repeat[axis] != 0u;
    // The last brick may be thinner: across the seam of a periodic axis count one brick less.
    float seam = medium.size[axis] % TYN_BRICK != 0u ? 1.0 : 0.0;
    float best = distance_before(brick);
    for (int reach = 1; reach < (periodic ? n : max(here + 1, n - here)) && float(reach) - seam < best;
         reach++) {
        for (int side = -1; side <= 1; side += 2) {
            int there = here + side * reach;
            bool across = there < 0 || there >= n;
            if (across && !periodic) {
                continue;
            }
            ivec3 other = brick;
            other[axis] = (there + n) % n;
            float steps = float(reach) - (across ? seam : 0.0);
            best = min(best, max(steps, distance_before(other)));
        }
    }
    imageStore(distance_image, brick, vec4(best));
}
