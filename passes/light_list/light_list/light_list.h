// light_list.h -- all lights as they shine on the medium: a constellation turned with the environment, suns, lamps.
//
// For methods that ask every light at every point: any number of suns, and distant lights in an environment's place.
#pragma once
#include <tyndall/pass.h>
#include "light_list_args.h"
#include "../common/light_shades_args.h"

typedef struct tyn_light_list_params {
    struct light_list_args listed; // set by the method
} tyn_light_list_params;

// clang-format off
#define LIGHT_LIST_PORTS(X) \
    X(LIGHT_LIST, CONSTELLATION, constellation, OPTIONAL, BUFFER, "of median_cut"), \
    X(LIGHT_LIST, SUNS, suns, IN, BUFFER, "struct light_block[]: suns"), \
    X(LIGHT_LIST, LIGHTS, lights, IN, BUFFER, "struct light_block[]: lamps, from `first_lamp` on"), \
    X(LIGHT_LIST, ENVIRONMENT, environment, IN, BUFFER, "struct env_block"), \
    X(LIGHT_LIST, DIRECTIONS, directions, OPTIONAL, BUFFER, \
        "struct ordinates_block: directions of the sky; the fixed ones are the suns without shadow maps"), \
    X(LIGHT_LIST, LIGHT_LIST, light_list, OUT, BUFFER, "struct light_list_block"), \
    X(LIGHT_LIST, LIGHT_SHADES, light_shades, OUT, BUFFER, "struct light_shades_block: with directions")
// clang-format on
TYN_PASS(LIGHT_LIST, light_list);
