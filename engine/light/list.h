// list.h -- all lights of a scene in one list, for methods that ask every light at every point.
#pragma once
#include "light/sources.h"
#include "passes/env_importance/env_importance.h"
#include "passes/light_list/light_list.h"
#include "passes/median_cut/median_cut.h"

// Suns and lamps of the scene, and up to `lights` distant lights in the environment's place, its own suns among them. After
// shadows. `most`: as many are in it at most.
tyn_ref tyn_add_light_list(tyn_graph *g, const tyn_job *job, const tyn_sources *s, uint32_t lights,
                           uint32_t *most);

#define TYN_LIST_PASSES &tyn_pass_env_importance, &tyn_pass_median_cut, &tyn_pass_light_list
