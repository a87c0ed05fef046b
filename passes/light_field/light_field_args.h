// light_field_args.h -- push constants of the kernel. Included by C and GLSL.
#include "shaders/common/shared.h"

struct light_field_args {
    tyn_vec3 world[3]; // the world's axes, which probes' fluxes are along, by the images' axes
};
TYN_ASSERT_SIZE(light_field_args, 36);
