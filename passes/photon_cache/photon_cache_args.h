// photon_cache_args.h -- push constants of the sum of all generations. Included by C and GLSL.
#ifndef TYN_PHOTON_CACHE_ARGS_H
#define TYN_PHOTON_CACHE_ARGS_H
#include "shaders/common/shared.h"

struct photon_cache_args {
    tyn_uvec3 dims;
    tyn_uint channels; // of the moments
    tyn_vec3 tint;
    tyn_uint generations, slots;
    tyn_vec3 sun; // reference direction (M)
    float unit;   // W m of a unit
};
TYN_ASSERT_SIZE(photon_cache_args, 52);

#endif
