// lattice_sky_scale.comp -- second part: the directions together bring what the environment brings.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_args.h"
#include "lattice_args.h"
#include "lattice_sweep.glsl"

layout(local_size_x = 16) in;
layout(binding = 0, scalar) uniform environment_uniform
{
    env_block environment;
};
layout(binding = 1, scalar) buffer sky_buffer
{
    vec3 sky[];
};

shared vec3 mean;

void main()
{
    uint me = gl_LocalInvocationIndex;
    if (me == 0) {
        mean = vec3(0.0);
        for (uint i = 0; i < LATTICE_DIRECTIONS; i++) {
            mean += lattice_weight(i) * sky[i];
        }
    }
    barrier();
    if (me < LATTICE_DIRECTIONS) {
        sky[me] *= mix(vec3(0.0), environment.mean / mean, greaterThan(mean, vec3(0.0)));
    }
}
