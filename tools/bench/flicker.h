// flicker.h -- what changes from picture to picture of a camera path and is not smooth motion.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// The last three pictures of a camera path, and sums over all of them.
typedef struct flicker {
    size_t values; // of a picture
    float *last[3];
    uint32_t frames;
    double second, mean; // sums of |x[k-1] - 2 x[k] + x[k+1]| and of |x[k]|
} flicker;

// False: out of memory; flicker_close is due in any case.
bool flicker_open(flicker *f, uint32_t width, uint32_t height);
void flicker_close(flicker *f);
// The next picture, four floats a pixel; NULL: there is none.
void flicker_add(flicker *f, const float *rgba);

// Sum over pixels, channels and all but the first and last picture of |x[k-1] - 2 x[k] + x[k+1]|, relative to
// that of |x[k]|. Independent noise of relative standard deviation s gives 1.95 s. NAN below three pictures, and where a value
// is not finite: what is left out would flicker least.
double flicker_value(const flicker *f);
