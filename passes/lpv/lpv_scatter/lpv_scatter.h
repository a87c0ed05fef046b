// lpv_scatter.h -- light of suns and lamps that scatters for the first time, by samples along their rays.
//
// A bundle of rays leaves every light, as its shadow map does; up to where a ray meets a surface, or leaves the box, light
// that scatters at a few random places of it starts in the cells there (Billeter et al. 2012, Sec 4.1). Sums are whole
// numbers, in units of a bound of all.
#pragma once
#include <tyndall/pass.h>
#include <tyndall/extend/lattice_shape.h>
#include "shaders/common/bundles.h"
#include "lpv_scatter_args.h"

typedef struct tyn_lpv_scatter_params {
    tyn_lattice_shape shape;
    int32_t sun_texels; // "lpv_scatter.sun_texels"
    int32_t samples;    // "lpv_scatter.samples", 1..64
    // For the method, by tyn_lpv_scatter_plan:
    uint32_t mode; // TYN_MEDIUM_*
    uint32_t num_suns, num_bundles;
    float power;    // of all lights that may scatter, at most, W
    float majorant; // no place scatters more, 1/m
    struct lpv_scatter_bundle bundles[LPV_SCATTER_BUNDLES];
} tyn_lpv_scatter_params;

// Lays out the rays of suns (all with beams) and lamps through the medium's box. No place scatters more than `majorant`, 1/m.
void tyn_lpv_scatter_plan(tyn_lpv_scatter_params *params, const float extent[3], float majorant,
                          const struct light_block *suns, uint32_t num_suns,
                          const struct light_block *lamps, uint32_t num_lamps);

// clang-format off
#define LPV_SCATTER_PORTS(X) \
    TYN_MEDIUM(X, LPV_SCATTER), \
    X(LPV_SCATTER, LIGHTS, lights, IN, BUFFER, "struct light_block[]: suns"), \
    TYN_BEAMS(X##_OPTIONAL, LPV_SCATTER), \
    TYN_RADIALS(X##_OPTIONAL, LPV_SCATTER), \
    TYN_SHADOWS(X##_OPTIONAL, LPV_SCATTER), \
    TYN_WALLS(X##_OPTIONAL, LPV_SCATTER), \
    X(LPV_SCATTER, SCATTERED, scattered, OUT, BUFFER, \
        "float unit, W; uint pad[3]; ivec4[channel][cell]: power and its first moment in that unit"), \
    X(LPV_SCATTER, COUNTERS, counters, OUT, BUFFER, "struct counters_block: samples that were bounded or not finite"), \
    X(LPV_SCATTER, RAYS, rays, SCRATCH, BUFFER, "struct lpv_scatter_bundle[]")
// clang-format on
TYN_PASS(LPV_SCATTER, lpv_scatter);
