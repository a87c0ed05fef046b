// path_balance.h -- the unbiased path tracer: where the energy goes.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/path/path_scene.h"

// clang-format off
#define PATH_BALANCE_PORTS(X) \
    TYN_PATH_SCENE(X, PATH_BALANCE), \
    X(PATH_BALANCE, STATE, state, INOUT, BUFFER, "struct path_balance_state: a history"), \
    X(PATH_BALANCE, BALANCE, balance, OUT, BUFFER, "tyn_balance: power entering, emitted, absorbed, escaped, W"), \
    X(PATH_BALANCE, RESULT, result, OUT, BUFFER, "struct path_balance_result: values and standard errors"), \
    X(PATH_BALANCE, COUNTERS, counters, OUT, BUFFER, \
        "struct counters_block: collisions, cut paths, non-finite samples"), \
    X(PATH_BALANCE, PARTIALS, partials, SCRATCH, BUFFER, "statistics of each thread"), \
    X(PATH_BALANCE, AREAS, areas, OPTIONAL, BUFFER, "struct surface_table and cells, optional")
// clang-format on
TYN_PASS(PATH_BALANCE, path_balance);
