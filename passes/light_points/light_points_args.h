// light_points_args.h -- push constants of the kernel. Included by C and GLSL.
#include "shaders/common/shared.h"

struct light_points_args {
    tyn_uvec3 size; // texels
};
TYN_ASSERT_SIZE(light_points_args, 12);
