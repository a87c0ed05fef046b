// lpv_reflect_args.h -- push constants of the kernels of lpv_reflect. Included by C and GLSL.
#include "shaders/common/shared.h"

#define LPV_REFLECT_BLOCK                                                                          \
    32                     // texels along the side of a block of which one workgroup sums the power
#define LPV_REFLECT_SIDE 8 // of a workgroup
#define LPV_REFLECT_LANES 64 // in it

struct lpv_reflect_args {
    tyn_uvec3 dims; // cells
    tyn_uint channels;
    tyn_vec3 tint;
    tyn_uint num_blocks;
    tyn_uint first; // deposit: tile of the first layer of threads
};
TYN_ASSERT_SIZE(lpv_reflect_args, 36);
