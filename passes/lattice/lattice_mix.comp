// lattice_mix.comp -- the next state, from the results of the last sweeps, and what it emits.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lattice_args.h"
#include "lattice_sweep.glsl"
#include "counters.h"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(push_constant, scalar) uniform push
{
    lattice_args args;
};
layout(binding = 0) uniform sampler3D cells;
layout(binding = 1) uniform sampler3D source;
layout(binding = 2) uniform sampler3D result;
layout(binding = 3) uniform sampler3D result_1; // of the sweep before
layout(binding = 4) uniform sampler3D result_2;
layout(binding = 5, scalar) readonly buffer weight_buffer
{
    vec2 weights[];
};
layout(binding = 6, rgba32f) uniform writeonly image3D moments;
layout(binding = 7, rgba32f) uniform writeonly image3D emitted;
layout(binding = 8, scalar) buffer counter_buffer
{
    counters_block counters;
};

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    uint ch = uint(texel.z) / args.dims.z;
    if (any(greaterThanEqual(uvec2(texel.xy), args.dims.xy)) || ch >= args.channels) {
        return;
    }
    vec4 newest = texelFetch(result, texel, 0), m = newest;
    if (args.history >= 1) {
        m += weights[ch].x * (texelFetch(result_1, texel, 0) - newest);
    }
    if (args.history >= 2) {
        m += weights[ch].y * (texelFetch(result_2, texel, 0) - newest);
    }
    if (any(isnan(m)) || any(isinf(m))) {
        m = vec4(0.0);
        atomicAdd(counters.non_finite, 1);
    }
    imageStore(moments, texel, m);
    vec4 beam = lattice_fetch_source(source, cells, texel);
    imageStore(emitted, texel, lattice_emitted(m + beam, texelFetch(cells, texel, 0).z));
}
