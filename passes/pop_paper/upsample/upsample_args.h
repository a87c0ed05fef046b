// upsample_args.h -- arguments of the kernel. Included by C and GLSL.
#include "shaders/common/shared.h"

struct upsample_args {
    tyn_uvec3 dims; // cells of the result, without the ghost layer
    float range;
};
TYN_ASSERT_SIZE(upsample_args, 16);
