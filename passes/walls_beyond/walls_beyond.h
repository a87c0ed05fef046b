// walls_beyond.h -- surfaces that stand around the lattice, as walls of its outermost cells.
//
// Light that leaves the lattice towards a surface close by comes back from there. So links that lead out of the lattice are cut
// where a surface is within reach on the way on from them. For what follows light among cells (pass lattice) alone: where light
// is looked up, and what is a room, such surfaces are outside.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_walls_beyond_params {
    float reach; // "walls_beyond.reach"
    // Set by the method:
    float extent[3];  // medium_block.extent, m
    uint32_t dims[3]; // cells of the lattice (tyn_lattice_dims)
    uint32_t
        shining; // 1: walls inside send out light by themselves (pass wall_light): their cells stay as they are
} tyn_walls_beyond_params;

// clang-format off
#define WALLS_BEYOND_PORTS(X) \
    TYN_GEOMETRY(X, WALLS_BEYOND), \
    TYN_MATERIALS(X, WALLS_BEYOND), \
    X(WALLS_BEYOND, INNER_LINKS, inner_links, OPTIONAL, BUFFER, "of pass walls: wall_links"), \
    X(WALLS_BEYOND, INNER_CELLS, inner_cells, OPTIONAL, BUFFER, "wall_cells"), \
    TYN_WALLS(X##_OUT, WALLS_BEYOND)
// clang-format on
TYN_PASS(WALLS_BEYOND, walls_beyond);
