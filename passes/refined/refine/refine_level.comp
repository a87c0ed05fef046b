// refine_level.comp -- the sum of the fit over the picture against the samples': what is left of a fit's bias everywhere. One group.
#include "refine.glsl"

layout(local_size_x = 64) in;
TYN_READ(0, residuals, refine_residuals residuals[]);
TYN_UPDATE(1, totals, refine_totals totals);
shared refine_residuals part[64];

void main()
{
    const uint thread = gl_LocalInvocationIndex;
    const uvec2 tiles = (args.picture + 7u) / 8u;
    refine_residuals sum = REFINE_NO_RESIDUALS;
    for (uint i = thread; i < tiles.x * tiles.y; i += 64u) {
        sum = refine_add(sum, residuals[i], 1.0);
    }
    part[thread] = sum;
    barrier();
    if (thread == 0u) {
        for (uint i = 1u; i < 64u; i++) {
            sum = refine_add(sum, part[i], 1.0);
        }
        totals.level = refine_level(sum, vec3(1.0), 1.0);
    }
}
