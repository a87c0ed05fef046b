// refine_shrink.comp -- the share of the whole change that the parts confirm of each other, less what noise may have done; and how
// far pop and the fit are off in the whole picture. One group.
#include "refine.glsl"

layout(local_size_x = 64) in;
TYN_READ(0, sums, refine_sums sums[]);
TYN_UPDATE(1, totals, refine_totals totals);
shared refine_sums part[64];

// Posterior mean of a squared relative error, given its estimate, which may be below 0, and that one's variance.
float expected(float found, float variance)
{
    float most = -1e30, weights = 0.0, sum = 0.0;
    const bool told = !isnan(found) && !isinf(found) && !isnan(variance);
    for (int pass = 0; pass < 2; pass++) {
        for (int k = -56; k <= 24; k++) { // errors of .1 to 106 %
            const float u = 0.125 * float(k);
            const float error = REFINE_PRIOR * exp(REFINE_PRIOR_SIGMA * u), off = told ? found - error * error : 0.0;
            const float likely = -0.5 * (u * u + off * off / (told ? max(variance, 1e-30) : 1.0));
            const float weight = exp(likely - most);
            if (pass == 0) {
                most = max(most, likely);
            } else {
                weights += weight;
                sum += weight * error * error;
            }
        }
    }
    return sum / weights;
}

void main()
{
    const uint thread = gl_LocalInvocationIndex;
    refine_sums sum = REFINE_NO_SUMS;
    for (uint i = thread; i < args.groups; i += 64u) {
        sum = refine_add(sum, sums[i], 1.0);
    }
    part[thread] = sum;
    barrier();
    if (thread == 0u) {
        for (uint i = 1u; i < 64u; i++) {
            sum = refine_add(sum, part[i], 1.0);
        }
        // Nothing below `margin` standard errors; far above them next to nothing is taken back.
        const float doubt = args.margin * args.margin * sum.doubt / max(sum.confirmed, 1e-30);
        const float share = sum.confirmed > 0.0 ? clamp((sum.confirmed - doubt) / max(sum.change, 1e-30), 0.0, 1.0) : 0.0;
        const vec2 found = refine_squares(sum, share) / max(sum.light, 1e-20);
        const vec2 variance = REFINE_TAIL * refine_doubt(sum.excess, share) / max(sum.light * sum.light, 1e-30);
        totals.share = share;
        totals.expected.x = expected(found.x, variance.x);
        totals.expected.y = share > 0.0 ? min(expected(found.y, variance.y), totals.expected.x) : totals.expected.x;
    }
}
