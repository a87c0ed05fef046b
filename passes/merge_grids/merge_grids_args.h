// merge_grids_args.h -- arguments of the kernel. Included by C and GLSL.
#ifndef TYN_MERGE_GRIDS_ARGS_H
#define TYN_MERGE_GRIDS_ARGS_H
#include "shared.h"

struct merge_grids_args {
    tyn_uvec3 dims; // cells of the result
    tyn_uint num_grids;
    tyn_uint grid_cells; // edge of a tile
    tyn_uint channels;
    tyn_uint tiles;    // a row of `seen`
    tyn_uint residuum; // 1: add it
    tyn_uint num_radial;
    tyn_uint radial_cells; // of a map along a side; the edge of a tile, less 2
    tyn_uint radial_tiles; // a row of `radial_seen`
};
TYN_ASSERT_SIZE(merge_grids_args, 44);

#endif
