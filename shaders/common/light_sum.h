// light_sum.h -- sums of light over all threads that are the same whatever their order, without atomics of floats.
// Included by C and GLSL.
//
// A number goes into the bin of its binary exponent, with the upper nine bits of its mantissa, of which a bin holds eight
// million. So a sum is low by 0.2 % at most: enough for a share that is told to one digit. GLSL: the numbers must be
// positive and finite.
#ifndef TYN_LIGHT_SUM_H
#define TYN_LIGHT_SUM_H
#include "shared.h"

#define TYN_LIGHT_SUM_BINS 256

// Light that goes through a clamp at 0: of what is below 0, without its sign, and of what is above. A sum is that of its
// bins in units of 2^(bin - 135).
struct light_clamp {
    tyn_uint bins[2 * TYN_LIGHT_SUM_BINS]; // hidden, then shown
};
TYN_ASSERT_SIZE(light_clamp, 2048);

#define TYN_LIGHT_HIDDEN 0u // first bins
#define TYN_LIGHT_SHOWN 256u

#ifndef __STDC__
// clang-format off
#define TYN_LIGHT_ADD(to, first, x) atomicAdd(to.bins[(first) + (floatBitsToUint(x) >> 23)], 0x100u | (floatBitsToUint(x) >> 15 & 0xffu))
#define TYN_LIGHT_CLAMP_ADD(to, below, above) { \
    if ((below) > 0.0) { TYN_LIGHT_ADD(to, TYN_LIGHT_HIDDEN, below); } \
    if ((above) > 0.0) { TYN_LIGHT_ADD(to, TYN_LIGHT_SHOWN, above); } \
}
// clang-format on

float light_below(vec3 v)
{
    return dot(max(-v, vec3(0.0)), vec3(1.0));
}

float light_above(vec3 v)
{
    return dot(max(v, vec3(0.0)), vec3(1.0));
}
#endif

#endif
