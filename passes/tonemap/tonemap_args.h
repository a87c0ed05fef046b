// tonemap_args.h -- push constants of tonemap. Included by C and GLSL.
#include "shaders/common/shared.h"

struct tonemap_args {
    float scale;     // 2^exposure
    tyn_uint filmic; // 0: linear, clipped at 1
    tyn_uint dither;
    tyn_uint opaque;
};
TYN_ASSERT_SIZE(tonemap_args, 16);
