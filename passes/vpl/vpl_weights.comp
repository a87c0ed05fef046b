// vpl_weights.comp -- weights of elements and of blocks of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

#define VPL_PLAN 0
#define VPL_FLUX 1
#define VPL_POSITION 2
#define VPL_NORMAL 3
#define VPL_SURFACES 4
#define VPL_VERTICES 5
#define VPL_TRIANGLES 6
#define VPL_MATERIALS 7
#include "vpl_elements.glsl"

layout(local_size_x = VPL_BLOCK) in;

layout(binding = 8, scalar) writeonly buffer weight_buffer
{
    float weights[];
};
layout(binding = 9, scalar) writeonly buffer block_buffer
{
    float blocks[];
};

shared float sums[VPL_BLOCK];

void main()
{
    uint block = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    float weight = vpl_weight(vpl_flux(block, lane));
    weights[block * VPL_BLOCK + lane] = weight;
    sums[lane] = weight;
    for (uint half_size = VPL_BLOCK / 2u; half_size > 0u; half_size /= 2u) {
        barrier();
        if (lane < half_size) {
            sums[lane] += sums[lane + half_size];
        }
    }
    if (lane == 0u) {
        blocks[block] = sums[0];
    }
}
