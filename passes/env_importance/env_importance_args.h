// env_importance_args.h -- push constants of env_importance. Included by C and GLSL.
#include "shaders/light/sky_args.h"

struct env_importance_args {
    tyn_uint num_suns;
    TYN_STRUCT(sky_sun) suns[SKY_SUNS_MAX];
};
TYN_ASSERT_SIZE(env_importance_args, 116);
