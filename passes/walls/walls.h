// walls.h -- which links between cells of the lattice the surfaces cut, and what they meet there.
//
// A cell lies wholly on the side of its centre. Light passes from cell to cell along links; a triangle
// that a link crosses stops it. Nothing leaks through closed meshes, and both ends of a link agree.
#pragma once
#include <tyndall/pass.h>

typedef struct tyn_walls_params {
    float extent[3];  // medium_block.extent, m
    uint32_t dims[3]; // cells of the lattice: tyn_lattice_dims
} tyn_walls_params;

enum {
    WALLS_PORT_SURFACES,  // IN buffer struct surface_block
    WALLS_PORT_VERTICES,  // IN buffer struct surface_vertex[]
    WALLS_PORT_TRIANGLES, // IN buffer struct surface_triangle[]: their number is the buffer's size
    WALLS_PORT_MATERIALS, // IN buffer struct surface_material[]
    WALLS_PORT_TEXTURES,  // IN optional buffer struct surface_texture[]
    WALLS_PORT_TEXELS,    // IN optional buffer uint[]
    WALLS_PORT_LINKS,     // OUT buffer uint[cell]: walls_args.h
    WALLS_PORT_CELLS,     // OUT buffer struct wall_cell[cell]
    WALLS_PORT_HITS,      // SCRATCH
    WALLS_PORT_NEAREST,   // SCRATCH
    WALLS_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_walls;

// Triangles that the pass can tell apart.
enum { TYN_WALLS_MAX_TRIANGLES = 1 << 24 };
