// lattice_cells.h -- the medium averaged over the cells of the lattice.
#pragma once
#include <tyndall/pass.h>
#include "scene/lattice_shape.h"
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"

typedef struct tyn_lattice_cells_params {
    tyn_lattice_shape shape;
    uint32_t mode; // TYN_MEDIUM_*
} tyn_lattice_cells_params;

enum {
    TYN_MEDIUM(TYN_BUNDLE_ENUM, LATTICE_CELLS), // IN
    LATTICE_CELLS_PORT_CELLS, // OUT 3D RGBA32F, channels stacked along z: sigma_s', sigma_a, g', emission
    LATTICE_CELLS_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_lattice_cells;
