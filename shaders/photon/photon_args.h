// photon_args.h -- caches of photons: what a cell keeps of the light that passes it. Included by C and GLSL.
//
// Sums are whole numbers, in units of power times length, so that they are the same in whatever order photons come, and what
// an old generation brought can be taken out again without a rest. A photon that a track examines at x stands for the stretch
// 1 / sigma_T of its flight: power / sigma_T, over the volume of the cell, is fluence.
#ifndef TYN_PHOTON_ARGS_H
#define TYN_PHOTON_ARGS_H
#include "shaders/common/shared.h"

// Words of a cell. "Sun": light that came from the reference direction; "sky": all other. "Mean": over the channels.
#define PHOTON_SUN 0    // by channel
#define PHOTON_COSINE 3 // mean times the cosine to the reference direction
#define PHOTON_SKY 4    // by channel
#define PHOTON_ORDER 7  // mean, of sun and sky, times scatterings / PHOTON_ORDER_UNIT
#define PHOTON_FLUX 8   // mean of the sky's times direction of travel, along the axes of M
#define PHOTON_COUNT 11 // deposits
#define PHOTON_WORDS 12

#define PHOTON_ORDER_UNIT 16.0
// What a cell may sum up to, over all generations that count: sums of int, with room for their signs.
#define PHOTON_WHOLE 2.0e9

// Head of the history "ring": m + e slots follow, of a generation each, int[cell][PHOTON_WORDS]; m generations count, e are
// renewed in a frame. Generation t is in slot t % (m + e).
struct photon_ring {
    tyn_uint turns;        // generations that were traced since it was started
    tyn_uint first, count; // of the last frame
    tyn_uint pad;
};
TYN_ASSERT_SIZE(photon_ring, 16);

// Head of the history "sum": int[cell][PHOTON_WORDS] follow, over the last m generations up to `turns`.
struct photon_sum {
    tyn_uint turns;
    tyn_uint pad[3];
};
TYN_ASSERT_SIZE(photon_sum, 16);

// Light of a cell: fluence, W/m^2, and how it is distributed.
struct photon_light {
    tyn_vec3 sun;
    float cosine; // mean, to the reference direction: g' of the lobe
    tyn_vec3 sky;
    float order;  // scatterings, mean weighted by fluence: the penetration depth
    tyn_vec3 way; // of the sky's light: net flux over fluence
    float count;  // deposits
};
TYN_ASSERT_SIZE(photon_light, 48);

#endif
