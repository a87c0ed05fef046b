// env_glow_args.h -- push constants of env_glow. Included by C and GLSL.
#include "shaders/common/shared.h"

struct env_glow_args {
    float mip; // of the map: the finest one that has no more texels than the glow
};
TYN_ASSERT_SIZE(env_glow_args, 4);
