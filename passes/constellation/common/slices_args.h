// slices_args.h -- how rays are cut into slices. Included by C and GLSL; scalar layout.
#ifndef TYN_SLICES_ARGS_H
#define TYN_SLICES_ARGS_H
#include "shaders/common/shared.h"

struct slices_args {
    float distance; // between two slices, m
    float margin;   // half the diagonal of a voxel, m (slices_skipped)
};
TYN_ASSERT_SIZE(slices_args, 8);

#endif
