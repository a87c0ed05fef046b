// glow_args.h -- the texture `glow`: an environment map as a medium that scatters forward smears it.
// Included by C and GLSL; scalar layout.
#ifndef TYN_GLOW_ARGS_H
#define TYN_GLOW_ARGS_H
#include "shaders/common/shared.h"

#define TYN_GLOW_WIDTH 128 // texels; the height is also the number of Legendre terms
#define TYN_GLOW_HEIGHT 64
#define TYN_GLOW_LEVELS 20 // at most, along the forward depth

// Level i is for the forward depth DEPTH (e^(STEP i) - 1), so that linear interpolation between levels is
// within 0.01 of every moment of the kernels.
#define TYN_GLOW_DEPTH 2.0f
#define TYN_GLOW_STEP 0.364f

struct glow_series {                     // scratch buffer of pass env_glow
    tyn_uint terms[TYN_GLOW_LEVELS];     // of the level's series
    float weights[TYN_GLOW_HEIGHT];      // of the rows in an integral over cos(theta)
    float solid_angles[TYN_GLOW_HEIGHT]; // of the rows, / 2 pi
    tyn_vec3 kernel[TYN_GLOW_LEVELS * TYN_GLOW_HEIGHT]; // Legendre moments, level after level
};
TYN_ASSERT_SIZE(glow_series, 4 * (20 + 64 + 64 + 3 * 20 * 64));

// Of one row, of order m: sum over m of cosine cos(m phi) + sine sin(m phi).
struct glow_order {
    tyn_vec3 cosine;
    tyn_vec3 sine;
};
TYN_ASSERT_SIZE(glow_order, 24);

struct glow_coefficient { // of degree l and order m, with what the recurrence needs to come to P_lm
    tyn_vec3 cosine;
    tyn_vec3 sine;
    float alpha, beta; // l = m: P_mm / sin^m theta, 0
};
TYN_ASSERT_SIZE(glow_coefficient, 32);

#endif
