// light_chain.h -- the nodes from a density grid to probes and the balance, for tests of the
// lattice.
#pragma once
#include "gpu_test.h"
#include "shaders/common/scene_args.h"
#include "shaders/light/ordinate_args.h"
#include <tyndall/context.h>

typedef struct light_chain {
    // In. `density` may be NULL: 1 everywhere.
    float extent[3];
    tyn_extent size; // of density
    const float *density;
    float sigma_s[3], sigma_a[3], g[3], emission[3];
    uint32_t num_suns;
    float sun_color[4][3], sun_direction[4][3];
    float mean_cosine;                       // of the suns' discs; 0: points, 1
    float environment[3];                    // from all sides
    const struct ordinates_block *ordinates; // NULL: none
    int cells, sweeps;
    int cycles;        // -1: the default
    uint32_t channels; // 1 or 3
    bool coefficients; // hand the medium over as textures of coefficients
    bool scattered_only;
    uint32_t num_points;
    const float (*points)[3];
    // Out.
    tyn_probe_result *results; // malloc'ed
    tyn_balance balance;
    float *inscatter; // (dims + 2) RGBA texels, malloc'ed; seen
                      // from +x far away
    tyn_extent inscatter_size;
    float *source; // RGBA per cell, channels stacked, malloc'ed; with suns or ordinates
    double ms_cells, ms_source, ms_solve;
} light_chain;

void light_chain_run(gpu_test *t, light_chain *c);
void light_chain_finish(light_chain *c);
