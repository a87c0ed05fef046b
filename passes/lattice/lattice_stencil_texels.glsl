// lattice_stencil_texels.glsl -- the stencils of all levels and channels. Define LATTICE_STENCIL_LO, LATTICE_STENCIL_HI:
// bindings.
#include "lattice_stencil.glsl"

layout(binding = LATTICE_STENCIL_LO) uniform samplerBuffer stencil_lo_texels;
layout(binding = LATTICE_STENCIL_HI) uniform samplerBuffer stencil_hi_texels;

// Of cell i: first the channel, then the level, then the place in the level (lattice_levels.glsl).
vec4 lattice_stencil_lo_at(uint i)
{
    return texelFetch(stencil_lo_texels, int(i));
}

vec4 lattice_stencil_hi_at(uint i)
{
    return texelFetch(stencil_hi_texels, int(i));
}

lattice_stencil lattice_stencil_at(uint i)
{
    return lattice_stencil_of(lattice_stencil_lo_at(i), lattice_stencil_hi_at(i));
}
