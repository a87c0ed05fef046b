// noise.c -- hashed lattice noise, the same on every machine.
#include "noise.h"

#include <math.h>

// The mixing function pcg3d of Jarzynski and Olano, "Hash Functions for GPU Rendering" (2020).
static void pcg3d(uint32_t v[3])
{
    for (int i = 0; i < 3; i++) {
        v[i] = v[i] * 1664525u + 1013904223u;
    }
    v[0] += v[1] * v[2];
    v[1] += v[2] * v[0];
    v[2] += v[0] * v[1];
    for (int i = 0; i < 3; i++) {
        v[i] ^= v[i] >> 16;
    }
    v[0] += v[1] * v[2];
    v[1] += v[2] * v[0];
    v[2] += v[0] * v[1];
}

uint32_t gen_hash(uint32_t x, uint32_t y, uint32_t z, uint32_t seed)
{
    uint32_t v[3] = {x + seed * 0x9e3779b9u, y ^ (seed * 0x85ebca6bu), z};
    pcg3d(v);
    return v[0];
}

static float unit_float(uint32_t bits)
{
    return (float)(bits >> 8) * (1.0f / 16777216.0f);
}

float gen_random(uint32_t index, uint32_t seed)
{
    return unit_float(gen_hash(index, 0, 0, seed));
}

// Dot product of an offset with one of the twelve edge directions of a cube.
static float gradient(uint32_t hash, float x, float y, float z)
{
    const float u = (hash & 8) ? y : x;
    const float v = (hash & 4) ? z : ((hash & 8) ? x : y);
    return ((hash & 1) ? -u : u) + ((hash & 2) ? -v : v);
}

static float fade(float t)
{
    return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

float gen_perlin(float x, float y, float z, uint32_t seed)
{
    const float bx = floorf(x), by = floorf(y), bz = floorf(z);
    const float fx = x - bx, fy = y - by, fz = z - bz;
    float corner[8];
    for (int i = 0; i < 8; i++) {
        const int ox = i & 1, oy = (i >> 1) & 1, oz = i >> 2;
        const uint32_t h = gen_hash((uint32_t)((int)bx + ox), (uint32_t)((int)by + oy),
                                    (uint32_t)((int)bz + oz), seed);
        corner[i] = gradient(h >> 13, fx - (float)ox, fy - (float)oy, fz - (float)oz);
    }
    const float u = fade(fx), v = fade(fy), w = fade(fz);
    for (int i = 0; i < 4; i++) {
        corner[i] = corner[2 * i] + (corner[2 * i + 1] - corner[2 * i]) * u;
    }
    const float a = corner[0] + (corner[1] - corner[0]) * v;
    const float b = corner[2] + (corner[3] - corner[2]) * v;
    return a + (b - a) * w;
}

float gen_worley(float x, float y, float z, uint32_t seed)
{
    const int bx = (int)floorf(x), by = (int)floorf(y), bz = (int)floorf(z);
    float nearest = 9.0f;
    for (int i = 0; i < 27; i++) {
        const int cx = bx + i % 3 - 1, cy = by + i / 3 % 3 - 1, cz = bz + i / 9 - 1;
        uint32_t v[3] = {(uint32_t)cx + seed * 0x9e3779b9u, (uint32_t)cy, (uint32_t)cz};
        pcg3d(v);
        const float dx = (float)cx + unit_float(v[0]) - x;
        const float dy = (float)cy + unit_float(v[1]) - y;
        const float dz = (float)cz + unit_float(v[2]) - z;
        const float d = dx * dx + dy * dy + dz * dz;
        nearest = d < nearest ? d : nearest;
    }
    return sqrtf(nearest);
}
