// residuum_collect.comp -- what all iterations sent to the eye.
#include "residuum_args.h"
#include "shaders/phase/hg.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_READ(0, sum, vec4 sum[]);
layout(set = 0, binding = 1, rgba32f) uniform writeonly image3D residuum_image;
TYN_ARGS(residuum_args args);

void main()
{
    uvec3 cell = gl_GlobalInvocationID;
    if (any(greaterThanEqual(cell, args.dims))) {
        return;
    }
    vec3 light = sum[(cell.z * args.dims.y + cell.y) * args.dims.x + cell.x].rgb;
    imageStore(residuum_image, ivec3(cell), vec4(light / (4.0 * HG_PI), 0.0));
}
