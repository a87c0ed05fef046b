// lattice_weights.comp -- Anderson mixing: the shares g_i of earlier sweeps that minimise |r + sum
// g_i d_i|.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lattice_args.h"

layout(local_size_x = LATTICE_GROUP) in;
layout(push_constant, scalar) uniform push
{
    lattice_args args;
};
layout(binding = 0, scalar) readonly buffer partial_buffer
{
    float partials[]; // [channel][group][dot]
};
layout(binding = 1, scalar) writeonly buffer weight_buffer
{
    vec2 weights[]; // per channel
};

shared float sums[LATTICE_NUM_DOTS][LATTICE_GROUP];

// A Gram determinant below this share of the product of its diagonal is rounding: d1, d2 are
// parallel.
const float PARALLEL = 1e-5;

void main()
{
    uint me = gl_LocalInvocationIndex, ch = gl_WorkGroupID.x;
    uint groups = (args.elements + LATTICE_GROUP_CELLS - 1) / LATTICE_GROUP_CELLS;
    for (uint k = 0; k < LATTICE_NUM_DOTS; k++) {
        float sum = 0.0;
        for (uint i = me; i < groups; i += LATTICE_GROUP) {
            sum += partials[(ch * groups + i) * LATTICE_NUM_DOTS + k];
        }
        sums[k][me] = sum;
    }
    for (uint half_n = LATTICE_GROUP / 2; half_n > 0; half_n /= 2) {
        barrier();
        if (me < half_n) {
            for (uint k = 0; k < LATTICE_NUM_DOTS; k++) {
                sums[k][me] += sums[k][me + half_n];
            }
        }
    }
    barrier();
    if (me == 0) {
        float a = sums[0][0] * (1.0 + 1e-6), b = sums[1][0] * (1.0 + 1e-6), c = sums[2][0];
        float p = -sums[3][0], q = -sums[4][0];
        // Scaled by the diagonal, so that nothing under- or overflows.
        float cosine = a > 0.0 && b > 0.0 ? c / (sqrt(a) * sqrt(b)) : 1.0;
        float det = 1.0 - cosine * cosine;
        vec2 g = vec2(0.0);
        if (args.history >= 2 && det > PARALLEL) {
            float x = p / sqrt(a), y = q / sqrt(b);
            g = vec2((x - cosine * y) / sqrt(a), (y - cosine * x) / sqrt(b)) / det;
        } else if (args.history >= 1 && a > 0.0) {
            g = vec2(p / a, 0.0);
        }
        weights[ch] = any(isnan(g)) || any(isinf(g)) ? vec2(0.0) : g;
    }
}
