// refine_points_grid.comp -- see refine_points.h; one thread a texel.
#include "refine_points_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_ARGS(refine_grid_args args);
TYN_WRITE(0, points, vec3 points[]);

void main()
{
    const uvec3 texel = gl_GlobalInvocationID;
    if (all(lessThan(texel, args.size))) {
        points[(texel.z * args.size.y + texel.y) * args.size.x + texel.x] =
            (vec3(texel) + 0.5) / vec3(args.size) * args.extent;
    }
}
