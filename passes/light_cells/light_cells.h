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

// clang-format off
#define LIGHT_CELLS_PORTS(X) \
    TYN_SHADOWS(X, LIGHT_CELLS), \
    X(LIGHT_CELLS, BLOCKS, blocks, SCRATCH, IMAGE_2D, \
        "with mips: least and greatest depth in blocks of the atlas", .format = VK_FORMAT_R32G32_SFLOAT), \
    X(LIGHT_CELLS, LIGHT_CELLS, light_cells, OUT, IMAGE_3D, \
        "light_cells_args.h: a whole number: two bits a light, 1 dark, 2 lit, 0 neither", \
        .format = VK_FORMAT_R32_SFLOAT)
// clang-format on
TYN_PASS(LIGHT_CELLS, light_cells);
