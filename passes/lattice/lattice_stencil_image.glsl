// lattice_stencil_image.glsl -- the stencils of all levels and channels, as lattice_stencil_finish.comp leaves them.
//
// Images, as they are read many times in a solve: per lane, a CPU device fetches texels several times faster than it
// reads buffers. Define LATTICE_STENCIL_LO, LATTICE_STENCIL_HI: bindings.
#ifndef TYN_LATTICE_STENCIL_IMAGE_GLSL
#define TYN_LATTICE_STENCIL_IMAGE_GLSL
#include "lattice_args.h"
#include "lattice_stencil.glsl"

layout(binding = LATTICE_STENCIL_LO) uniform sampler2D stencil_lo_tex;
layout(binding = LATTICE_STENCIL_HI) uniform sampler2D stencil_hi_tex;

// Of cell i: first the channel, then the level, then the place in the level (lattice_levels.glsl).
ivec2 lattice_stencil_texel(uint i)
{
    return ivec2(i % LATTICE_STENCIL_WIDTH, i / LATTICE_STENCIL_WIDTH);
}

vec4 lattice_stencil_lo_at(uint i)
{
    return texelFetch(stencil_lo_tex, lattice_stencil_texel(i), 0);
}

vec4 lattice_stencil_hi_at(uint i)
{
    return texelFetch(stencil_hi_tex, lattice_stencil_texel(i), 0);
}

lattice_stencil lattice_stencil_at(uint i)
{
    return lattice_stencil_of(lattice_stencil_lo_at(i), lattice_stencil_hi_at(i));
}

#endif
