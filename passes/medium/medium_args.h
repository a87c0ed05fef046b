// medium_args.h -- push constants of the medium pass. Included by C and GLSL.
#ifndef TYN_MEDIUM_ARGS_H
#define TYN_MEDIUM_ARGS_H
#include "shared.h"

struct resample_args {
    tyn_uint samples; // per axis of a voxel at the edge of a shape
};

struct bricks_args {
    tyn_uint textures; // 0: the solvers read the atlas itself, 1: density, 2: sigma_s and sigma_a
};

struct distance_args {
    tyn_uint axis;
};

#endif
