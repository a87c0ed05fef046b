// env_glow.h -- the environment as it looks through a medium that scatters forward.
#pragma once
#include <tyndall/pass.h>
#include "scene/phase.h"
#include "shaders/light/glow_args.h"

typedef struct tyn_env_glow_params {
    // Of the colour channels. Where it varies in space, that of the largest mean cosine that matters: a narrower lobe
    // than there is shows the map too sharp, never too bright.
    tyn_phase phase[3];
    const tyn_phase_table *tables; // of these, if some are tables
} tyn_env_glow_params;

// clang-format off
#define ENV_GLOW_PORTS(X) \
    X(ENV_GLOW, SKY, sky, IN, IMAGE_2D, "the map without its suns, latitude-longitude, with or without mips"), \
    X(ENV_GLOW, GLOW, glow, OUT, RGBA_3D, \
        "that map smeared, in the same units; levels of the forward depth along z. Read it with glow.glsl"), \
    X(ENV_GLOW, COUNTERS, counters, OUT, BUFFER, \
        "struct counters_block: texels of the map that were not finite, of the first level that were clamped"), \
    X(ENV_GLOW, SERIES, series, SCRATCH, BUFFER, \
        "struct glow_series: Legendre moments of the kernels, weights of the rows"), \
    X(ENV_GLOW, ROWS, rows, SCRATCH, BUFFER, "struct glow_order[m][row]: of the map"), \
    X(ENV_GLOW, COEFFICIENTS, coefficients, SCRATCH, BUFFER, \
        "struct glow_coefficient[m][l]: spherical harmonics of the map"), \
    X(ENV_GLOW, LEVELS, levels, SCRATCH, BUFFER, "Fourier sums of the smeared map's rows")
// clang-format on
TYN_PASS(ENV_GLOW, env_glow);
