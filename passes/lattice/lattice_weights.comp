// lattice_weights.comp -- Anderson mixing: the shares g_i of earlier sweeps that minimise |r + sum
// g_i d_i|. After the last sweep: what further ones would still change, for the counters.
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/counters.h"

layout(local_size_x = LATTICE_GROUP) in;
TYN_ARGS(lattice_args args);
TYN_READ(0, partials, float partials[]); // [channel][group][dot]
TYN_WRITE(1, weights, vec2 weights[]); // per channel
TYN_UPDATE(2, counters, counters_block counters);
layout(constant_id = 0) const uint last = 0; // 1: of the last sweep
const uint num_dots = last == 1 ? LATTICE_NUM_DOTS : LATTICE_MIX_DOTS;

shared float sums[LATTICE_NUM_DOTS][LATTICE_GROUP];
shared float norms[3][LATTICE_GROUP]; // of the solution, by channel

// What is still to come, as a share of the solution in the brightest channel. Sweeps bring less and less, here by the factor
// of the last two: after what mixing leaves of the last change come its rate, rate^2, ... Of one sweep no rate is known: half
// of what the diffusion correction had to add (of 13 scenes it is 0.02 to 0.95 of that, by two thirds 0.1 to 0.6).
float unsettled(vec2 g, float p, float q)
{
    float last_change = sums[5][0], factor = 0.5, left = last_change;
    float all = max(norms[0][0], max(norms[1][0], norms[2][0]));
    if (args.history >= 1) {
        left -= g.x * p + g.y * q; // |r + sum g_i d_i|^2 at its least
        float rate = sqrt(last_change / max(sums[0][0] + 2.0 * sums[3][0] + last_change, 1e-37));
        factor = min(rate, 0.9) / (1.0 - min(rate, 0.9));
    }
    return left > 0.0 && all > 0.0 ? factor * sqrt(left / all) : 0.0;
}

// A Gram determinant below this share of the product of its diagonal is rounding: d1, d2 are
// parallel.
const float PARALLEL = 1e-5;

void main()
{
    uint me = gl_LocalInvocationIndex, ch = gl_WorkGroupID.x;
    uint groups = (args.elements + LATTICE_GROUP_CELLS - 1) / LATTICE_GROUP_CELLS;
    for (uint k = 0; k < num_dots; k++) {
        float sum = 0.0;
        for (uint i = me; i < groups; i += LATTICE_GROUP) {
            sum += partials[(ch * groups + i) * LATTICE_NUM_DOTS + k];
        }
        sums[k][me] = sum;
    }
    for (uint c = 0; c < 3 && last == 1; c++) {
        float sum = 0.0;
        for (uint i = me; c < args.channels && i < groups; i += LATTICE_GROUP) {
            sum += partials[(c * groups + i) * LATTICE_NUM_DOTS + 6];
        }
        norms[c][me] = sum;
    }
    for (uint half_n = LATTICE_GROUP / 2; half_n > 0; half_n /= 2) {
        barrier();
        if (me < half_n) {
            for (uint k = 0; k < num_dots; k++) {
                sums[k][me] += sums[k][me + half_n];
            }
            for (uint c = 0; c < 3 && last == 1; c++) {
                norms[c][me] += norms[c][me + half_n];
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
        g = args.anderson == 0 || any(isnan(g)) || any(isinf(g)) ? vec2(0.0) : g;
        weights[ch] = g;
        if (last == 1) {
            counters.unsettled[ch] = unsettled(g, p, q);
        }
    }
}
