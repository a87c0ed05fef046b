// propagate_rect.h -- light of each directional light in its own aligned grid, moved cell by cell.
//
// Elek et al. 2014, sections 3-4, Eqs 1-8. The result depends on the view (Eq 8): a moved camera runs
// all iterations again, as in the paper. Defaults are the reading with the right energy: the first
// layer starts with the light's irradiance, and what reaches the eye has scattered a last time.
#pragma once
#include <tyndall/pass.h>
#include "propagate_args.h"

typedef struct tyn_propagate_rect_params {
    int32_t cells;       // along the longest side of the aligned box, 2..64
    int32_t iterations;  // 1..256
    int32_t init;        // TYN_PROPAGATE_INIT_*
    uint32_t last_event; // 1: the light is scattered once more towards the eye: hg(mu, g a)
    int32_t rate;        // TYN_PROPAGATE_RATE_*
    int32_t source;    // TYN_PROPAGATE_SOURCE_*: for the ray march, no kernel of this pass reads it
    uint32_t num_suns; // set by the method: directional lights, the first ones of "lights"
    uint32_t channels; // set by the method: 1 if the medium is the same in all channels, else 3
    uint32_t mode;     // set by the method: TYN_MEDIUM_*
} tyn_propagate_rect_params;

enum {
    PROPAGATE_RECT_PORT_MEDIUM,  // IN buffer struct medium_block
    PROPAGATE_RECT_PORT_LIGHTS,  // IN buffer struct light_block[]
    PROPAGATE_RECT_PORT_CAMERA,  // IN buffer struct camera_block
    PROPAGATE_RECT_PORT_DENSITY, // IN 3D: density (mode DENSITY) or sigma_s (mode COEFFICIENTS)
    PROPAGATE_RECT_PORT_SIGMA_A, // IN optional 3D: mode COEFFICIENTS, as g
    PROPAGATE_RECT_PORT_G,
    PROPAGATE_RECT_PORT_GRIDS, // OUT buffer struct propagate_grid[]
    PROPAGATE_RECT_PORT_CELLS, // OUT 3D RGBA32F, stacked (propagate_args.h): mean sigma_s, sigma_a, 1/m;
                               // sigma_s-weighted mean g; decay of a, 1/m
    PROPAGATE_RECT_PORT_STATE, // OUT 3D RGBA32F, stacked: after the last iteration L in units of the
                               // irradiance, 1 - a, fractions of L to a side and to the back
    PROPAGATE_RECT_PORT_SEEN, // OUT 3D R32F, stacked: L_acc, sum over iterations of L towards the eye,
                              // in units of the irradiance, 1/sr
    PROPAGATE_RECT_PORT_STATE_OTHER, // SCRATCH, as the two above
    PROPAGATE_RECT_PORT_SEEN_OTHER,
    PROPAGATE_RECT_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_propagate_rect;
