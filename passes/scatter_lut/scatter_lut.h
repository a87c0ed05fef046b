// scatter_lut.h -- table of the light scattered forward any number of times along a beam.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/scene_args.h"
#include "shaders/phase/scatter_lut_args.h"

typedef struct tyn_scatter_lut_params {
    uint32_t mode;                       // TYN_MEDIUM_*
    tyn_phase phase[3];                  // DENSITY: of the colour channels
    float g_max;                         // COEFFICIENTS: largest mean cosine of any medium
    uint32_t tms;                        // 1: also make `tms`
    uint32_t num_suns;                   // 0..4
    float mean_cosine[TYN_LUT_MAX_SUNS]; // of the suns' discs, light_block.mean_cosine, in (0, 1]
} tyn_scatter_lut_params;

enum {
    SCATTER_LUT_PORT_LUT, // OUT 2D RG32F: K_tms and K_lobe over depth, angle and row, in the form
                          // that scatter_lut.glsl reads
    SCATTER_LUT_PORT_LUT_BLOCK, // OUT buffer struct lut_block
    SCATTER_LUT_PORT_TMS, // OUT 3D R32F, only if asked for: what is scattered of light from cones, over
                          // depth, angle, and the size of the cone in each row; tms.glsl reads it
    SCATTER_LUT_PORT_MOMENTS, // SCRATCH buffer: Legendre moments of the rows, outside and inside the lobe
    SCATTER_LUT_PORT_CONES, // SCRATCH buffer: Legendre moments c_l of the cones
    SCATTER_LUT_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_scatter_lut;
