// refine_field_args.h -- push constants of the kernel. Included by C and GLSL.
#include "shaders/common/shared.h"

struct refine_field_args {
    tyn_uvec3 size;
    tyn_vec3 world[3]; // the world's axes in M
};
TYN_ASSERT_SIZE(refine_field_args, 48);
