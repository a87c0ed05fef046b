// balance_result.h -- the buffer tyn_balance of <tyndall/context.h>, as kernels write it: doubles, each as two words, as a
// device need not know doubles. Included by C and GLSL.
//
//   TYN_WRITE(8, balance, TYN_BALANCE_MEMBERS);
#ifndef TYN_BALANCE_RESULT_H
#define TYN_BALANCE_RESULT_H
#include "shared.h"

#define TYN_BALANCE_ROWS 7   // of a number per channel
#define TYN_BALANCE_SCALES 3 // suns, lamps, VPLs: of the least and the most
#define TYN_BALANCE_BYTES (8 * (3 * TYN_BALANCE_ROWS + 2 * TYN_BALANCE_SCALES))

#ifndef __STDC__
// clang-format off
#define TYN_BALANCE_MEMBERS uvec2 balance[TYN_BALANCE_ROWS][3]; uvec2 scales[TYN_BALANCE_SCALES][2]
// clang-format on

uvec2 double_bits(float x)
{
    uint bits = floatBitsToUint(x), exponent = bits >> 23 & 0xFFu;
    if (exponent == 0u) { // zero; single denormals are as good as zero
        return uvec2(0u, bits & 0x80000000u);
    }
    uint wide = exponent == 0xFFu ? 0x7FFu : exponent + 896u; // 1023 - 127
    return uvec2(bits << 29, (bits & 0x80000000u) | wide << 20 | (bits & 0x7FFFFFu) >> 3);
}
#endif

#endif
