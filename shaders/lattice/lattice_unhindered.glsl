// lattice_unhindered.glsl -- what enters at the lattice's boundary, equal from all sides, as if there were
// no medium. Define LATTICE_ENVIRONMENT, the binding of the buffer "environment", before including.
#ifndef TYN_LATTICE_UNHINDERED_GLSL
#define TYN_LATTICE_UNHINDERED_GLSL
#include "shaders/common/scene_args.h"
#include "lattice_sweep.glsl"

TYN_UNIFORM(LATTICE_ENVIRONMENT, environment, env_block environment);

// Radiance, W/(m^2 sr).
float lattice_boundary(uint channels, uint ch, vec3 tint)
{
    return lattice_channel(environment.sky, channels, ch, tint);
}

// Fluence and net flux, W/m^2.
vec4 lattice_unhindered(uint channels, uint ch, vec3 tint)
{
    return vec4(LATTICE_4PI * lattice_boundary(channels, ch, tint), 0.0, 0.0, 0.0);
}

#endif
