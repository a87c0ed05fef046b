// path_probe.h -- the unbiased path tracer: the light field at points.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/path/path_scene.h"

// clang-format off
#define PATH_PROBE_PORTS(X) \
    TYN_PATH_SCENE(X, PATH_PROBE), \
    X(PATH_PROBE, POINTS, points, IN, BUFFER, "points in M, m"), \
    X(PATH_PROBE, STATE, state, INOUT, BUFFER, "tyn_path_probe_state_size bytes: a history"), \
    X(PATH_PROBE, RESULTS, results, OUT, BUFFER, \
        "tyn_probe_result[]: fluence and net flux with standard errors, W/m^2"), \
    X(PATH_PROBE, COUNTERS, counters, OUT, BUFFER, \
        "struct counters_block: collisions, cut paths, non-finite samples"), \
    X(PATH_PROBE, PARTIALS, partials, SCRATCH, BUFFER, "statistics of each thread")
// clang-format on
TYN_PASS(PATH_PROBE, path_probe);

// Bytes of its history.
uint64_t tyn_path_probe_state_size(uint32_t num_points);
