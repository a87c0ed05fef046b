// medium_args.h -- push constants of the medium pass. Included by C and GLSL.
#include "shaders/common/shared.h"

struct resample_args {
    tyn_uint samples; // per axis of a voxel at the edge of a shape
};

struct bricks_args {
    // Voxels by which the shapes are looked at beyond the brick: 1 where resampled textures are read, as
    // interpolation in the brick reaches voxels next to it; 0 for the shapes alone.
    float grow;
};

struct distance_args {
    tyn_uint axis;
};
