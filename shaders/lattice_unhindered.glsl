// lattice_unhindered.glsl -- the environment in a cell as if there were no medium. Define LATTICE_SKY and
// LATTICE_ENVIRONMENT, the bindings of the buffers "sky" and "environment", before including.
#ifndef TYN_LATTICE_UNHINDERED_GLSL
#define TYN_LATTICE_UNHINDERED_GLSL
#include "scene_args.h"
#include "lattice_sweep.glsl"

layout(binding = LATTICE_SKY, scalar) readonly buffer sky_buffer
{
    vec3 sky[]; // that enters along each direction, W/(m^2 sr)
};
layout(binding = LATTICE_ENVIRONMENT, scalar) uniform environment_uniform
{
    env_block environment;
};

// Fluence and net flux, W/m^2.
vec4 lattice_unhindered(uint channels, uint ch, vec3 tint)
{
    vec4 m = vec4(0.0);
    for (uint d = 0; d < LATTICE_DIRECTIONS; d++) {
        float boundary = lattice_channel(sky[d] + environment.sky, channels, ch, tint);
        m += LATTICE_4PI * lattice_weight(d) * boundary *
             vec4(1.0, normalize(vec3(lattice_step(d))));
    }
    return m;
}

#endif
