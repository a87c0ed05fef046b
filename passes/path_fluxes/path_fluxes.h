// path_fluxes.h -- the unbiased path tracer: where the light of suns and surroundings goes.
#pragma once
#include <tyndall/pass.h>
#include "shaders/path/path_scene.h"

enum {
    PATH_FLUXES_PORT_STATE =
        PATH_NUM_SCENE_PORTS,  // INOUT buffer, tyn_path_fluxes_state_size bytes: a history
    PATH_FLUXES_PORT_FLUXES,   // OUT buffer tyn_fluxes
    PATH_FLUXES_PORT_COUNTERS, // OUT buffer struct counters_block
    PATH_FLUXES_PORT_PARTIALS, // SCRATCH
    PATH_FLUXES_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_path_fluxes;

// Bytes of its history.
uint64_t tyn_path_fluxes_state_size(void);
