// list.h -- all lights of a scene in one list, for methods that ask every light at every point.
#pragma once
#include <tyndall/extend/sources.h>

typedef struct tyn_light_list {
    tyn_ref lights; // struct light_list_block
    tyn_ref shades; // struct light_shades_block, where the sky has directions
    uint32_t most;  // as many lights are in it at most
} tyn_light_list;

// Suns and lamps of the scene, and up to `lights` distant lights in the environment's place. After shadows and the sky's maps.
// The suns of a map are among the distant lights, which are points, as published; or `suns_apart`: they have shadow maps as those of
// the scene do, and distant lights are as wide as their regions.
tyn_light_list tyn_add_light_list(tyn_graph *g, const tyn_job *job, const tyn_sources *s,
                                  uint32_t lights, bool suns_apart);

// The passes of this call, for a method's table (tyndall/extend/method.h).
#define TYN_LIST_PASSES(X) X(env_importance), X(median_cut), X(light_list)
