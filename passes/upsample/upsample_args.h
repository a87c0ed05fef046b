// upsample_args.h -- arguments of the kernel. Included by C and GLSL.
#ifndef TYN_UPSAMPLE_ARGS_H
#define TYN_UPSAMPLE_ARGS_H
#include "shared.h"

struct upsample_args {
    tyn_uvec3 dims; // cells of the result, without the ghost layer
    tyn_uint num_suns;
    tyn_uint grid_cells; // along each axis of a grid's part of the stacked images
    float range;
};
TYN_ASSERT_SIZE(upsample_args, 24);

#endif
