// lattice_start.comp -- the first guess: the environment everywhere as if unhindered, no sunlight.
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
layout(binding = 0, scalar) readonly buffer sky_buffer
{
    vec3 sky[]; // that enters along each direction, W/(m^2 sr)
};
layout(binding = 5, scalar) uniform environment_uniform
{
    env_block environment;
};
layout(binding = 1) uniform sampler3D cells;
layout(binding = 2) uniform sampler3D source;
layout(binding = 3, scalar) writeonly buffer state_buffer
{
    vec4 state[];
};
layout(binding = 4, scalar) writeonly buffer emitted_buffer
{
    vec4 emitted[];
};

void main()
{
    uvec3 texel = gl_GlobalInvocationID; // channels stacked along z
    uint ch = texel.z / args.dims.z;
    if (any(greaterThanEqual(texel.xy, args.dims.xy)) || ch >= args.channels) {
        return;
    }
    uint i = (texel.z * args.dims.y + texel.y) * args.dims.x + texel.x;
    vec4 m = vec4(0.0);
    for (uint d = 0; d < LATTICE_DIRECTIONS; d++) {
        float boundary = lattice_channel(sky[d] + environment.sky, args.channels, ch, args.tint);
        m += LATTICE_4PI * lattice_weight(d) * boundary *
             vec4(1.0, normalize(vec3(lattice_step(d))));
    }
    state[i] = m;
    vec4 beam = lattice_fetch_source(source, cells, ivec3(texel));
    emitted[i] = lattice_emitted(m + beam, texelFetch(cells, ivec3(texel), 0).z);
}
