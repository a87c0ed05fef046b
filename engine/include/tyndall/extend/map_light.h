// map_light.h -- the suns of an environment map: compact spots that hold much of its light. Tier 2.
//
// A sun of a quarter of a degree is a few texels with most of a map's energy. Any method that spreads
// the map's light over coarser directions would blur its shadows, so such spots are taken out and
// become directional lights with an angular size. What is left, the residual map, is defined by one
// rule that everybody who reads the map follows: at a texel whose centre lies within the disc of a
// sun (dot(centre, direction) >= cos_radius) it is min(texel, around), channel by channel, elsewhere
// the texel itself.
#pragma once
#include <stdint.h>

enum { TYN_MAP_SUNS_MAX = 4 };

// In the map's own frame (row 0 is +Y, the image centre looks along -Z) and in the units of its texels,
// before rotation, `radiance` and `strength`.
typedef struct tyn_map_sun {
    float direction[3]; // towards it, unit, weighted with energy
    float cos_radius;   // of its disc
    float around[3];    // radiance that it stands on
    float mean_cosine;  // of the excess about `direction`, in (0.99, 1]
    double irradiance
        [3]; // across `direction`, if all came from there: integral of the excess L - min(L, around)
} tyn_map_sun;

typedef struct tyn_map_light {
    double mean[3]; // of the map over the sphere
    double sky[3];  // of the residual map: mean - sum of irradiance / (4 pi)
    uint32_t num_suns;
    tyn_map_sun suns[TYN_MAP_SUNS_MAX]; // brightest first where discs do not overlap
} tyn_map_light;
