// sky_light_args.h -- push constants of sky_light. Included by C and GLSL.
#include "shaders/common/shared.h"

struct sky_light_args {
    tyn_uint num_fixed; // in front of the list
    tyn_uint split;     // 1: what is above or below the mean of the sky; 0: all light
};
TYN_ASSERT_SIZE(sky_light_args, 8);
