// lattice_cells.h -- the medium averaged over the cells of the lattice.
#pragma once
#include <tyndall/pass.h>
#include <tyndall/extend/lattice_shape.h>
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"

typedef struct tyn_lattice_cells_params {
    tyn_lattice_shape shape;
    uint32_t mode; // TYN_MEDIUM_*
} tyn_lattice_cells_params;

// clang-format off
#define LATTICE_CELLS_PORTS(X) \
    TYN_MEDIUM(X, LATTICE_CELLS), \
    X(LATTICE_CELLS, CELLS, cells, OUT, RGBA_3D, \
        "cell means of sigma_s', sigma_a (1/m), g', emission (W/(m^3 sr)); channels stacked along z")
// clang-format on
TYN_PASS(LATTICE_CELLS, lattice_cells);
