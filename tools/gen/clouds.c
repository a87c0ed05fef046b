// clouds.c -- the cumulus and the blobs: densities made of balls.
#include <math.h>

#include "noise.h"
#include "scenes.h"

static float clampf(float v, float lo, float hi)
{
    return v < lo ? lo : v > hi ? hi : v;
}

static float smoothstep(float lo, float hi, float v)
{
    const float t = clampf((v - lo) / (hi - lo), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

// Lowers `distance` to the signed distance of a ball (voxels), in the neighbourhood of the ball.
static void add_ball(gen_grid *distance, const float c[3], float radius, float margin)
{
    int lo[3], hi[3];
    for (int a = 0; a < 3; a++) {
        lo[a] = (int)clampf(c[a] - radius - margin, 0.0f, (float)(distance->n[a] - 1));
        hi[a] = (int)clampf(c[a] + radius + margin, 0.0f, (float)(distance->n[a] - 1));
    }
    for (int z = lo[2]; z <= hi[2]; z++) {
        for (int y = lo[1]; y <= hi[1]; y++) {
            for (int x = lo[0]; x <= hi[0]; x++) {
                const float dx = (float)x - c[0], dy = (float)y - c[1], dz = (float)z - c[2];
                const float d = sqrtf(dx * dx + dy * dy + dz * dz) - radius;
                float *out = &distance->data[gen_index(distance, x, y, z)];
                *out = d < *out ? d : *out;
            }
        }
    }
}

// Grows smaller balls on the upper side of a ball, and smaller ones on those: the cauliflower of a
// convective cloud.
static void add_puffs(gen_grid *distance, const float c[3], float radius, int level, uint32_t seed)
{
    add_ball(distance, c, radius, 12.0f);
    if (level == 0) {
        return;
    }
    for (uint32_t i = 0; i < 11; i++) {
        float d[3], length = 0.0f;
        for (uint32_t a = 0; a < 3; a++) {
            d[a] = 2.0f * gen_random(3 * i + a, seed) - 1.0f;
        }
        d[1] = d[1] * 0.9f + 0.35f;
        length = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) + 1e-3f;
        const float size = radius * (0.38f + 0.24f * gen_random(100 + i, seed));
        const float at = radius * (0.72f + 0.2f * gen_random(200 + i, seed)) / length;
        const float child[3] = {c[0] + d[0] * at, c[1] + d[1] * at, c[2] + d[2] * at};
        add_puffs(distance, child, size, level - 1, gen_hash(i, 1, 2, seed));
    }
}

gen_grid gen_cumulus(void)
{
    gen_grid g = gen_grid_new(160, 112, 160);
    const size_t count = (size_t)g.n[0] * (size_t)g.n[1] * (size_t)g.n[2];
    for (size_t i = 0; i < count; i++) {
        g.data[i] = 12.0f;
    }
    // Towers over a common base: centre (voxels), radius.
    static const float towers[][4] = {
        {70, 34, 76, 25},  {98, 30, 88, 22},  {82, 56, 80, 21}, {46, 24, 84, 17},
        {116, 24, 74, 17}, {84, 26, 104, 18}, {76, 26, 52, 18}, {68, 74, 76, 13},
    };
    for (uint32_t i = 0; i < sizeof(towers) / sizeof(towers[0]); i++) {
        add_puffs(&g, towers[i], towers[i][3], 2, 17 + i);
    }
    for (int z = 0; z < g.n[2]; z++) {
        for (int y = 0; y < g.n[1]; y++) {
            for (int x = 0; x < g.n[0]; x++) {
                float *out = &g.data[gen_index(&g, x, y, z)];
                if (*out >= 8.0f) {
                    *out = 0.0f;
                    continue;
                }
                // Erode by octaves of Worley noise (Schneider, "Real-time volumetric cloudscapes",
                // GPU Pro 7): round bumps outwards, creases inwards.
                const float px = (float)x, py = (float)y, pz = (float)z;
                const float bumps = 0.6f * gen_worley(px / 11.0f, py / 11.0f, pz / 11.0f, 1) +
                                    0.3f * gen_worley(px / 5.5f, py / 5.5f, pz / 5.5f, 2) +
                                    0.15f * gen_worley(px / 2.8f, py / 2.8f, pz / 2.8f, 3);
                const float d = *out + 7.0f * (bumps - 0.35f);
                // The condensation level: a flat, slightly ragged base with a thinner edge.
                const float base = 14.0f + 2.5f * gen_perlin(px / 17.0f, 0.5f, pz / 17.0f, 5);
                const float body = smoothstep(1.5f, -3.5f, d) * (1.0f - 0.35f * bumps);
                *out = clampf(body * smoothstep(base - 1.5f, base + 7.0f, py), 0.0f, 1.0f);
            }
        }
    }
    return g;
}

gen_grid gen_blobs(void)
{
    gen_grid g = gen_grid_new(48, 48, 48);
    // Centre in [-1, 1]^3, radius, peak.
    static const float blobs[][5] = {
        {-0.32f, -0.1f, 0.06f, 0.62f, 0.9f},
        {0.34f, 0.2f, -0.16f, 0.55f, 0.75f},
        {0.08f, -0.42f, 0.34f, 0.46f, 0.7f},
        {-0.1f, 0.46f, 0.2f, 0.42f, 0.8f},
    };
    for (int z = 0; z < g.n[2]; z++) {
        for (int y = 0; y < g.n[1]; y++) {
            for (int x = 0; x < g.n[0]; x++) {
                const int index[3] = {x, y, z};
                float sum = 0.0f;
                for (uint32_t i = 0; i < sizeof(blobs) / sizeof(blobs[0]); i++) {
                    float d2 = 0.0f;
                    for (int a = 0; a < 3; a++) {
                        const float p = ((float)index[a] + 0.5f) / 24.0f - 1.0f - blobs[i][a];
                        d2 += p * p;
                    }
                    // (1 - d^2/r^2)^3: smooth, and zero at a finite radius.
                    const float t = fmaxf(0.0f, 1.0f - d2 / (blobs[i][3] * blobs[i][3]));
                    sum += blobs[i][4] * t * t * t;
                }
                g.data[gen_index(&g, x, y, z)] = clampf(sum, 0.0f, 1.0f);
            }
        }
    }
    return g;
}
