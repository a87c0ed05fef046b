// env_args.h -- the table by which paths draw directions towards the environment. Included by C and GLSL.
#ifndef TYN_ENV_ARGS_H
#define TYN_ENV_ARGS_H
#include "shaders/common/shared.h"

struct env_table_block { // head of the storage buffer; width * height entries follow
    // Cells of the table, a coarser image of the map (rows from +Y downwards).
    tyn_uint width, height;
    tyn_uint pad[2];
};
TYN_ASSERT_SIZE(env_table_block, 16);

// Walker's alias method: draw a cell uniformly, keep it with probability `keep`, else take `alias`.
struct env_cell {
    float keep;
    tyn_uint alias;
    float density; // probability of the cell times the number of cells: pdf over the unit square
};
TYN_ASSERT_SIZE(env_cell, 12);

#endif
