// lattice_source.h -- unscattered sunlight in the cells of the lattice.
#pragma once
#include <tyndall/pass.h>
#include <tyndall/extend/lattice_shape.h>
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"

typedef struct tyn_lattice_source_params {
    tyn_lattice_shape shape;
    uint32_t mode;     // TYN_MEDIUM_*
    uint32_t num_suns; // 0..4; 0: the pass need not be added
} tyn_lattice_source_params;

// clang-format off
#define LATTICE_SOURCE_PORTS(X) \
    TYN_MEDIUM(X, LATTICE_SOURCE), \
    X(LATTICE_SOURCE, LIGHTS, lights, IN, BUFFER, "struct light_block[]"), \
    X(LATTICE_SOURCE, CELLS, cells, IN, IMAGE_3D, "of lattice_cells"), \
    TYN_BEAMS(X, LATTICE_SOURCE), \
    TYN_WALLS(X##_OPTIONAL, LATTICE_SOURCE), \
    TYN_SHADOWS(X##_OPTIONAL, LATTICE_SOURCE), \
    X(LATTICE_SOURCE, SOURCE, source, OUT, RGBA_3D, \
        "unscattered fluence and flux of the suns, W/m^2; channels stacked along z"), \
    X(LATTICE_SOURCE, POWER, power, OUT, BUFFER, \
        "struct lattice_power per sun and channel: per sun the power that enters and that its beam loses, for" \
        " balance"), \
    X(LATTICE_SOURCE, SUNLIT, sunlit, SCRATCH, RGBA_3D, \
        "transmittance to each sun; a = how much of the cell sees it; suns stacked along z")
// clang-format on
TYN_PASS(LATTICE_SOURCE, lattice_source);
