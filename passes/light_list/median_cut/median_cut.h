// median_cut.h -- an environment as a constellation of distant lights of equal power.
//
// After Debevec, "A median cut algorithm for light probe sampling" (SIGGRAPH 2005 posters), which Cohen and Debevec's LightGen
// is used for: the map is one region at first; a region is cut across its longer side, whose width counts with the cosine
// of its middle's latitude, so that both parts have the same energy (luminance times solid angle); each light stands at
// its region's centroid, weighted with luminance, and has all of the region's power. The region of the most energy is cut
// next, so that any number of lights is possible; of a power of two all regions are cut equally often. Cuts lie between
// the texels of the map's sums (sky_args.h): 128 x 64. A region of one texel stays, so that a map with small bright suns
// may get fewer lights than are wanted; a light's direction is finer than texels, as the sums have moments.
//
// Depends on the map alone, not on how it is turned or scaled.
#pragma once
#include <tyndall/pass.h>
#include "median_cut_args.h"

typedef struct tyn_median_cut_params {
    // Set by the method.
    uint32_t lights; // wanted, 1 to TYN_CONSTELLATION_MAX
    uint32_t map;    // 0: the environment is a constant radiance, and `sums` is absent
} tyn_median_cut_params;

// clang-format off
#define MEDIAN_CUT_PORTS(X) \
    X(MEDIAN_CUT, SUMS, sums, OPTIONAL, BUFFER, "of env_importance, with no suns taken out: struct sky_sum[]"), \
    X(MEDIAN_CUT, CONSTELLATION, constellation, OUT, BUFFER, "struct constellation_block")
// clang-format on
TYN_PASS(MEDIAN_CUT, median_cut);
