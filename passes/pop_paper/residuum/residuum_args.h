// residuum_args.h -- arguments of all kernels. Included by C and GLSL.
#include "shaders/common/shared.h"

struct residuum_args {
    tyn_uvec3 dims; // cells
    tyn_uint num_grids;
    tyn_uint grid_cells; // edge of a tile
    tyn_uint grid_along; // cells along the light; 0 = cubes
    tyn_uint channels;
    tyn_uint tiles; // a row of `light`
};
TYN_ASSERT_SIZE(residuum_args, 32);
