// lpv_blockers_args.h -- push constants of lpv_blockers. Included by C and GLSL.
#include "shaders/common/shared.h"

#define LPV_BLOCKERS_UNIT                                                                          \
    16777216.0 // of dx^2: a column of cells has 6 sqrt(3) dx^2 in all maps together

struct lpv_blockers_args {
    tyn_vec3 extent; // of the medium, m
    tyn_uvec3 dims;  // cells
    tyn_uint texels; // of a map's side
    tyn_vec3 area;   // of a texel of the maps along each axis, m^2
};
TYN_ASSERT_SIZE(lpv_blockers_args, 40);
