// deposit.glsl -- light that many threads add to the same cells, as whole numbers: the same sums in any order. No bindings.
//
// Floats would make the result differ from run to run. `sums` is an array of ints of a storage buffer, filled with zeros;
// four follow each other from `at` on. What is added is in units of a bound of the sum of all, over DEPOSIT_WHOLE: so sums
// cannot overflow, roundings of a billion deposits included. It is rounded up or down at random, so that deposits far below a
// unit are right on average; `dither`, in [0, 1), has to belong to the deposit, whichever thread makes it.

const float DEPOSIT_WHOLE = 1073741824.0; // 2^30

// clang-format off
#define DEPOSIT_ADD(sums, at, value, dither) { \
    ivec4 deposit = ivec4(floor((value) + (dither))); \
    for (uint k = 0u; k < 4u; k++) { \
        if (deposit[k] != 0) { \
            atomicAdd(sums[(at) + k], deposit[k]); \
        } \
    } \
}
// clang-format on
