// lattice_start.comp -- the first guess: the mean of the environment everywhere, no scattered sunlight.
//
// In a medium that only scatters, inside a uniform environment, it is already the solution.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_args.h"
#include "lattice_args.h"
#include "lattice_sweep.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(push_constant, scalar) uniform push
{
    lattice_args args;
};
layout(binding = 0, scalar) uniform environment_uniform
{
    env_block environment;
};
layout(binding = 1) uniform sampler3D cells;
layout(binding = 2) uniform sampler3D source;
layout(binding = 3, rgba32f) uniform writeonly image3D moments;
layout(binding = 4, rgba32f) uniform writeonly image3D emitted;

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    uint ch = uint(texel.z) / args.dims.z;
    if (any(greaterThanEqual(uvec2(texel.xy), args.dims.xy)) || ch >= args.channels) {
        return;
    }
    float boundary = lattice_channel(environment.mean, args.channels, ch, args.tint);
    vec4 m = vec4(LATTICE_4PI * boundary, 0.0, 0.0, 0.0);
    imageStore(moments, texel, m);
    vec4 beam = lattice_fetch_source(source, cells, texel);
    imageStore(emitted, texel, lattice_emitted(m + beam, texelFetch(cells, texel, 0).z));
}
