// wall_light_rooms.glsl -- the room of a cell, as the first virtual point light (VPL) that shines there.
//
// Include with the specialization constant `rooms`; define LATTICE_ROOMS, and WALL_LIGHT_FIRST: binding of the buffer.
#include "shaders/walls/lattice_rooms.glsl"

TYN_READ(WALL_LIGHT_FIRST, first, uint first[]); // by room

// WALL_LIGHT_DARK: none does.
uint first_vpl(uint cell)
{
    return first[rooms == 1 ? texelFetch(rooms_words, int(TYN_ROOMS_OF_CELL(cell))).x : TYN_ROOMS_OUTSIDE];
}
