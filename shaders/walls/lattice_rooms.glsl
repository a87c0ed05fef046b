// lattice_rooms.glsl -- rooms of the lattice's cells and of VPLs (rooms.h), from the texel buffer at binding LATTICE_ROOMS.
#ifndef TYN_LATTICE_ROOMS_GLSL
#define TYN_LATTICE_ROOMS_GLSL
#include "shaders/beams/radial_args.h"
#include "rooms.h"
#include "shaders/common/quotient.glsl"

layout(set = 0, binding = LATTICE_ROOMS) uniform usamplerBuffer room_texels;

uint rooms_of_cell(ivec3 dims, ivec3 c)
{
    return texelFetch(room_texels, 1 + (c.z * dims.y + c.y) * dims.x + c.x).x;
}

uint rooms_of_vpl(ivec3 dims, uint vpl)
{
    return texelFetch(room_texels, 1 + dims.x * dims.y * dims.z + int(vpl)).x;
}

// The cell that a VPL shines from, `before` being the one before its surface: another if that is in another room, being on
// the other side of a second wall. False: there is none.
bool rooms_cell_before(ivec3 dims, uint vpl, inout ivec3 before)
{
    int cells = dims.x * dims.y * dims.z;
    uint instead = texelFetch(room_texels, 1 + cells + TYN_RADIAL_VPLS_MAX + int(vpl)).x;
    before = instead < uint(cells) ? quotient_place(instead, dims) : before;
    return instead != TYN_ROOMS_NONE;
}

// May light of a VPL of room `vpl` reach a cell of room `cell`?
bool rooms_joined(uint vpl, uint cell)
{
    return vpl == cell || vpl == TYN_ROOMS_ANY;
}

#endif
