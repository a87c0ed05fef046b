// photon_view_args.h -- push constants of what the cache sends to the eye. Included by C and GLSL.
#ifndef TYN_PHOTON_VIEW_ARGS_H
#define TYN_PHOTON_VIEW_ARGS_H
#include "shaders/common/shared.h"

struct photon_view_args {
    tyn_uvec3 dims;
    tyn_vec3 sun;   // reference direction (M), of travel
    tyn_uint lobes; // 1: light that is not the sun's has a lobe too
};
TYN_ASSERT_SIZE(photon_view_args, 28);

#endif
