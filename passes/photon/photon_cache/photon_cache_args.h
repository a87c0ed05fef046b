// photon_cache_args.h -- push constants of the sum of all generations. Included by C and GLSL.
#include "shaders/common/shared.h"

struct photon_cache_args {
    tyn_uvec3 dims;
    tyn_uint channels; // of the moments
    tyn_vec3 tint;
    tyn_uint generations, slots, lobes;
    float unit;             // W m of a unit
    float majorant;         // > 0: light is weighted with the extinction over this, 1/m
    tyn_uint scaled;        // 1: forward scattering counts as none
    tyn_uint cell_channels; // of the medium's cells
};
TYN_ASSERT_SIZE(photon_cache_args, 56);
