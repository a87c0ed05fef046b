// hash.h -- 64-bit FNV-1a over words: change tracking and content hashes. Not for security.
#pragma once
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define TYN_HASH_SEED 0xcbf29ce484222325ull

static inline uint64_t tyn_hash_u64(uint64_t h, uint64_t v)
{
    h = (h ^ v) * 0x9E3779B97F4A7C15ull;
    return h ^ (h >> 29);
}

static inline uint64_t tyn_hash_bytes(uint64_t h, const void *data, size_t size)
{
    const uint8_t *p = (const uint8_t *)data;
    h = tyn_hash_u64(h, size);
    for (; size >= 8; size -= 8, p += 8) {
        uint64_t w;
        memcpy(&w, p, 8);
        h = tyn_hash_u64(h, w);
    }
    uint64_t tail = 0;
    if (size) { // nothing may be at NULL
        memcpy(&tail, p, size);
    }
    return tyn_hash_u64(h, tail);
}

static inline uint64_t tyn_hash_string(uint64_t h, const char *s)
{
    return tyn_hash_bytes(h, s, strlen(s));
}
