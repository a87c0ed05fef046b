// hare.c -- a sitting hare: a solid body with thin ears, the shape of the glass of milk.
#include <math.h>

#include "noise.h"
#include "scenes.h"

static float clampf(float v, float lo, float hi)
{
    return v < lo ? lo : v > hi ? hi : v;
}

// A rounded cone between two balls, in units of the grid's longest side.
typedef struct limb {
    float a[3], b[3];
    float ra, rb;
    float blend; // how widely it grows together with the rest
} limb;

static const limb limbs[] = {
    {{0.500f, 0.270f, 0.390f}, {0.500f, 0.340f, 0.500f}, 0.235f, 0.200f, 0.06f}, // body
    {{0.500f, 0.400f, 0.530f}, {0.500f, 0.520f, 0.590f}, 0.170f, 0.110f, 0.06f}, // chest, neck
    {{0.500f, 0.600f, 0.600f}, {0.500f, 0.575f, 0.700f}, 0.115f, 0.070f, 0.05f}, // head, nose
    {{0.445f, 0.680f, 0.570f}, {0.395f, 0.935f, 0.490f}, 0.034f, 0.030f, 0.03f}, // ears
    {{0.555f, 0.680f, 0.570f}, {0.605f, 0.930f, 0.510f}, 0.034f, 0.030f, 0.03f},
    {{0.350f, 0.200f, 0.450f}, {0.330f, 0.110f, 0.600f}, 0.140f, 0.070f, 0.05f}, // haunches
    {{0.650f, 0.200f, 0.450f}, {0.670f, 0.110f, 0.600f}, 0.140f, 0.070f, 0.05f},
    {{0.325f, 0.070f, 0.560f}, {0.325f, 0.062f, 0.720f}, 0.052f, 0.045f, 0.03f}, // feet
    {{0.675f, 0.070f, 0.560f}, {0.675f, 0.062f, 0.720f}, 0.052f, 0.045f, 0.03f},
    {{0.430f, 0.330f, 0.620f}, {0.430f, 0.060f, 0.700f}, 0.070f, 0.045f, 0.04f}, // forelegs
    {{0.570f, 0.330f, 0.620f}, {0.570f, 0.060f, 0.700f}, 0.070f, 0.045f, 0.04f},
    {{0.500f, 0.170f, 0.160f}, {0.500f, 0.200f, 0.140f}, 0.080f, 0.070f, 0.03f}, // tail
};

// Distance to a cone that is round at both ends, about exact where the radii differ little.
static float to_limb(const limb *l, const float p[3])
{
    float along = 0.0f, length = 0.0f, rest = 0.0f;
    for (int k = 0; k < 3; k++) {
        along += (p[k] - l->a[k]) * (l->b[k] - l->a[k]);
        length += (l->b[k] - l->a[k]) * (l->b[k] - l->a[k]);
    }
    const float t = clampf(along / length, 0.0f, 1.0f);
    for (int k = 0; k < 3; k++) {
        const float d = p[k] - l->a[k] - t * (l->b[k] - l->a[k]);
        rest += d * d;
    }
    return sqrtf(rest) - (l->ra + t * (l->rb - l->ra));
}

// Minimum of two distances, rounded where they meet (Quilez).
static float join(float a, float b, float k)
{
    const float h = clampf(k - fabsf(a - b), 0.0f, k) / k;
    return (a < b ? a : b) - h * h * k * 0.25f;
}

gen_grid gen_hare(void)
{
    gen_grid g = gen_grid_new(72, 96, 84);
    const float side = 96.0f, shift[3] = {0.5f - 36.0f / side, 0.0f, 0.4375f - 42.0f / side};
    for (int z = 0; z < g.n[2]; z++) {
        for (int y = 0; y < g.n[1]; y++) {
            for (int x = 0; x < g.n[0]; x++) {
                const float p[3] = {((float)x + 0.5f) / side + shift[0],
                                    ((float)y + 0.5f) / side + shift[1],
                                    ((float)z + 0.5f) / side + shift[2]};
                float d = 1.0f;
                for (uint32_t i = 0; i < sizeof(limbs) / sizeof(limbs[0]); i++) {
                    d = join(d, to_limb(&limbs[i], p), limbs[i].blend);
                }
                // Fur, and a surface two voxels wide.
                d += 0.004f * gen_perlin(p[0] * 30.0f, p[1] * 22.0f, p[2] * 30.0f, 31);
                g.data[gen_index(&g, x, y, z)] = clampf(0.5f - d * side / 2.0f, 0.0f, 1.0f);
            }
        }
    }
    return g;
}
