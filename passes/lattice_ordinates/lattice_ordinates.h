// lattice_ordinates.h -- light of the sky's principal ordinates in the cells of the lattice.
#pragma once
#include <tyndall/pass.h>
#include <tyndall/extend/lattice_shape.h>
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"

typedef struct tyn_lattice_ordinates_params {
    tyn_lattice_shape shape;
    uint32_t mode;  // TYN_MEDIUM_*
    uint32_t grey;  // 1: sigma_s, sigma_a and g are the same in all channels
    uint32_t count; // tyn_columns_params.count
} tyn_lattice_ordinates_params;

// clang-format off
#define LATTICE_ORDINATES_PORTS(X) \
    X(LATTICE_ORDINATES, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    TYN_COLUMNS(X, LATTICE_ORDINATES), \
    X(LATTICE_ORDINATES, CELLS, cells, IN, IMAGE_3D, "of lattice_cells"), \
    X(LATTICE_ORDINATES, SUNLIGHT, sunlight, OPTIONAL, IMAGE_3D, "`source` of lattice_source, which is added to"), \
    X(LATTICE_ORDINATES, SOURCE, source, OUT, IMAGE_3D, \
        "unscattered fluence and flux of suns and ordinates, W/m^2; channels stacked along z", \
        .format = VK_FORMAT_R32G32B32A32_SFLOAT)
// clang-format on
enum { LATTICE_ORDINATES_PORTS(TYN_PORT_ENUM), LATTICE_ORDINATES_NUM_PORTS };
extern const tyn_pass_desc tyn_pass_lattice_ordinates;
