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

// clang-format off
#define COLUMNS_PORTS(X) \
    TYN_MEDIUM(X, COLUMNS), \
    X(COLUMNS, ORDINATES, ordinates, IN, BUFFER, "struct ordinates_block"), \
    X(COLUMNS, COLUMNS, columns, OUT, BUFFER, "medium integrated along each ordinate to each cell, roots as halves"), \
    X(COLUMNS, COUNTERS, counters, OUT, BUFFER, "struct counters_block: pairs of cells that were not finite"), \
    X(COLUMNS, NODES, nodes, SCRATCH, BUFFER, "medium integrated along the columns of a batch of ordinates")
// clang-format on
TYN_PASS(COLUMNS, columns);
