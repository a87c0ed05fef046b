// lattice_source.h -- unscattered sunlight in the cells of the lattice.
#pragma once
#include <tyndall/pass.h>
#include "scene/lattice_shape.h"
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"

typedef struct tyn_lattice_source_params {
    tyn_lattice_shape shape;
    uint32_t mode;     // TYN_MEDIUM_*
    uint32_t num_suns; // 0..4; 0: the pass need not be added
} tyn_lattice_source_params;

enum {
    TYN_MEDIUM(TYN_BUNDLE_ENUM, LATTICE_SOURCE),  // IN
    LATTICE_SOURCE_PORT_LIGHTS,                   // IN buffer struct light_block[]
    LATTICE_SOURCE_PORT_CELLS,                    // IN 3D
    TYN_BEAMS(TYN_BUNDLE_ENUM, LATTICE_SOURCE),   // IN
    TYN_WALLS(TYN_BUNDLE_ENUM, LATTICE_SOURCE),   // IN optional
    TYN_SHADOWS(TYN_BUNDLE_ENUM, LATTICE_SOURCE), // IN optional
    LATTICE_SOURCE_PORT_SOURCE, // OUT 3D RGBA32F, stacked: sum E T' over the suns, sum E T' direction (W/m^2)
    LATTICE_SOURCE_PORT_POWER, // OUT buffer: per sun the power that enters and that its beam loses, for balance
    LATTICE_SOURCE_PORT_SUNLIT, // SCRATCH
    LATTICE_SOURCE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_lattice_source;
