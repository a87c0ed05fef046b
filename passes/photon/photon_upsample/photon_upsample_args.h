// photon_upsample_args.h -- push constants of the cache's upsampling. Included by C and GLSL.
#include "shaders/common/shared.h"

#define PHOTON_FILTER_TRILINEAR 0
#define PHOTON_FILTER_DEPTH 1

#define PHOTON_LOBE_EXTRAPOLATED 0
#define PHOTON_LOBE_PRINTED 1

struct photon_upsample_args {
    tyn_uvec3 dims;     // of the fine cells
    tyn_uvec3 coarse;   // of the cache's
    tyn_uint lobes;     // of a cell, stacked along z
    tyn_uint channels;  // of the coarse cells' medium
    tyn_uint filter_is; // PHOTON_FILTER_*
    tyn_uint lobe;      // PHOTON_LOBE_*
    float majorant;     // 1/m
    tyn_uint scaled;    // 1: forward scattering counts as none
    tyn_uint
        weighted; // 1: light is the mean over the medium, and there is none where there is none of it
};
TYN_ASSERT_SIZE(photon_upsample_args, 52);
