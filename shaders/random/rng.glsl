// rng.glsl -- counter-based random numbers: any number of any path can be had without the others.
//
// The hash is pcg4d of Jarzynski and Olano, "Hash Functions for GPU Rendering" (JCGT 9(3), 2020), the
// cheapest of their list that passes the BigCrush test battery in four dimensions.
#ifndef TYN_RNG_GLSL
#define TYN_RNG_GLSL

struct rng_state {
    uvec3 key;      // pixel or point, sample, seed
    uint dimension; // counts the draws of this path
};

uvec4 rng_pcg4d(uvec4 v)
{
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

rng_state rng_start(uint element, uint sample_index, uint seed)
{
    return rng_state(uvec3(element, sample_index, seed), 0u);
}

// Four independent 32-bit numbers.
uvec4 rng_next(inout rng_state rng)
{
    return rng_pcg4d(uvec4(rng.key.xy, rng.dimension++, rng.key.z));
}

// Uniform in [0, 1), never 1: 24 bits.
float rng_float(uint bits)
{
    return float(bits >> 8) * (1.0 / 16777216.0);
}

vec2 rng_vec2(uvec2 bits)
{
    return vec2(bits >> 8) * (1.0 / 16777216.0);
}

// Exponentially distributed with mean 1. All 32 bits are used, so the tail is right to e^-22.
float rng_exponential(uint bits)
{
    return -log((float(bits) + 0.5) * (1.0 / 4294967296.0));
}

#endif
