// refine_shrink.comp -- the share of the whole change that the parts confirm of each other, less what noise may have done. One group.
#include "refine.glsl"

layout(local_size_x = 64) in;
TYN_READ(0, sums, refine_sums sums[]);
TYN_UPDATE(1, totals, refine_totals totals);
shared refine_sums part[64];

void main()
{
    const uint thread = gl_LocalInvocationIndex;
    refine_sums sum = refine_sums(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
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
        totals.share = sum.confirmed > 0.0 ? clamp((sum.confirmed - doubt) / max(sum.change, 1e-30), 0.0, 1.0) : 0.0;
    }
}
