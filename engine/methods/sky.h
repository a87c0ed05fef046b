// sky.h -- the light of an environment map as principal ordinates, for the methods that use them.
#pragma once
#include "methods/nodes.h"

typedef struct tyn_sky_refs {
    tyn_ref sky; // the map without its suns (env_importance); {0} if the environment is constant
    tyn_ref ordinates; // struct ordinates_block; {0} if nothing shines from ordinates
    uint32_t count;    // ordinates at most
    bool split; // they carry the map less its mean, env_block.sky, which is left to the caller
} tyn_sky_refs;

// Adds env_importance, importance (where the setting wants it) and ordinates as far as the scene has
// use for them. `first_sun`: that of frame->suns from which on suns are given ordinates, since they
// have no aligned grid of their own. `can_split`: the method has a way for light that is equal from
// all sides.
tyn_result tyn_add_sky(tyn_graph *g, const tyn_job *job, const tyn_medium_refs *medium,
                       uint32_t first_sun, bool can_split, tyn_sky_refs *sky);
