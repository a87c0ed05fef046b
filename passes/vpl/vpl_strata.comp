// vpl_strata.comp -- cumulates the weights of blocks and cuts them into one stratum per VPL.
//
// Strata are equally heavy and start anew at every light, whose last one may be lighter. Edges move
// smoothly when the light does, so that VPLs do; no VPL stands for two lights. If there are hardly more VPLs
// than lights the lights are taken together.
#include "vpl_args.h"
#include "shaders/beams/radial_args.h"

layout(local_size_x = VPL_BLOCK) in;
#define WORKGROUP_SIZE VPL_BLOCK
#define WORKGROUP_SUM float
#include "shaders/common/workgroup.glsl"

TYN_READ(0, plan, vpl_plan plan);
TYN_UPDATE(1, blocks, float blocks[]); // in: weights; out: what is before; one more element, the whole
TYN_WRITE(2, strata, vpl_stratum strata[]);
TYN_UPDATE(3, vpls, uint vpl_count; uint vpl_before; uvec2 vpl_pad); // before those of this time
TYN_ARGS(vpl_args args);

shared float starts[VPL_MAX_SOURCES + 1];

// Where in a stratum, [0, 1), the element is whose surface the VPL lies on. All power of a stratum that is in a
// corner goes to one of its sides: with one place for all, lamps that are alike would all choose the same,
// and their errors add up. Evenly spread over a light's strata and over lights, each surface gets as much as is
// its due. It does not depend on how many strata others have: nothing jumps when one becomes more.
float place_of(uint source, uint k)
{
    return fract(0.5 + 0.754877666 * float(source) + 0.569840296 * float(k));
}

void main()
{
    uint lane = gl_LocalInvocationIndex;
    uint share = (plan.num_blocks + VPL_BLOCK - 1u) / VPL_BLOCK;
    uint first = min(lane * share, plan.num_blocks), end = min(first + share, plan.num_blocks);
    float sum = 0.0;
    for (uint i = first; i < end; i++) {
        sum += blocks[i];
    }
    workgroup_cumulate(sum);
    float before = lane > 0u ? workgroup_sums[lane - 1u] : 0.0;
    for (uint i = first; i < end; i++) {
        float weight = blocks[i];
        blocks[i] = before;
        before += weight;
    }
    float total = workgroup_sums[VPL_BLOCK - 1u];
    if (lane == 0u) {
        blocks[plan.num_blocks] = total;
    }
    memoryBarrierBuffer();
    barrier();

    bool together = args.count < 2u * plan.num_sources;
    uint num_sources = together ? 1u : plan.num_sources;
    if (lane <= num_sources) {
        starts[lane] = lane == num_sources ? total : blocks[plan.sources[lane]];
    }
    barrier();
    float weight = total / float(together ? args.count : args.count - num_sources);
    uint count = 0u;
    for (uint s = 0u; s < num_sources && total > 0.0; s++) {
        float from = starts[s], to = starts[s + 1u];
        // Less than a thousandth is not worth a VPL of its own.
        uint strata_here = to > from ? uint(max(ceil((to - from) / weight - 1e-3), 1.0)) : 0u;
        if (lane >= count && lane < count + strata_here) {
            uint k = lane - count;
            bool last = k + 1u == strata_here;
            float start = from + float(k) * weight;
            float end = last ? to : from + float(k + 1u) * weight;
            // Never at the end, where the next source begins.
            float at = max(min(mix(start, end, place_of(s, k)), end * (1.0 - 2e-7)), start);
            strata[lane] = vpl_stratum(start, end, at);
        }
        count += strata_here;
    }
    if (lane == 0u) {
        uint before_these = args.append == 0u ? 0u : args.append == 1u ? vpl_count : vpl_before;
        vpl_before = before_these;
        vpl_count = before_these + min(count, args.count);
    }
}
