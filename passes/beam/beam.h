// beam.h -- optical depth of the medium along directional lights, in grids aligned with each.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"
#include "shaders/beams/beam_args.h"

typedef struct tyn_beam_params {
    int32_t cells; // "beam.cells": most grid cells along an axis
    uint32_t mode; // TYN_MEDIUM_*
    uint32_t num_suns;
    uint32_t extent[3];                         // texels, set by tyn_beam_plan
    struct beam_block beams[TYN_BEAM_MAX_SUNS]; // set by tyn_beam_plan
} tyn_beam_params;

// Lays out the grids of the first num_suns (<= TYN_BEAM_MAX_SUNS) lights, which are directional, for
// params->cells, and fills the rest of params. The texture's extent depends on the medium's size and on
// which axes of its box the suns are closest to, so a moving sun seldom changes it.
void tyn_beam_plan(tyn_beam_params *params, const struct medium_block *medium,
                   const struct light_block *lights, uint32_t num_suns);

// clang-format off
#define BEAM_PORTS(X) \
    TYN_MEDIUM(X, BEAM), \
    X(BEAM, BEAMS, beams, OUT, BUFFER, "beam_block per sun: its grid"), \
    X(BEAM, COLUMN, column, OUT, IMAGE_3D, \
        "density (or sigma_s) integrated along the light, m (homogeneous: its mean)", \
        .format = VK_FORMAT_R32_SFLOAT), \
    X(BEAM, TAU_A, tau_a, OUT, RGBA_3D, "sigma_a integrated along the light, likewise"), \
    X(BEAM, TAU_P, tau_p, OUT, RGBA_3D, "sigma_s outside the forward peak integrated along the light, likewise"), \
    X(BEAM, COUNTERS, counters, OUT, BUFFER, "struct counters_block: nodes that were not finite")
// clang-format on
TYN_PASS(BEAM, beam);
