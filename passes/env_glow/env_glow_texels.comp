// env_glow_texels.comp -- texels of the smeared map from its rows' Fourier sums: 16 texels a thread.
#include "shaders/light/glow_args.h"
#include "shaders/common/counters.h"

const uint ROWS = TYN_GLOW_HEIGHT, ORDERS = TYN_GLOW_HEIGHT, WIDTH = TYN_GLOW_WIDTH;
const uint FOURS = 4, THREADS = WIDTH / 4 / FOURS;
layout(local_size_x = TYN_GLOW_WIDTH / 16) in;
TYN_READ(0, series, glow_series series);
TYN_READ(1, levels, glow_order levels[]);
layout(set = 0, binding = 2, rgba32f) writeonly uniform image3D glow_image;
TYN_UPDATE(3, counters, counters_block counters);

const float PI = 3.14159265358979;

float below = 0.0, above = 0.0; // light of the thread's texels
uint clamped = 0u;

// What the truncated series leaves below 0 in dark places beside bright ones is not resolved.
void store(uint i, uint row, uint level, vec3 light)
{
    below += light_below(light);
    above += light_above(light);
    clamped += any(lessThan(light, vec3(0.0))) ? 1u : 0u;
    imageStore(glow_image, ivec3(i, row, level), vec4(max(light, 0.0), 1.0));
}

void main()
{
    uint row = gl_WorkGroupID.y, level = gl_WorkGroupID.z;
    // Of even and odd orders, cosines and sines: their signs differ between phi, pi - phi, pi + phi and
    // -phi.
    vec3 cosine[2][FOURS], sine[2][FOURS];
    vec2 turn[FOURS], turned[FOURS];
    for (uint k = 0u; k < FOURS; k++) {
        float angle = (2.0 * PI) * (float(gl_LocalInvocationID.x + k * THREADS) + 0.5) / float(WIDTH);
        turn[k] = vec2(cos(angle), sin(angle));
        turned[k] = vec2(1.0, 0.0);
        cosine[0][k] = cosine[1][k] = sine[0][k] = sine[1][k] = vec3(0.0);
    }
    uint terms = series.terms[level], at = level * ORDERS * ROWS + row;
    for (uint m = 0u; m < terms; m += 2u) { // terms are even
        for (uint odd = 0u; odd < 2u; odd++) {
            glow_order f = levels[at + (m + odd) * ROWS];
            for (uint k = 0u; k < FOURS; k++) {
                cosine[odd][k] += f.cosine * turned[k].x;
                sine[odd][k] += f.sine * turned[k].y;
                turned[k] = vec2(turned[k].x * turn[k].x - turned[k].y * turn[k].y,
                                 turned[k].x * turn[k].y + turned[k].y * turn[k].x);
            }
        }
    }
    for (uint k = 0u; k < FOURS; k++) {
        uint i = gl_LocalInvocationID.x + k * THREADS;
        vec3 c = cosine[0][k] + cosine[1][k], s = sine[0][k] + sine[1][k];
        vec3 c_pi = cosine[0][k] - cosine[1][k], s_pi = sine[0][k] - sine[1][k];
        store(i, row, level, c + s);
        store(WIDTH / 2u - 1u - i, row, level, c_pi - s_pi);
        store(WIDTH / 2u + i, row, level, c_pi + s_pi);
        store(WIDTH - 1u - i, row, level, c - s);
    }
    if (level == 0u) { // the narrowest lobes, which ring most
        below *= series.solid_angles[row];
        above *= series.solid_angles[row];
        TYN_LIGHT_CLAMP_ADD(counters.clamp_0, below, above)
        if (clamped > 0u) {
            atomicAdd(counters.clamped, clamped);
        }
    }
}
