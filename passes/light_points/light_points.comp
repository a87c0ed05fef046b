// light_points.comp -- see light_points.h; one thread a texel.
#include "shaders/common/scene_args.h"
#include "light_points_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_UNIFORM(0, medium, medium_block medium);
TYN_WRITE(1, points, vec3 points[]);
TYN_ARGS(light_points_args args);

void main()
{
    uvec3 texel = gl_GlobalInvocationID;
    if (all(lessThan(texel, args.size))) {
        points[(texel.z * args.size.y + texel.y) * args.size.x + texel.x] =
            (vec3(texel) + 0.5) / vec3(args.size) * medium.extent;
    }
}
