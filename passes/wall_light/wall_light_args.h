// wall_light_args.h -- push constants of the kernel of pass wall_light. Included by C and GLSL; scalar layout.
#include "shaders/common/shared.h"

struct wall_light_args {
    tyn_vec3 extent; // of the medium, m
    tyn_uvec3 dims;  // cells
    tyn_uint num_suns;
};
TYN_ASSERT_SIZE(wall_light_args, 28);
