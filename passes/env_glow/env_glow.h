// env_glow.h -- the environment as it looks through a medium that scatters forward.
#pragma once
#include <tyndall/pass.h>
#include "scene/phase.h"
#include "shaders/light/glow_args.h"

typedef struct tyn_env_glow_params {
    // Of the colour channels. Where it varies in space, that of the largest mean cosine that matters: a narrower lobe
    // than there is shows the map too sharp, never too bright.
    tyn_phase phase[3];
} tyn_env_glow_params;

enum {
    ENV_GLOW_PORT_SKY,  // IN 2D: the map without its suns, latitude-longitude, with or without mips
    ENV_GLOW_PORT_GLOW, // OUT 3D RGBA32F: that map smeared, in the same units; levels of the forward
                        // depth along z. Read it with glow.glsl
    ENV_GLOW_PORT_SERIES,       // SCRATCH buffer struct glow_series
    ENV_GLOW_PORT_ROWS,         // SCRATCH buffer struct glow_order[m][row]: of the map
    ENV_GLOW_PORT_COEFFICIENTS, // SCRATCH buffer struct glow_coefficient[m][l]
    ENV_GLOW_PORT_LEVELS,       // SCRATCH buffer struct glow_order[level][m][row]: smeared
    ENV_GLOW_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_env_glow;
