// beam.h -- optical depth of the medium along directional lights, in grids aligned with each.
#pragma once
#include <tyndall/pass.h>
#include "scene_args.h"
#include "beam_args.h"

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
    BEAM_PORT_MEDIUM,  // IN buffer struct medium_block
    BEAM_PORT_DENSITY, // IN optional 3D: mode DENSITY
    BEAM_PORT_SIGMA_S, // IN optional 3D: mode COEFFICIENTS, as the two below
    BEAM_PORT_SIGMA_A,
    BEAM_PORT_G,
    BEAM_PORT_BEAMS,  // OUT buffer struct beam_block[]
    BEAM_PORT_COLUMN, // OUT 3D R32F: mode DENSITY, density integrated along the light: what
                      // beam.glsl reads, as the three below
    BEAM_PORT_TAU_S, // OUT 3D RGBA32F: mode COEFFICIENTS, sigma_s integrated; a = mean of the channels
    BEAM_PORT_TAU_A, // OUT 3D RGBA32F: sigma_a integrated
    BEAM_PORT_TAU_P, // OUT 3D RGBA32F: (1 - f) sigma_s integrated
    BEAM_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_beam;
