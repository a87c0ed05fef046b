// path_fluxes.h -- the unbiased path tracer: where the light of suns and surroundings goes.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/path/path_scene.h"

enum {
    TYN_PATH_SCENE(TYN_BUNDLE_ENUM, PATH_FLUXES), // IN
    TYN_GEOMETRY(TYN_BUNDLE_ENUM,
                 PATH_FLUXES), // IN optional; without nodes all triangles are tried
    TYN_MATERIALS(TYN_BUNDLE_ENUM, PATH_FLUXES), // IN optional
    PATH_FLUXES_PORT_STATE,    // INOUT buffer, tyn_path_fluxes_state_size bytes: a history
    PATH_FLUXES_PORT_FLUXES,   // OUT buffer tyn_fluxes
    PATH_FLUXES_PORT_COUNTERS, // OUT buffer struct counters_block
    PATH_FLUXES_PORT_PARTIALS, // SCRATCH
    PATH_FLUXES_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_path_fluxes;

// Bytes of its history.
uint64_t tyn_path_fluxes_state_size(void);
