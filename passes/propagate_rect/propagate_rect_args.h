// propagate_rect_args.h -- arguments of all kernels. Included by C and GLSL.
#ifndef TYN_PROPAGATE_RECT_ARGS_H
#define TYN_PROPAGATE_RECT_ARGS_H
#include "shaders/common/shared.h"

// Edge of the workgroups of kernels with one thread a cell.
#define PROPAGATE_RECT_GROUP 4
#define PROPAGATE_RECT_LOOKS 4 // at surfaces, along each side of a column of cells

struct propagate_rect_args {
    tyn_uint cells;
    tyn_uint channels;
    tyn_uint num_ordinates; // room for; the list may have fewer
    tyn_uint first;         // grid of this batch
    tyn_uint count;         // grids of this batch
    tyn_uint last_event;
    tyn_uint rate;
    tyn_uint prefilter;
    float beta;
    float voxel;         // of what the coefficients are read from, shortest edge, m
    tyn_uint tiles;      // a row, in images
    tyn_uint num_mapped; // grids whose lights have shadow maps, from the first on
};
TYN_ASSERT_SIZE(propagate_rect_args, 48);

#endif
