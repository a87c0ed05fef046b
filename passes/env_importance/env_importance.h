// env_importance.h -- an environment map without its suns, as a pyramid by solid angle.
//
// Depends on the map alone, not on how it is turned or scaled: it runs when the map changes.
#pragma once
#include <tyndall/pass.h>
#include "env_importance_args.h"

typedef struct tyn_env_importance_params {
    struct env_importance_args suns; // set by the method: those that are taken out
} tyn_env_importance_params;

enum {
    ENV_IMPORTANCE_PORT_ENV_MAP, // IN 2D latitude-longitude map of any size
    ENV_IMPORTANCE_PORT_SKY, // OUT 2D RGBA32F SKY_WIDTH x SKY_HEIGHT, SKY_MIPS levels: mean radiance over
    // the texel, map units; luminance x solid angle, so that the level above
    // has the sum of its four
    ENV_IMPORTANCE_PORT_SUMS, // OUT buffer struct sky_sum[(SKY_SUMS_HEIGHT + 1) (SKY_SUMS_WIDTH + 1)]
    ENV_IMPORTANCE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_env_importance;
