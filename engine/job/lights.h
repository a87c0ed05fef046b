// lights.h -- the lights of a frame in M: in which order they are, and which suns have beams.
#pragma once
#include <tyndall/scene.h>
#include "shaders/beams/beam_args.h"
#include "shaders/common/scene_args.h"

typedef struct tyn_lights {
    struct light_block scene[TYN_LIGHTS_MAX]; // directional lights, strongest first, then lamps
    uint32_t num_directional, num_lamps;
    // Directional lights and the suns of the environment's map, strongest first. `path` has the map's in the map.
    struct light_block suns[TYN_LIGHTS_MAX];
    uint32_t num_suns;
} tyn_lights;

// The strongest suns have a beam each: an aligned grid of optical depths and a shadow map. So many have.
static inline uint32_t tyn_num_beams(const tyn_lights *lights)
{
    return lights->num_suns < TYN_BEAM_MAX_SUNS ? lights->num_suns : TYN_BEAM_MAX_SUNS;
}

// Kind, colour and lobe of a light: all but where it is in M, and its shadow map.
struct light_block tyn_light_block(const tyn_light *light);

static inline const struct light_block *tyn_first_lamp(const tyn_lights *lights)
{
    return lights->scene + lights->num_directional;
}
