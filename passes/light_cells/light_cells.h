// light_cells.h -- which lights see all, or nothing, of a piece of the medium's box: no look at their
// maps is needed there.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/light/light_cells_args.h"

typedef struct tyn_light_cells_params {
    int32_t cells; // "light_cells.cells"
    // Set by the method.
    float extent[3];              // of the medium's box, m
    uint32_t num_suns, num_lamps; // of shadow_map
} tyn_light_cells_params;

enum {
    TYN_SHADOWS(TYN_BUNDLE_ENUM, LIGHT_CELLS), // IN
    // SCRATCH 2D RG32F, with mips: least and greatest depth in blocks of the atlas
    LIGHT_CELLS_PORT_BLOCKS,
    LIGHT_CELLS_PORT_LIGHT_CELLS, // OUT 3D R32F: light_cells_args.h
    LIGHT_CELLS_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_light_cells;
