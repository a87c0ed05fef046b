// noise.h -- hashed lattice noise, the same on every machine.
#pragma once
#include <stdint.h>

uint32_t gen_hash(uint32_t x, uint32_t y, uint32_t z, uint32_t seed);
float gen_random(uint32_t index, uint32_t seed); // [0, 1)

// Gradient noise of period 1 cell (Perlin, "Improving Noise", 2002), about [-1, 1].
float gen_perlin(float x, float y, float z, uint32_t seed);
// Distance to the nearest of one random point per unit cell (Worley 1996), about [0, 1].
float gen_worley(float x, float y, float z, uint32_t seed);
