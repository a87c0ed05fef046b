// bytes.h -- numbers of files, which are little-endian and lie anywhere.
#pragma once
#include <stdint.h>

static inline uint64_t tyn_load(const uint8_t *p, int bytes)
{
    uint64_t v = 0;
    for (int i = 0; i < bytes; i++) {
        v |= (uint64_t)p[i] << (8 * i);
    }
    return v;
}
