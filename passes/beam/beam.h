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

enum {
    TYN_MEDIUM(TYN_BUNDLE_ENUM, BEAM), // IN
    TYN_BEAMS(TYN_BUNDLE_ENUM, BEAM),  // OUT
    BEAM_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_beam;
