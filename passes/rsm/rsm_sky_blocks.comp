// rsm_sky_blocks.comp -- what all blocks before each count for, and the whole. One workgroup.
#include "rsm_sky_args.h"

layout(local_size_x = RSM_SKY_BLOCK) in;
#define WORKGROUP_SIZE RSM_SKY_BLOCK
#define WORKGROUP_SUM float
#include "shaders/common/workgroup.glsl"
TYN_ARGS(rsm_sky_args args);
TYN_UPDATE(0, area_blocks, float area_blocks[]);

void main()
{
    uint lane = gl_LocalInvocationIndex, blocks = (args.triangles + RSM_SKY_BLOCK - 1u) / RSM_SKY_BLOCK;
    uint share = (blocks + RSM_SKY_BLOCK - 1u) / RSM_SKY_BLOCK;
    uint first = min(lane * share, blocks), end = min(first + share, blocks);
    float sum = 0.0;
    for (uint i = first; i < end; i++) {
        sum += area_blocks[i];
    }
    workgroup_cumulate(sum);
    float before = lane > 0u ? workgroup_sums[lane - 1u] : 0.0;
    for (uint i = first; i < end; i++) {
        float own = area_blocks[i];
        area_blocks[i] = before;
        before += own;
    }
    if (lane == RSM_SKY_BLOCK - 1u) {
        area_blocks[blocks] = workgroup_sums[lane];
    }
}
