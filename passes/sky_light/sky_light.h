// sky_light.h -- the light of principal ordinates: a sky that is dimmed or coloured changes this alone.
#pragma once
#include <tyndall/pass.h>
#include "shaders/light/ordinate_args.h"

typedef struct tyn_sky_light_params {
    uint32_t split; // 1: the mean of the sky (env_block.sky) is not in them
    uint32_t num_fixed;
    struct ordinate fixed[TYN_ORDINATES_MAX_FIXED]; // the first of the list, with their light
} tyn_sky_light_params;

// clang-format off
#define SKY_LIGHT_PORTS(X) \
    X(SKY_LIGHT, ENVIRONMENT, environment, IN, BUFFER, "struct env_block"), \
    X(SKY_LIGHT, ORDINATES, ordinates, IN, BUFFER, "struct ordinates_block, for a radiance of 1"), \
    X(SKY_LIGHT, LIT, lit, OUT, BUFFER, "struct ordinates_block, in W/m^2")
// clang-format on
TYN_PASS(SKY_LIGHT, sky_light);
