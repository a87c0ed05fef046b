// half.h -- IEEE 754 binary16 from and to float, round to nearest even, subnormals kept.
#pragma once
#include <stdint.h>
#include <string.h>

static inline uint16_t tyn_half_from_float(float f)
{
    uint32_t x;
    memcpy(&x, &f, 4);
    uint32_t sign = (x >> 16) & 0x8000u;
    uint32_t mag = x & 0x7fffffffu;
    if (mag >= 0x7f800000u) { // infinity, NaN
        return (uint16_t)(sign | 0x7c00u | (mag > 0x7f800000u ? 0x200u : 0));
    }
    if (mag >= 0x477ff000u) { // rounds to 65520 or more
        return (uint16_t)(sign | 0x7c00u);
    }
    if (mag < 0x33000001u) { // rounds to zero
        return (uint16_t)sign;
    }
    if (mag < 0x38800000u) { // subnormal: align the mantissa to 2^-24
        uint32_t shift = 126u - (mag >> 23);
        uint32_t man = (mag & 0x7fffffu) | 0x800000u;
        uint32_t half = man >> shift, rest = man & ((1u << shift) - 1u), mid = 1u << (shift - 1u);
        return (uint16_t)(sign | (half + (rest > mid || (rest == mid && (half & 1u)))));
    }
    uint32_t half = (mag - 0x38000000u) >> 13, rest = mag & 0x1fffu;
    return (uint16_t)(sign | (half + (rest > 0x1000u || (rest == 0x1000u && (half & 1u)))));
}

static inline float tyn_half_to_float(uint16_t h)
{
    uint32_t sign = (uint32_t)(h & 0x8000u) << 16, exp = (h >> 10) & 31u, man = h & 0x3ffu, x;
    if (exp == 31) {
        x = sign | 0x7f800000u | (man << 13);
    } else if (exp) {
        x = sign | ((exp + 112u) << 23) | (man << 13);
    } else {
        float f = (float)man * 5.9604644775390625e-8f; // 2^-24
        memcpy(&x, &f, 4);
        x |= sign;
    }
    float f;
    memcpy(&f, &x, 4);
    return f;
}
