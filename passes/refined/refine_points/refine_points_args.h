// refine_points_args.h -- push constants of the passes refine_points and refine_field. Included by C and GLSL.
#include "shaders/common/shared.h"

struct refine_grid_args {
    tyn_uvec3 size;  // texels
    tyn_vec3 extent; // of the media's box, m
};
TYN_ASSERT_SIZE(refine_grid_args, 24);
