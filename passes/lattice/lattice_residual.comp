// lattice_residual.comp -- what a sweep and its correction give, and the dot products that say how to
// mix it with the results of earlier sweeps.
//
// The change r = result - start of up to three sweeps is kept; with d_i = r_i - r the products are
// d1.d1, d2.d2, d1.d2, d1.r, d2.r, where flux counts three times (then the norm is that of the radiance
// whose first moments these are). Each workgroup sums its cells pairwise.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lattice_args.h"

layout(local_size_x = LATTICE_GROUP) in;
layout(push_constant, scalar) uniform push
{
    lattice_args args;
};
layout(binding = 0) uniform sampler3D moments; // at the start of the sweep
layout(binding = 1) uniform sampler3D swept;
layout(binding = 2) uniform sampler3D correction;
layout(binding = 3) uniform sampler3D change_1; // of the sweep before
layout(binding = 4) uniform sampler3D change_2;
layout(binding = 5, rgba32f) uniform writeonly image3D result;
layout(binding = 6, rgba32f) uniform writeonly image3D change;
layout(binding = 7, scalar) writeonly buffer partial_buffer
{
    float partials[]; // [channel][workgroup][dot]
};

shared float sums[LATTICE_NUM_DOTS][LATTICE_GROUP];

float norm_dot(vec4 a, vec4 b)
{
    return a.x * b.x + 3.0 * dot(a.yzw, b.yzw);
}

void main()
{
    uint me = gl_LocalInvocationIndex, i = gl_GlobalInvocationID.x, ch = gl_GlobalInvocationID.y;
    uint plane = args.dims.x * args.dims.y;
    for (uint k = 0; k < LATTICE_NUM_DOTS; k++) {
        sums[k][me] = 0.0;
    }
    if (i < plane * args.dims.z) {
        ivec3 c = ivec3(i % args.dims.x, i / args.dims.x % args.dims.y, i / plane + ch * args.dims.z);
        vec4 m = texelFetch(swept, c, 0);
        m.x += texelFetch(correction, c, 0).r;
        vec4 r = m - texelFetch(moments, c, 0);
        imageStore(result, c, m);
        imageStore(change, c, r);
        if (args.history >= 1) {
            vec4 d1 = texelFetch(change_1, c, 0) - r;
            sums[0][me] = norm_dot(d1, d1);
            sums[3][me] = norm_dot(d1, r);
            if (args.history >= 2) {
                vec4 d2 = texelFetch(change_2, c, 0) - r;
                sums[1][me] = norm_dot(d2, d2);
                sums[2][me] = norm_dot(d1, d2);
                sums[4][me] = norm_dot(d2, r);
            }
        }
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
    if (me < LATTICE_NUM_DOTS) {
        partials[(ch * gl_NumWorkGroups.x + gl_WorkGroupID.x) * LATTICE_NUM_DOTS + me] = sums[me][0];
    }
}
