// rounding.h -- kernels rewritten so that the software device computes as cards may.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Bits of a filter's weight (subTexelPrecisionBits): 8 on all cards of NVIDIA, AMD and Intel.
#define ROUNDING_TEXEL_BITS 8

// Ulps by which a function's result is off at most. Vulkan allows 2.5 of a quotient, 2 of inversesqrt, 3 + 2|x| of exp
// (specification, "Precision and Operation of SPIR-V Instructions").
#define ROUNDING_ULPS 2

typedef struct rounding_kinds {
    bool weights; // filtered reads: coordinates rounded to 1 / 2^ROUNDING_TEXEL_BITS of a texel
    bool
        order; // threads and workgroups are reversed: what is added up by whoever comes first is in another order
    bool fused;     // a * b + c is rounded once
    bool functions; // quotients, roots, exponentials: off by up to ROUNDING_ULPS, either way
    bool denormals; // numbers below 2^-126 are 0: the driver's threads do it
} rounding_kinds;

// A copy of a module of `count` words with the arithmetic that `kinds` says, of *size words, to free; NULL: there is nothing to
// change, or no memory.
uint32_t *rounding_rewrite(const rounding_kinds *kinds, const uint32_t *words, size_t count,
                           size_t *size);
