// random_unit.h -- the same numbers in [0, 1) on every machine, for tests.
#pragma once
#include <stdint.h>

static inline double random_unit(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) * 0x1p-24;
}
