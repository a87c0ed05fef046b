// path_balance.h -- the unbiased path tracer: where the energy goes.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/path/path_scene.h"

enum {
    TYN_PATH_SCENE(TYN_BUNDLE_ENUM, PATH_BALANCE), // IN
    TYN_GEOMETRY(TYN_BUNDLE_ENUM,
                 PATH_BALANCE), // IN optional; without nodes all triangles are tried
    TYN_MATERIALS(TYN_BUNDLE_ENUM, PATH_BALANCE), // IN optional
    PATH_BALANCE_PORT_STATE,    // INOUT buffer, tyn_path_balance_state_size bytes: a history
    PATH_BALANCE_PORT_BALANCE,  // OUT buffer tyn_balance
    PATH_BALANCE_PORT_RESULT,   // OUT buffer struct path_balance_result: values and standard errors
    PATH_BALANCE_PORT_COUNTERS, // OUT buffer struct counters_block
    PATH_BALANCE_PORT_PARTIALS, // SCRATCH
    PATH_BALANCE_PORT_AREAS,    // IN buffer struct surface_table and cells, optional
    PATH_BALANCE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_path_balance;

// Bytes of its history.
uint64_t tyn_path_balance_state_size(void);
