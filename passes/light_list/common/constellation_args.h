// constellation_args.h -- the lights that stand for an environment. Included by C and GLSL; scalar layout.
#ifndef TYN_CONSTELLATION_ARGS_H
#define TYN_CONSTELLATION_ARGS_H
#include "shaders/common/shared.h"

#define TYN_CONSTELLATION_MAX 64

// A distant light: all of its region's power from the region's centroid.
struct constellation_light {
    tyn_vec3 direction; // map frame, unit, towards the light
    float luminance;    // of `power`
    tyn_vec3 power;     // integral of the region's radiance over its solid angle, map units sr
    float solid_angle;  // of the region, sr
    tyn_uvec2 first;    // texels of the map's sums (sky_args.h): from `first` ...
    tyn_uvec2 end;      // ... to before `end`
};
TYN_ASSERT_SIZE(constellation_light, 48);

struct constellation_block { // storage buffer "constellation"
    tyn_uint count;          // of lights; fewer than are wanted where regions are single texels
    tyn_uvec3 pad;
    TYN_STRUCT(constellation_light) lights[TYN_CONSTELLATION_MAX];
};
TYN_ASSERT_SIZE(constellation_block, 16 + 48 * TYN_CONSTELLATION_MAX);

#endif
