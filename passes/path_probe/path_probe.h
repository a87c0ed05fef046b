// path_probe.h -- the unbiased path tracer: the light field at points.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/path/path_scene.h"

enum {
    TYN_PATH_SCENE(TYN_BUNDLE_ENUM, PATH_PROBE), // IN
    TYN_GEOMETRY(TYN_BUNDLE_ENUM, PATH_PROBE), // IN optional; without nodes all triangles are tried
    TYN_MATERIALS(TYN_BUNDLE_ENUM, PATH_PROBE), // IN optional
    PATH_PROBE_PORT_POINTS,                     // IN buffer vec3[], M, m
    PATH_PROBE_PORT_STATE,    // INOUT buffer, tyn_path_probe_state_size bytes: a history
    PATH_PROBE_PORT_RESULTS,  // OUT buffer tyn_probe_result[]
    PATH_PROBE_PORT_COUNTERS, // OUT buffer struct counters_block
    PATH_PROBE_PORT_PARTIALS, // SCRATCH
    PATH_PROBE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_path_probe;

// Bytes of its history.
uint64_t tyn_path_probe_state_size(uint32_t num_points);
