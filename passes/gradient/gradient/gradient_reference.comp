// gradient_reference.comp -- what errors are shares of: light that all samples of level 0 see scattered towards the eye.
#include "gradient_args.h"
TYN_ARGS(gradient_args args);
#define MEDIUM_BLOCK 0
#include "shaders/medium/medium.glsl"
#include "gradient_grid.glsl"

layout(local_size_x = 256) in;
TYN_READ(1, samples, gradient_sample samples[]);
TYN_UPDATE(2, heads, gradient_head heads);

#define WORKGROUP_SIZE 256u
#define WORKGROUP_SUM float
#include "shaders/common/workgroup.glsl"

void main()
{
    const gradient_grid grid = gradient_grid_of(0u);
    const uint i = gl_LocalInvocationIndex, count = gradient_points(grid);
    // `seen` is of a volume of radius^3: of the cells' instead.
    const vec3 of_radius = grid.spacing / grid.radius;
    float sum = 0.0;
    for (uint n = i; n < count; n += 256u) {
        sum += samples[n].seen;
    }
    sum = workgroup_total(sum * of_radius.x * of_radius.y * of_radius.z);
    if (i == 0u) {
        heads.reference = sum;
    }
}
