// env_glow_smear.comp -- rows of the smeared map: an order and a level a group, eight rows a thread.
//
// Several rows a thread, as fetching a coefficient costs some devices more than using it.
#include "shaders/light/glow_args.h"

const uint ROWS = TYN_GLOW_HEIGHT, DEGREES = TYN_GLOW_HEIGHT, PAIRS = 4, THREADS = ROWS / 2 / PAIRS;
layout(local_size_x = TYN_GLOW_HEIGHT / 8) in;
TYN_READ(0, series, glow_series series);
TYN_READ(1, coefficients, glow_coefficient coefficients[]);
TYN_WRITE(2, levels, glow_order levels[]);

const float PI = 3.14159265358979;

void main()
{
    uint m = gl_WorkGroupID.y, level = gl_WorkGroupID.z;
    uint terms = series.terms[level];
    // Of degrees m, m + 2, .., which are even about the equator, and of m + 1, m + 3, ...
    vec3 cosine[2][PAIRS], sine[2][PAIRS];
    float x[PAIRS], before[PAIRS], p[PAIRS];
    float norm = coefficients[m * DEGREES + m].alpha;
    for (uint k = 0u; k < PAIRS; k++) {
        float theta = PI * (float(gl_LocalInvocationID.x + k * THREADS) + 0.5) / float(ROWS);
        x[k] = cos(theta);
        before[k] = 0.0;
        p[k] = norm * pow(sin(theta), float(m));
        cosine[0][k] = cosine[1][k] = sine[0][k] = sine[1][k] = vec3(0.0);
    }
    for (uint first = m; first < terms; first += 2u) {
        for (uint odd = 0u; odd < 2u; odd++) {
            uint l = min(first + odd, DEGREES - 1u);
            glow_coefficient c = coefficients[m * DEGREES + l];
            vec3 kernel = first + odd < terms ? series.kernel[level * DEGREES + l] : vec3(0.0);
            c.cosine *= kernel;
            c.sine *= kernel;
            for (uint k = 0u; k < PAIRS; k++) {
                if (l > m) {
                    float next = c.alpha * (x[k] * p[k] - c.beta * before[k]);
                    before[k] = p[k];
                    p[k] = next;
                }
                cosine[odd][k] += p[k] * c.cosine;
                sine[odd][k] += p[k] * c.sine;
            }
        }
    }
    uint at = (level * DEGREES + m) * ROWS;
    for (uint k = 0u; k < PAIRS; k++) {
        uint row = gl_LocalInvocationID.x + k * THREADS;
        levels[at + row] = glow_order(cosine[0][k] + cosine[1][k], sine[0][k] + sine[1][k]);
        levels[at + ROWS - 1u - row] = glow_order(cosine[0][k] - cosine[1][k], sine[0][k] - sine[1][k]);
    }
}
