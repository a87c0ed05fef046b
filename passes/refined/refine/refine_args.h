// refine_args.h -- push constants, images and sums of the pass refine. Included by C and GLSL; scalar layout.
//
// A cell is 2 x 2 texels of the image of samples, each of which is a part: what is fitted on three parts is judged by the fourth.
// Level l of the pyramid has texels of 2^l x 2^l cells.
#ifndef TYN_REFINE_ARGS_H
#define TYN_REFINE_ARGS_H
#include "shaders/common/shared.h"

#define REFINE_PARTS 4
#define REFINE_LEVELS 7
#define REFINE_WINDOWS 8 // one a level, and one of cells that is smaller
#define REFINE_TILE 8    // cells along a side of a tile, for which one candidate is chosen
// Candidates: no change; then by window a fit on pop alone, and one on all layers.
#define REFINE_CANDIDATES (1 + 2 * REFINE_WINDOWS)

// Planes of images, so many of them side by side.
#define REFINE_CELL_POP 0    // mean of pop's picture; A: pixels
#define REFINE_CELL_SINGLE 1 // of its single scattering
#define REFINE_CELL_PARTS 2  // of the samples less pop's picture, by part
#define REFINE_CELLS 6
#define REFINE_CELLS_ROW 2
#define REFINE_MOMENTS                                                                             \
    18 // six products of layers, then three of layers and residuals for each part
#define REFINE_MOMENTS_ROW 4
#define REFINE_COEFFICIENTS 12 // three for each part
#define REFINE_COEFFICIENTS_ROW 3
#define REFINE_FINAL 3 // coefficients of pop, single and 1

// Prior of pop's relative error, lognormal: median, and sigma of the logarithm; its root mean square is 21 %. Both, and the factor
// below, are those with the most estimates within a factor of two in the scenes of refined.md at 128x128.
#define REFINE_PRIOR 0.13f
#define REFINE_PRIOR_SIGMA 0.7f
// Factor on the variance of squares: few samples miss a heavy tail.
#define REFINE_TAIL 4.0f

struct refine_args {
    tyn_uvec2 picture; // pixels
    tyn_uvec2 samples; // pixels of the image of samples
    tyn_uvec2 cells;
    tyn_uint grid;    // pixels along a side of one of samples
    tyn_uint level;   // of the pyramid that is read
    tyn_uint groups;  // of partial sums: tiles
    float margin;     // standard errors that a change must have to be made
    float noise;      // what of the samples' variance is taken for noise, 1 or more
    float known;      // relative error of pop's picture that is known without samples; 0 with them
    tyn_uint carried; // 1: a picture begins, and takes over what the last one found
    tyn_uint unfinished; // 1: no picture is made
    tyn_vec3 lo, hi;     // M, m: the box that pictures are of
};
TYN_ASSERT_SIZE(refine_args, 80);

// Over the cells of a tile, each a sum over channels of squares times refine_weight over the mean radiance.
struct refine_sums {
    float cells;
    float light;     // pop's over the picture's mean
    float confirmed; // change of three parts times residual of the fourth
    float doubt;     // its variance by the samples' noise
    float change;    // change squared
    float residual;  // residual of a part squared: pop's error and noise
    float noise;     // variance of a part
    float spread;    // variance of the change, by leaving out parts
    tyn_vec2
        excess; // squares of a cell's estimated square error: of pop, and of pop with the whole change
};
TYN_ASSERT_SIZE(refine_sums, 40);

// Over the cells of a tile in which something was kept, each a sum over channels of squares in units of the light.
struct refine_changes {
    float difference; // of what samples say now and said before
    float now;        // variances of both
    float before;
};
TYN_ASSERT_SIZE(refine_changes, 12);
#define REFINE_KNOWN 0.99f // least A of what was kept

struct refine_totals {
    tyn_vec3 mean;  // of pop's picture
    float share;    // of the change that is confirmed
    tyn_vec3 level; // by which the fit is multiplied, so that its sum is the samples'
    // Mean square of the relative error over the picture: of pop, of the fit.
    tyn_vec2 expected;
};
TYN_ASSERT_SIZE(refine_totals, 36);

// Sums over a tile of 8 x 8 pixels.
struct refine_residuals {
    float difference,
        noise; // squares of samples less fit, and of the samples' standard errors, times refine_weight
    tyn_vec3 fit;      // over the picture's mean, as what follows
    tyn_vec3 less;     // samples less fit
    tyn_vec3 variance; // of that sum
};
TYN_ASSERT_SIZE(refine_residuals, 44);

#endif
