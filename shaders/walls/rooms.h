// rooms.h -- which cells of the lattice are joined by open links. Included by C and GLSL.
//
// A room is the cells that open links join, or VPLs that see both. Storage buffer "rooms": uint[]
//   0: the room of all that is outside the lattice, which is 0
//   TYN_ROOMS_OF_CELL: those of the cells, x fastest
//   TYN_ROOMS_OF_VPL: those that the VPLs shine in, or TYN_ROOMS_ANY
//   TYN_ROOMS_BEFORE_VPL: cells; of VPLs the one before whose surface is in another room, the nearest one that is not,
//     TYN_ROOMS_NONE if no neighbour is; of others TYN_ROOMS_ANY
// Of a lattice of `cells` cells.
#ifndef TYN_ROOMS_H
#define TYN_ROOMS_H

#include "shaders/beams/radial_args.h"

#define TYN_ROOMS_OF_CELL(cell) (1u + (cell))
#define TYN_ROOMS_OF_VPL(cells, vpl) (1u + (cells) + (vpl))
#define TYN_ROOMS_BEFORE_VPL(cells, vpl) (1u + (cells) + TYN_RADIAL_VPLS_MAX + (vpl))
#define TYN_ROOMS_ELEMENTS(cells) (1u + (cells) + TYN_RADIAL_VPLS_MAX) // that are in rooms
#define TYN_ROOMS_SIZE(cells) (1u + (cells) + 2 * TYN_RADIAL_VPLS_MAX)

#define TYN_ROOMS_OUTSIDE 0u
#define TYN_ROOMS_ANY 0xffffffffu // of a VPL of which it is not known
#define TYN_ROOMS_NONE 0xfffffffeu

#endif
