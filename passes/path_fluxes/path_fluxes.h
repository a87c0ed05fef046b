// path_fluxes.h -- the unbiased path tracer: where the light of suns and surroundings goes.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/path/path_scene.h"

// clang-format off
#define PATH_FLUXES_PORTS(X) \
    TYN_PATH_SCENE(X, PATH_FLUXES), \
    X(PATH_FLUXES, STATE, state, INOUT, BUFFER, "struct path_fluxes_state: a history"), \
    X(PATH_FLUXES, FLUXES, fluxes, OUT, BUFFER, "tyn_fluxes: power, and standard errors, W"), \
    X(PATH_FLUXES, COUNTERS, counters, OUT, BUFFER, \
        "struct counters_block: collisions, cut paths, non-finite paths"), \
    X(PATH_FLUXES, PARTIALS, partials, SCRATCH, BUFFER, "mean of each thread's paths")
// clang-format on
TYN_PASS(PATH_FLUXES, path_fluxes);
