// merge_grids_args.h -- arguments of the kernel. Included by C and GLSL.
#include "shaders/common/shared.h"

struct merge_grids_radial { // grids of one node of propagate_radial
    tyn_uint count;
    tyn_uint cells; // of a map along a side; the edge of a tile, less 2
    tyn_uint tiles; // a row of its `seen`
};

struct merge_grids_args {
    tyn_uvec3 dims; // cells of the result
    tyn_uint num_grids;
    tyn_uint grid_cells; // edge of a tile
    tyn_uint channels;
    tyn_uint tiles;    // a row of `seen`
    tyn_uint residuum; // 1: add it
    TYN_STRUCT(merge_grids_radial) lamps;
    TYN_STRUCT(merge_grids_radial) vpls;
};
TYN_ASSERT_SIZE(merge_grids_args, 56);
