// lattice_rooms.glsl -- rooms of the lattice's cells and of VPLs (rooms.h), from the texel buffer at binding LATTICE_ROOMS.
#ifndef TYN_LATTICE_ROOMS_GLSL
#define TYN_LATTICE_ROOMS_GLSL
#include "rooms.h"
#include "walls_links.glsl"
#include "shaders/common/quotient.glsl"

layout(set = 0, binding = LATTICE_ROOMS) uniform usamplerBuffer rooms_words;

uint rooms_of_cell(ivec3 dims, ivec3 c)
{
    return texelFetch(rooms_words, int(TYN_ROOMS_OF_CELL((c.z * dims.y + c.y) * dims.x + c.x))).x;
}

uint rooms_of_vpl(ivec3 dims, uint vpl)
{
    return texelFetch(rooms_words, int(TYN_ROOMS_OF_VPL(dims.x * dims.y * dims.z, vpl))).x;
}

// What a place in cell c, `at` being the nearest one of the lattice and `links` its, tells of the room that it is in;
// TYN_ROOMS_ANY: nothing, as a wall is near. `free`: also then, as no wall is between the place and the cell's centre.
uint rooms_told(ivec3 dims, ivec3 c, ivec3 at, uint links, bool free)
{
    bool unknown = walls_cut_off(c, at, links) || at == c && !free && (links & TYN_WALLS_NEAR) != 0u;
    return unknown ? TYN_ROOMS_ANY : at != c ? TYN_ROOMS_OUTSIDE : rooms_of_cell(dims, at);
}

// The cell that a VPL shines from, `before` being the one before its surface: another if that is in another room, being on
// the other side of a second wall. False: there is none.
bool rooms_cell_before(ivec3 dims, uint vpl, inout ivec3 before)
{
    int cells = dims.x * dims.y * dims.z;
    uint instead = texelFetch(rooms_words, int(TYN_ROOMS_BEFORE_VPL(cells, vpl))).x;
    before = instead < uint(cells) ? quotient_place(instead, dims) : before;
    return instead != TYN_ROOMS_NONE;
}

// May light of a VPL of room `vpl` reach a cell of room `cell`?
bool rooms_joined(uint vpl, uint cell)
{
    return vpl == cell || vpl == TYN_ROOMS_ANY;
}

#endif
