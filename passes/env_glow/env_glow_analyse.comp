// env_glow_analyse.comp -- spherical harmonics of the map: an order a group, a degree a thread.
#include "shaders/light/glow_args.h"
#include "legendre.glsl"

const uint ROWS = TYN_GLOW_HEIGHT, HALF = TYN_GLOW_HEIGHT / 2, DEGREES = TYN_GLOW_HEIGHT;
layout(local_size_x = TYN_GLOW_HEIGHT) in;
TYN_READ(0, series, glow_series series);
TYN_READ(1, rows, glow_order rows[]);
TYN_WRITE(2, coefficients, glow_coefficient coefficients[]);

const float PI = 3.14159265358979;

shared float legendre[DEGREES][HALF];
// Sum (of degrees m, m + 2, ..) and difference (m + 1, ..) of a row and its mirror image.
shared glow_order folded[2][HALF];

void main()
{
    uint thread = gl_LocalInvocationID.x, m = gl_WorkGroupID.y;
    if (thread < HALF) {
        uint row = thread;
        glow_order north = rows[m * ROWS + row], south = rows[m * ROWS + ROWS - 1u - row];
        float weight = series.weights[row];
        folded[0][row] =
            glow_order(weight * (north.cosine + south.cosine), weight * (north.sine + south.sine));
        folded[1][row] =
            glow_order(weight * (north.cosine - south.cosine), weight * (north.sine - south.sine));
        float theta = PI * (float(row) + 0.5) / float(ROWS), x = cos(theta);
        float p = legendre_norm(m) * pow(sin(theta), float(m)), before = 0.0;
        legendre[m][row] = p;
        for (uint l = m + 1u; l < DEGREES; l++) {
            vec2 r = legendre_recurrence(l, m);
            float next = r.x * (x * p - r.y * before);
            before = p;
            p = next;
            legendre[l][row] = p;
        }
    }
    barrier();
    uint l = thread;
    if (l < m) {
        return;
    }
    vec3 cosine = vec3(0.0), sine = vec3(0.0);
    for (uint row = 0u; row < HALF; row++) {
        float p = legendre[l][row];
        glow_order f = folded[(l - m) & 1u][row];
        cosine += p * f.cosine;
        sine += p * f.sine;
    }
    // The mean is taken by the rows' solid angles: a map keeps its energy to the last texel.
    for (uint row = 0u; row < (l == 0u ? ROWS : 0u); row++) {
        vec3 part = sqrt(0.5) * series.solid_angles[row] * rows[row].cosine;
        cosine = row == 0u ? part : cosine + part;
    }
    vec2 r = l > m ? legendre_recurrence(l, m) : vec2(legendre_norm(m), 0.0);
    coefficients[m * DEGREES + l] = glow_coefficient(cosine, sine, r.x, r.y);
}
