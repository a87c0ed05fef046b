// impostor_args.h -- push constants of the impostor. Included by C and GLSL.
#include "shaders/common/shared.h"

struct impostor_args {
    tyn_uint background; // 1: the environment is seen behind
};
TYN_ASSERT_SIZE(impostor_args, 4);
