// lattice_ordinates.h -- light of the sky's principal ordinates in the cells of the lattice.
#pragma once
#include <tyndall/pass.h>
#include "scene/lattice_shape.h"
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"

typedef struct tyn_lattice_ordinates_params {
    tyn_lattice_shape shape;
    uint32_t mode;  // TYN_MEDIUM_*
    uint32_t grey;  // 1: sigma_s, sigma_a and g are the same in all channels
    uint32_t count; // tyn_columns_params.count
} tyn_lattice_ordinates_params;

enum {
    LATTICE_ORDINATES_PORT_MEDIUM,                   // IN buffer struct medium_block
    TYN_COLUMNS(TYN_BUNDLE_ENUM, LATTICE_ORDINATES), // IN
    LATTICE_ORDINATES_PORT_CELLS,                    // IN 3D, of lattice_cells
    LATTICE_ORDINATES_PORT_SUNLIGHT, // IN optional 3D: `source` of lattice_source, which is added to
    LATTICE_ORDINATES_PORT_SOURCE, // OUT 3D RGBA32F, stacked: sum E T', sum a E T' direction (W/m^2)
    LATTICE_ORDINATES_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_lattice_ordinates;
