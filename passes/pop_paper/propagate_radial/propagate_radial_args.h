// propagate_radial_args.h -- arguments of all kernels. Included by C and GLSL.
#include "shaders/common/shared.h"

// Edge of the workgroups of kernels with one thread a cell.
#define PROPAGATE_RADIAL_GROUP 4
#define PROPAGATE_RADIAL_LOOKS 4  // at surfaces, along each side of a texel of the map
#define PROPAGATE_RADIAL_LANES 64 // threads that lay out one grid

#define PROPAGATE_RADIAL_INIT_ENTRY 0
#define PROPAGATE_RADIAL_INIT_FIRST_COLLISION 1

struct propagate_radial_args {
    tyn_uint cells;  // of a map along a side
    tyn_uint layers; // shells and the ball
    tyn_uint channels;
    tyn_uint num_lamps;
    tyn_uint max_vpls;
    tyn_uint first; // grid of this batch
    tyn_uint count; // grids of this batch
    tyn_uint init;
    tyn_uint scale; // TYN_PROPAGATE_SCALE_*
    tyn_uint last_event;
    tyn_uint rate;
    tyn_uint narrowing;
    tyn_uint prefilter;
    float beta;
    float voxel;    // of the medium, shortest edge, m
    tyn_uint tiles; // a row, in images
};
TYN_ASSERT_SIZE(propagate_radial_args, 64);
