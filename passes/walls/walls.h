// walls.h -- which links between cells of the lattice the surfaces cut, and what they meet there.
//
// A cell lies wholly on the side of its centre. Light passes from cell to cell along links; a triangle
// that a link crosses stops it. Nothing leaks through closed meshes, and both ends of a link agree.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_walls_params {
    float extent[3];  // medium_block.extent, m
    uint32_t dims[3]; // cells of the lattice: tyn_lattice_dims
} tyn_walls_params;

// clang-format off
#define WALLS_PORTS(X) \
    TYN_GEOMETRY(X, WALLS), \
    TYN_MATERIALS(X, WALLS), \
    TYN_WALLS(X##_OUT, WALLS), \
    X(WALLS, HITS, hits, OUT, BUFFER, \
        "uint[link 0..13][cell]: the triangle that a cut link meets, in the low 24 bits, and 255 times its " \
        "share of the link in the others"), \
    X(WALLS, NEAREST, nearest, SCRATCH, BUFFER, "nearest triangle in the cell, per main direction of its normal")
// clang-format on
TYN_PASS(WALLS, walls);

// Triangles that the pass can tell apart.
enum { TYN_WALLS_MAX_TRIANGLES = 1 << 24 };
