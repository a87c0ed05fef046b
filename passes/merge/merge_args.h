// merge_args.h -- push constants of the merge kernels. Included by C and GLSL.
#include "shaders/common/shared.h"

struct merge_args {
    tyn_uvec3 dims; // cells
    tyn_uint channels;
    tyn_vec3 tint;         // of the one channel
    tyn_uint first_radial; // local light that is not marched
    tyn_uvec3 repeat;      // medium_block.repeat
    float reach;           // of local lights, what is nearer is marched; m
};
