// metrics.h -- how far an image is from a reference.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct metrics_image {
    uint32_t width, height;
    const float *rgb[3];
    const float *se[3]; // standard error of each value; NULL = not known
} metrics_image;

// x = image, r = reference, averaged over blocks; sums run over all blocks and R, G, B. Where the size
// is not a multiple of the block, the blocks at the right and bottom edge hold fewer pixels, and every
// block weighs in all sums as many pixels as it holds. If a value is not finite in either image such ones are counted,
// and all measures are NaN; standard errors that are not finite make `n` and `error` NaN.
typedef struct metrics {
    double rel_l1;   // sum |x - r| / sum |r|
    double rmse;     // sqrt(mean (x - r)^2)
    double rel_rmse; // sqrt(sum (x - r)^2 / sum r^2)
    double rel_mse;  // mean((x - r)^2 / (r^2 + 0.01 m^2)), m = mean of the reference
    double smape;    // mean(2 |x - r| / (|x| + |r|)), 0/0 = 0
    double bias;     // sum x / sum r - 1
    bool has_n;      // one of the images carries standard errors
    double n;        // sqrt(2/pi) sum se / sum |r|: the part of rel_l1 that noise alone explains
    double error;    // sqrt(max(0, rel_l1^2 - n^2)); rel_l1 without standard errors
    double p95;      // 95th percentile of |x - r| / (|r| + 0.01 m)
    uint64_t nan;    // values that are not finite in either image
    double mean;     // m
} metrics;

typedef enum metrics_status {
    METRICS_OK = 0,
    METRICS_ZERO_REFERENCE, // the reference's finite values sum to 0: nothing is relative to it
    METRICS_MEMORY,
} metrics_status;

// Both images have the same size; block >= 1.
metrics_status metrics_compare(const metrics_image *image, const metrics_image *reference,
                               uint32_t block, metrics *out);

// `n` of single pixels, where `error` is what a picture's values err by as a root mean square: the relative L1 that is
// expected of them. Four floats a pixel, the fourth is not read; 0 of a black picture.
double metrics_expected(const float *rgba, const float *error, size_t num_pixels);

// |x - r| / (|r| + 0.01 m) averaged over the channels, one value a pixel, constant over a block; a
// block with no finite value is NaN. `heat` has width * height elements.
metrics_status metrics_heat(const metrics_image *image, const metrics_image *reference,
                            uint32_t block, float *heat);
