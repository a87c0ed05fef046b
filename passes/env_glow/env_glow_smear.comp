// env_glow_smear.comp -- rows of the smeared map: an order and a level a group, two rows a thread.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "glow_args.h"
#include "legendre.glsl"

const uint ROWS = TYN_GLOW_HEIGHT, DEGREES = TYN_GLOW_HEIGHT;
layout(local_size_x = TYN_GLOW_HEIGHT / 2) in;
layout(set = 0, binding = 0, scalar) readonly buffer series_buffer
{
    glow_series series;
};
layout(set = 0, binding = 1, scalar) readonly buffer coefficients_buffer
{
    glow_coefficient coefficients[];
};
layout(set = 0, binding = 2, scalar) writeonly buffer levels_buffer
{
    glow_order levels[];
};

const float PI = 3.14159265358979;

void main()
{
    uint row = gl_LocalInvocationID.x, m = gl_WorkGroupID.y, level = gl_WorkGroupID.z;
    float theta = PI * (float(row) + 0.5) / float(ROWS), x = cos(theta);
    uint terms = series.terms[level];
    // Of degrees m, m + 2, .., which are even about the equator, and of the others.
    glow_order even = glow_order(vec3(0.0), vec3(0.0)), odd = even;
    float before = 0.0, p = m < terms ? legendre_first(m, sin(theta)) : 0.0;
    for (uint l = m; l < terms; l++) {
        glow_coefficient c = coefficients[m * DEGREES + l];
        if (l > m) {
            float next = c.alpha * (x * p - c.beta * before);
            before = p;
            p = next;
        }
        vec3 weight = series.kernel[level * DEGREES + l] * p;
        even.cosine += weight * c.cosine;
        even.sine += weight * c.sine;
        // The next degree belongs to the other sum.
        glow_order swap = even;
        even = odd;
        odd = swap;
    }
    if (((max(terms, m) - m) & 1u) != 0u) {
        glow_order swap = even;
        even = odd;
        odd = swap;
    }
    uint at = (level * DEGREES + m) * ROWS;
    levels[at + row] = glow_order(even.cosine + odd.cosine, even.sine + odd.sine);
    levels[at + ROWS - 1u - row] = glow_order(even.cosine - odd.cosine, even.sine - odd.sine);
}
