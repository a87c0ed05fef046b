// scatter_lut_args.h -- the table of multiple forward scattering. Included by C and GLSL; scalar layout.
#ifndef TYN_SCATTER_LUT_ARGS_H
#define TYN_SCATTER_LUT_ARGS_H
#include "shaders/common/shared.h"
#include "phase_args.h"

#define TYN_LUT_MAX_ROWS 16
#define TYN_LUT_MAX_SUNS 4
#define TYN_LUT_MAX_SETS 5 // of rows: for points and for each sun that is seen under an angle
#define TYN_LUT_DEPTHS 64  // texels along the scattering depth
#define TYN_LUT_ANGLES 192 // texels along the angle

// The table "tms" of light from cones, see tms.glsl.
#define TYN_TMS_DEPTHS 32 // texels along the scattering depth
#define TYN_TMS_ANGLES 96 // texels along the angle
#define TYN_TMS_CONES 24  // sizes of cones per row
#define TYN_TMS_MAX_TERMS 512

struct lut_block { // storage buffer "lut_block"
    tyn_uint num_rows;
    tyn_uint spread; // 0: a row per distinct phase function; 1: rows evenly in ln(g / (1 - g))
    float log_first; // spread: ln(g / (1 - g)) of the first row; g: mean cosine
    float log_step;  // spread: ... from row to row
    tyn_uvec3 channel_row; // not spread: row of each colour channel
    tyn_uint num_sets;
    tyn_uint sun_set[TYN_LUT_MAX_SUNS];
    float blur[TYN_LUT_MAX_SETS]; // 1 - mean cosine of the set's sun; 0 = a point
    tyn_phase phase[TYN_LUT_MAX_ROWS];
    float theta_1[TYN_LUT_MAX_ROWS];       // half width of the forward lobe, radians; 0 = no lobe
    tyn_uint terms[TYN_LUT_MAX_ROWS];      // length of the row's series
    tyn_uint first_term[TYN_LUT_MAX_ROWS]; // where it starts in the buffer "moments"
    tyn_uint tms_terms[TYN_LUT_MAX_ROWS];  // length of the series of "tms"
};
TYN_ASSERT_SIZE(lut_block, 324 + TYN_LUT_MAX_ROWS * sizeof(tyn_phase));

#endif
