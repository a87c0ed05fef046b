// env_importance.h -- an environment map without its suns, as a pyramid by solid angle.
//
// Depends on the map alone, not on how it is turned or scaled: it runs when the map changes.
#pragma once
#include <tyndall/pass.h>
#include "env_importance_args.h"

typedef struct tyn_env_importance_params {
    struct env_importance_args suns; // set by the method: those that are taken out
} tyn_env_importance_params;

// clang-format off
#define ENV_IMPORTANCE_PORTS(X) \
    X(ENV_IMPORTANCE, ENV_MAP, env_map, IN, IMAGE_2D, "latitude-longitude map of any size"), \
    X(ENV_IMPORTANCE, SKY, sky, OUT, RGBA_2D, \
        "SKY_WIDTH x SKY_HEIGHT, SKY_MIPS levels: mean radiance over the texel, map units; luminance x solid " \
        "angle, so that the level above has the sum of its four"), \
    X(ENV_IMPORTANCE, SUMS, sums, OUT, BUFFER, "sums of the sky over rectangles: struct sky_sum")
// clang-format on
TYN_PASS(ENV_IMPORTANCE, env_importance);
