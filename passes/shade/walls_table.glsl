// walls_table.glsl -- the walls of the lattice's cells as an image: per lane, a CPU device fetches texels much
// faster than it reads buffers. WALLS_TABLE, if it is defined: the binding it is read from.
//
// RGBA32F, TYN_WALLS_PLANES + 1 entries per cell, behind each other along z: planes, then links, as two halves of
// whole numbers, and the cell's room (rooms.h).
#ifndef TYN_WALLS_TABLE_GLSL
#define TYN_WALLS_TABLE_GLSL
#include "shaders/walls/walls_args.h"

#ifdef WALLS_TABLE
layout(set = 0, binding = WALLS_TABLE) uniform sampler3D walls_table_tex;
#endif

vec4 walls_table_entry_of(uint links, uint room)
{
    return vec4(float(links & 0xffffu), float(links >> 16), float(room), 0.0);
}

uint walls_table_links(vec4 entry)
{
    return uint(entry.x) | uint(entry.y) << 16;
}

#endif
