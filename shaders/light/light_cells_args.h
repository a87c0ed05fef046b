// light_cells_args.h -- which lights see all, or nothing, of a piece of the medium's box. Included by C and GLSL.
#ifndef LIGHT_CELLS_ARGS_H
#define LIGHT_CELLS_ARGS_H
#include "shadow_args.h"

// The image "light_cells" has a texel per cube of the box: a whole number, with two bits for each of the first
// TYN_LIGHT_CELLS lights of shadow_args.h, the first one lowest.
#define TYN_LIGHT_CELLS 12u // 24 bits, which a float holds
#define TYN_LIGHT_CELLS_MIXED 0u
#define TYN_LIGHT_CELLS_DARK 1u // nothing is seen, or shone on: beside the cone of a spot
#define TYN_LIGHT_CELLS_LIT 2u
// It holds within this many edges of the cube.
#define TYN_LIGHT_CELLS_REACH 0.75f

#define LIGHT_CELLS_BLOCK 8  // texels of the atlas along a side of the finest blocks
#define LIGHT_CELLS_LEVELS 4 // sizes of blocks, each twice the last
// So many blocks are about as wide as what a cube covers of a map, and no more than so many of the
// largest.
#define LIGHT_CELLS_ACROSS 2.0
#define LIGHT_CELLS_MOST 6.0

struct light_cells_args {
    tyn_uvec3 dims; // cubes
    float edge;     // m
};
TYN_ASSERT_SIZE(light_cells_args, 16);

#endif
