// columns.h -- optical depth along the principal ordinates, from where their light enters the medium's
// box to the cells of the lattice: along the ray to a cell's centre, with the mean length over the cell.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/beams/columns_args.h"

typedef struct tyn_columns_params {
    float extent[3];  // medium_block.extent, m
    uint32_t dims[3]; // cells of the lattice (tyn_lattice_dims)
    uint32_t mode;    // TYN_MEDIUM_*
    uint32_t count;   // ordinates at most; how many there are is in the block
} tyn_columns_params;

enum {
    TYN_MEDIUM(TYN_BUNDLE_ENUM, COLUMNS),  // IN
    TYN_COLUMNS(TYN_BUNDLE_ENUM, COLUMNS), // the ordinates IN, the columns OUT
    COLUMNS_PORT_NODES,                    // SCRATCH
    COLUMNS_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_columns;
