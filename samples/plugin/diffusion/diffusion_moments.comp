// diffusion_moments.comp -- fluence and flux of each cell, as views read them. The flux is the mean of that through opposite
// faces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/common/scene_args.h"
#include "shaders/common/counters.h"
#include "shaders/lattice/lattice_sweep.glsl"
#include "diffusion_system.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_READ(0, system, vec4 equation[]);
TYN_READ(1, forward, vec4 forward[]);
TYN_READ(2, fluence, float fluence[]);
layout(binding = 3, rgba32f) uniform writeonly image3D moments_image;
TYN_UNIFORM(4, environment, env_block environment);
TYN_UPDATE(5, counters, counters_block counters);

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    if (any(greaterThanEqual(texel, dims * ivec3(1, 1, args.channels)))) {
        return;
    }
    uint channel = uint(texel.z / dims.z);
    ivec3 c = texel - ivec3(0, 0, int(channel) * dims.z);
    uint i = system_index(c, channel);
    float phi = fluence[i], d = equation[i].x;
    vec3 own = forward[i].xyz, flux = vec3(0.0);
    float outside = args.lit == 1u ? lattice_channel(environment.sky, args.channels, channel, args.tint) : 0.0;
    [[unroll]] for (int f = 0; f < 6; f++) {
        ivec3 q = c + FACES[f];
        float out_of = system_boundary_share(d) * dot(own, vec3(FACES[f])) +
                       system_boundary(d) * (phi - LATTICE_4PI * outside);
        if (system_within(q)) {
            uint k = system_index(q, channel);
            out_of = system_between(d, equation[k].x) * (phi - fluence[k]) +
                     0.5 * dot(own + forward[k].xyz, vec3(FACES[f]));
        }
        flux += 0.5 * out_of * vec3(FACES[f]);
    }
    vec4 m = vec4(phi, flux);
    if (any(isnan(m)) || any(isinf(m))) {
        m = vec4(0.0);
        atomicAdd(counters.non_finite, 1u);
    }
    imageStore(moments_image, texel, m);
}
