// rooms.h -- which cells of the lattice are joined by open links. Included by C and GLSL.
//
// A room is the cells that open links join, or VPLs that see both. Storage buffer "rooms": uint[]
//   the room of all that is outside the lattice, which is 0
//   those of the cells, x fastest
//   TYN_RADIAL_VPLS_MAX of those that the VPLs shine in, or TYN_ROOMS_ANY
//   TYN_RADIAL_VPLS_MAX cells: of VPLs the one before whose surface is in another room, the nearest one that is not;
//     TYN_ROOMS_NONE if no neighbour is; of others TYN_ROOMS_ANY
#ifndef TYN_ROOMS_H
#define TYN_ROOMS_H

#define TYN_ROOMS_OUTSIDE 0u
#define TYN_ROOMS_ANY 0xffffffffu // of a VPL of which it is not known
#define TYN_ROOMS_NONE 0xfffffffeu

#endif
