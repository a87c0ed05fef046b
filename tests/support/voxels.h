// voxels.h -- a grid of eight voxels by another that is half as fine: what one trilinear sample between them gives.
#pragma once
#include <stddef.h>

// Mean of the 2 x 2 x 2 voxels (2 x, 2 y, 2 z) and after of a grid of `side`^3.
static inline double voxels_mean(const float *texels, int side, int channels, int channel,
                                 const int at[3])
{
    double sum = 0;
    for (int k = 0; k < 8; k++) {
        const int x = 2 * at[0] + (k & 1), y = 2 * at[1] + (k >> 1 & 1), z = 2 * at[2] + (k >> 2);
        sum += (double)texels[(size_t)(((z * side + y) * side + x) * channels + channel)];
    }
    return sum / 8;
}
