// scatter_lut.h -- table of the light scattered forward any number of times along a beam.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/scene_args.h"
#include "shaders/phase/scatter_lut_args.h"

typedef struct tyn_scatter_lut_params {
    uint32_t mode;                       // TYN_MEDIUM_*
    tyn_phase phase[3];                  // DENSITY: of the colour channels
    const tyn_phase_table *tables;       // of these, if some are tables
    float g_max;                         // COEFFICIENTS: largest mean cosine of any medium
    uint32_t tms;                        // 1: also make `tms`
    uint32_t num_suns;                   // 0..4
    float mean_cosine[TYN_LUT_MAX_SUNS]; // of the suns' discs, light_block.mean_cosine, in (0, 1]
} tyn_scatter_lut_params;

// clang-format off
#define SCATTER_LUT_PORTS(X) \
    X(SCATTER_LUT, LUT, lut, OUT, IMAGE_2D, \
        "ln of the multiple forward scattering of K_tms and K_lobe over depth (x) and angle (y), a table for " \
        "each phase function above the other", .format = VK_FORMAT_R32G32_SFLOAT), \
    X(SCATTER_LUT, LUT_BLOCK, lut_block, OUT, BUFFER, \
        "struct lut_block: rows of the table: phase function, half width of the lobe"), \
    X(SCATTER_LUT, TMS, tms, OUT, IMAGE_3D, \
        "phase function of what leaves the forward lobes of light from a cone, 1/sr, over depth (x), angle " \
        "(y) and the size of the cone (z)", .format = VK_FORMAT_R32_SFLOAT), \
    X(SCATTER_LUT, COUNTERS, counters, OUT, BUFFER, "struct counters_block: texels of `tms` that were clamped"), \
    X(SCATTER_LUT, MOMENTS, moments, SCRATCH, BUFFER, \
        "Legendre moments of the phase function outside and inside the lobe"), \
    X(SCATTER_LUT, CONES, cones, SCRATCH, BUFFER, "Legendre moments c_l of the cones")
// clang-format on
TYN_PASS(SCATTER_LUT, scatter_lut);
