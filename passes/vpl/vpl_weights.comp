// vpl_weights.comp -- weights of elements, cumulated within their blocks, and of blocks.
#include "vpl_elements.glsl"

layout(local_size_x = VPL_LANES) in;
#define WORKGROUP_SIZE VPL_LANES
#define WORKGROUP_SUM float
#include "shaders/common/workgroup.glsl"

TYN_WRITE(11, weights, float weights[]); // of an element and those before it in its block
TYN_WRITE(12, blocks, float blocks[]);
TYN_ARGS(vpl_args args);

const uint EACH = VPL_BLOCK / VPL_LANES; // elements of a thread, one after the other
void main()
{
    uint index = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    vpl_block block = vpl_block_at(index);
    float own[EACH], sum = 0.0;
    for (uint i = 0u; i < EACH; i++) {
        uint e = EACH * lane + i;
        sum += vpl_weight(block, e, vpl_power(vpl_flux(block, e)), args);
        own[i] = sum;
    }
    workgroup_cumulate(sum);
    float before = lane > 0u ? workgroup_sums[lane - 1u] : 0.0;
    for (uint i = 0u; i < EACH; i++) {
        weights[index * VPL_BLOCK + EACH * lane + i] = before + own[i];
    }
    if (lane == VPL_LANES - 1u) {
        blocks[index] = before + sum;
    }
}
