// grid_place.h -- several grids of one medium, each with its own transform, made to fill the same box.
#pragma once
#include <tyndall/io.h>

enum { TYN_PLACED_MAX = 4 };

typedef struct tyn_placed_grid {
    uint32_t size[3], channels;
    float *data;               // replaced where the box is another
    double index_to_world[16]; // of its first voxel, as that of tyn_volume
    bool edge;                 // beyond its box it has the value at its edge, else 0
} tyn_placed_grid;

// Brings all into the voxels of the first, over the box around them; voxels that coincide keep their values, others are
// trilinear ones. At most `most` voxels. After a fault `why` says what is wrong.
tyn_result tyn_grids_align(tyn_placed_grid *grids, uint32_t count, uint64_t most, const char **why);
