// shdom_view_args.h -- push constants of the kernels of shdom_view. Included by C and GLSL.
#include "shaders/common/shared.h"

struct shdom_view_args {
    tyn_uvec3 dims; // cells
    tyn_uint channels;
    tyn_vec3 tint;
    tyn_uint bands;
    tyn_uint
        num_suns; // the first ordinates, whose light that scatters once the march draws; and that of all lamps
    tyn_uint lamps;
};
TYN_ASSERT_SIZE(shdom_view_args, 40);
