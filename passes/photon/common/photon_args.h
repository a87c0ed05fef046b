// photon_args.h -- caches of photons: what a cell keeps of the light that passes it. Included by C and GLSL.
//
// Sums are whole numbers, in units of power times length, so that they are the same in whatever order photons come, and what
// an old generation brought can be taken out again without a rest. A photon that a track examines at x stands for the stretch
// 1 / sigma_T of its flight: power / sigma_T, over the volume of the cell, is fluence.
#include "shaders/common/shared.h"

// Light is kept apart by where it came from, in `lobes` of a cell: the strongest suns, regions of the map, all other. A lobe has
// two quads of words, which are in rings of their own, as a device need not bind more than 128 MiB. "Mean": over the channels.
// Of the first quad, behind the channels: mean times scatterings / PHOTON_ORDER_UNIT.
#define PHOTON_ORDER 3
// Of the second, behind the mean times direction of travel along the axes of M: deposits.
#define PHOTON_COUNT 3
#define PHOTON_MOST_LOBES 16
#define PHOTON_MOST_BYTES 134217728 // of a ring

#define PHOTON_ORDER_UNIT 16.0
// What a cell may sum up to, over all generations that count: sums of int, with room for their signs.
#define PHOTON_WHOLE 2.0e9

// Head of the history "ring": m + e slots follow, of a generation each, ivec4[lobe][cell]; m generations count, e are
// renewed in a frame. Generation t is in slot t % (m + e). The ring "flux" has the same without a head.
struct photon_ring {
    tyn_uint turns;        // generations that were traced since it was started
    tyn_uint first, count; // of the last frame
    tyn_uint pad;
};
TYN_ASSERT_SIZE(photon_ring, 16);

// Head of the history "sum": ivec4[2][lobe][cell] follow, over the last m generations up to `turns`.
struct photon_sum {
    tyn_uint turns;
    tyn_uint pad[3];
};
TYN_ASSERT_SIZE(photon_sum, 16);

// Light of a lobe of a cell.
struct photon_light {
    tyn_vec3 fluence; // W/m^2
    float order;      // scatterings, mean weighted by fluence: the penetration depth
    tyn_vec3 way;     // net flux over fluence (M): direction of the lobe and, as its length, g'
    float count;      // deposits
};
TYN_ASSERT_SIZE(photon_light, 32);
