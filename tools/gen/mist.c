// mist.c -- the media of the scenes with lamps: creeping smoke, the dust of a cave, a thin haze.
#include <math.h>

#include "noise.h"
#include "portable.h"
#include "scenes.h"

static float clampf(float v, float lo, float hi)
{
    return v < lo ? lo : v > hi ? hi : v;
}

static float smooth(float lo, float hi, float v)
{
    const float t = clampf((v - lo) / (hi - lo), 0, 1);
    return t * t * (3 - 2 * t);
}

// Noise of many sizes, about [-1, 1], bent by a coarser one so that it has wisps.
static float wisps(float x, float y, float z, float bend, uint32_t seed)
{
    const float bx = gen_perlin(0.7f * x, 0.7f * y, 0.7f * z, seed + 20);
    const float by = gen_perlin(0.7f * x, 0.7f * y, 0.7f * z, seed + 21);
    const float bz = gen_perlin(0.7f * x, 0.7f * y, 0.7f * z, seed + 22);
    x += bend * bx;
    y += bend * by;
    z += bend * bz;
    float sum = 0, weight = 0.6f, scale = 1;
    for (uint32_t octave = 0; octave < 5; octave++) {
        sum += weight * gen_perlin(x * scale, y * scale, z * scale, seed + octave);
        weight *= 0.55f;
        scale *= 2.03f;
    }
    return sum;
}

// Calls a density for every voxel: coordinates from 0 to 1.
static gen_grid filled(int nx, int ny, int nz, float (*density)(float, float, float))
{
    gen_grid g = gen_grid_new(nx, ny, nz);
    for (int z = 0; z < nz; z++) {
        for (int y = 0; y < ny; y++) {
            for (int x = 0; x < nx; x++) {
                g.data[gen_index(&g, x, y, z)] =
                    density(((float)x + 0.5f) / (float)nx, ((float)y + 0.5f) / (float)ny,
                            ((float)z + 0.5f) / (float)nz);
            }
        }
    }
    return g;
}

// Fades out at the sides of the box.
static float inside(float u, float rim)
{
    return smooth(0, rim, u) * smooth(0, rim, 1 - u);
}

// A layer over the ground, with rags that rise from it.
static float lantern_density(float x, float y, float z)
{
    const float n = wisps(3.2f * x + 3, 1.6f * y, 3.2f * z, 0.9f, 60);
    const float layer = 0.34f * (float)gen_exp(-6.0 * (double)y) * clampf(0.7f + 1.3f * n, 0, 2);
    const float rags = smooth(0.06f, 0.5f, n - 0.28f * y) * (1 - 0.6f * y);
    return clampf(layer + 0.55f * rags, 0, 1) * inside(x, 0.12f) * inside(z, 0.12f) *
           smooth(0, 0.25f, 1 - y);
}

gen_grid gen_lantern_smoke(void)
{
    return filled(80, 40, 80, lantern_density);
}

// Thin everywhere, with a few dense veils: the densest is some hundred times the mean.
static float cave_density(float x, float y, float z)
{
    const float n = wisps(3.0f * x, 4.2f * y, 3.0f * z, 1.1f, 80);
    const float low = (float)gen_exp(-3.5 * (double)y);
    const float veil = smooth(0.12f, 0.62f, n);
    return 0.01f + 0.03f * low * clampf(0.6f + n, 0, 2) + 0.5f * veil * veil * (0.25f + low);
}

gen_grid gen_cave_dust(void)
{
    return filled(72, 72, 72, cave_density);
}

static float haze_density(float x, float y, float z)
{
    const float n = wisps(4.5f * x, 0.8f * y, 4.5f * z, 0.8f, 100);
    return clampf((float)gen_exp(-2.2 * (double)y) * (0.5f + 0.9f * n), 0.02f, 1) *
           inside(x, 0.08f) * inside(z, 0.08f) * smooth(0, 0.2f, 1 - y);
}

gen_grid gen_haze(void)
{
    return filled(72, 16, 72, haze_density);
}
