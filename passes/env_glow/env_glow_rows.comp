// env_glow_rows.comp -- Fourier sums of the map's rows: a row a group, four orders a thread.
#include "shaders/light/glow_args.h"
#include "shaders/common/counters.h"
#include "env_glow_args.h"

const uint HALF = TYN_GLOW_WIDTH / 2, FOUR = 4, THREADS = TYN_GLOW_HEIGHT / FOUR;
layout(local_size_x = TYN_GLOW_HEIGHT / 4) in;
layout(set = 0, binding = 0) uniform sampler2D sky_wrapped;
TYN_WRITE(1, rows, glow_order rows[]);
TYN_UPDATE(2, counters, counters_block counters);
TYN_ARGS(env_glow_args args);

const float PI = 3.14159265358979;

// Sum and difference of two texels opposite each other: those of even and of odd order add up.
shared vec3 folded[2][HALF];

uint non_finite = 0u; // of the thread

vec3 texel(uint i, uint row)
{
    vec2 uv = (vec2(i, row) + 0.5) / vec2(TYN_GLOW_WIDTH, TYN_GLOW_HEIGHT);
    vec3 light = textureLod(sky_wrapped, uv, args.mip).rgb;
    const bool broken = any(isnan(light)) || any(isinf(light));
    non_finite += uint(broken);
    return broken ? vec3(0.0) : light;
}

void main()
{
    uint thread = gl_LocalInvocationID.x, row = gl_WorkGroupID.y;
    for (uint i = thread; i < HALF; i += THREADS) {
        vec3 here = texel(i, row), opposite = texel(i + HALF, row);
        folded[0][i] = here + opposite;
        folded[1][i] = here - opposite;
    }
    if (non_finite > 0u) {
        atomicAdd(counters.non_finite, non_finite);
    }
    barrier();
    vec3 cosine[FOUR], sine[FOUR];
    vec2 turn[FOUR], turned[FOUR];
    for (uint k = 0u; k < FOUR; k++) {
        float angle = float(thread + k * THREADS) * (PI / float(TYN_GLOW_WIDTH));
        turned[k] = vec2(cos(angle), sin(angle));
        turn[k] = vec2(cos(2.0 * angle), sin(2.0 * angle));
        cosine[k] = sine[k] = vec3(0.0);
    }
    for (uint i = 0u; i < HALF; i++) {
        vec3 light = folded[thread & 1u][i]; // the thread's orders are all even or all odd
        for (uint k = 0u; k < FOUR; k++) {
            cosine[k] += light * turned[k].x;
            sine[k] += light * turned[k].y;
            turned[k] = vec2(turned[k].x * turn[k].x - turned[k].y * turn[k].y,
                             turned[k].x * turn[k].y + turned[k].y * turn[k].x);
        }
    }
    for (uint k = 0u; k < FOUR; k++) {
        uint m = thread + k * THREADS;
        float scale = (m == 0u ? 1.0 : 2.0) / float(TYN_GLOW_WIDTH);
        rows[m * TYN_GLOW_HEIGHT + row] = glow_order(scale * cosine[k], scale * sine[k]);
    }
}
