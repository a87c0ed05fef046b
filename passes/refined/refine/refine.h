// refine.h -- a picture corrected by a few samples of the truth: local linear regressions of the samples on its layers.
//
// After Rousselle, Knaus and Zwicker 2012, Moon, Carr and Yoon 2014, Bitterli et al. 2016, with the layers of method "pop" in place
// of geometry as features. Samples and layers are averaged in cells of 2 x 2 texels of the image of samples; what the samples say
// beyond pop is fitted in windows of .7 to 64 cells, in four parts; the window is chosen by how well three parts foretell the
// fourth, and the whole change shrunk to what they confirm of each other.
#pragma once
#include <tyndall/pass.h>
#include "refine_args.h"

typedef struct tyn_refine_params {
    int32_t grid;        // "refine.grid": pixels along a side of a texel of the samples
    float margin;        // "refine.margin": standard errors
    float noise;         // "refine.noise"
    float bias;          // "refine.bias"
    int32_t depth;       // "refine.depth": scatterings
    uint32_t unfinished; // tyn_view.unfinished: nothing is made
    uint32_t picture[2]; // pixels
    float known;         // without samples: relative error of pop's picture
    uint32_t carry;      // "refine.carry"
    uint32_t begins;     // 1: the first record of a picture
    float lo[3], hi[3];  // M, m: the box that pictures are of
} tyn_refine_params;

// clang-format off
#define REFINE_PORTS(X) \
    X(REFINE, BASE, base, IN, RGBA_2D, "pop's picture: radiance W/(m^2 sr), alpha"), \
    X(REFINE, SINGLE, single, OPTIONAL, IMAGE_2D, "its single scattering, W/(m^2 sr)"), \
    X(REFINE, SAMPLES, samples, OPTIONAL, IMAGE_2D, "mean radiance of samples in squares of grid x grid pixels"), \
    X(REFINE, NOISE, noise, OPTIONAL, IMAGE_2D, "their standard error, where grid is 1"), \
    X(REFINE, CAMERA, camera, OPTIONAL, BUFFER, "struct camera_block, with refine.carry"), \
    X(REFINE, KEPT, kept, INOUT, RGBA_2D, "residuals by cell and part, in units of the light; A: 1"), \
    X(REFINE, CARRIED, carried, INOUT, RGBA_2D, "those of the picture before, where they are seen now"), \
    X(REFINE, SEEN, seen, INOUT, BUFFER, "struct camera_block of the picture before"), \
    X(REFINE, RADIANCE, radiance, OUT, RGBA_2D, "refined radiance W/(m^2 sr), alpha"), \
    X(REFINE, ERROR, error, OUT, RGBA_2D, "estimated error of the refined picture, root mean square, W/(m^2 sr)"), \
    X(REFINE, BIAS, bias, OUT, RGBA_2D, "of pop's"), \
    X(REFINE, COUNTERS, counters, OUT, BUFFER, "non-finite and clamped pixels"), \
    X(REFINE, CELLS, cells, SCRATCH, RGBA_2D, "means of layers and residuals in cells"), \
    X(REFINE, MOMENTS, moments, SCRATCH, RGBA_2D, "products of layers and residuals, on levels"), \
    X(REFINE, COEFFICIENTS, coefficients, SCRATCH, RGBA_2D, "of layers, by window and part"), \
    X(REFINE, TILES, tiles, SCRATCH, BUFFER, "float: error of each candidate in each tile"), \
    X(REFINE, CHOICES, choices, SCRATCH, BUFFER, "uint: candidate of each tile"), \
    X(REFINE, ERRORS, errors, SCRATCH, RGBA_2D, "mean squares of both in tiles, in the units of refine_sums"), \
    X(REFINE, FINAL, final, SCRATCH, RGBA_2D, "coefficients of cells"), \
    X(REFINE, FITTED, fitted, SCRATCH, RGBA_2D, "the fit, where samples are blended in"), \
    X(REFINE, RESIDUALS, residuals, SCRATCH, BUFFER, "struct refine_residuals, by tile of pixels"), \
    X(REFINE, CHANGES, changes, SCRATCH, BUFFER, "struct refine_changes, by tile"), \
    X(REFINE, SUMS, sums, SCRATCH, BUFFER, "struct refine_sums, by group of cells"), \
    X(REFINE, TOTALS, totals, SCRATCH, BUFFER, "struct refine_totals")
// clang-format on
TYN_PASS(REFINE, refine);

// Texels of the images KEPT and CARRIED.
tyn_extent tyn_refine_kept(const tyn_refine_params *params);
// Texels along the longest side of its images.
uint32_t tyn_refine_side(const tyn_refine_params *params);
