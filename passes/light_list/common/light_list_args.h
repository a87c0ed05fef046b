// light_list_args.h -- all lights of a scene as they shine on the medium, those that stand for its environment among them.
// Included by C and GLSL; scalar layout.
#ifndef TYN_LIGHT_LIST_ARGS_H
#define TYN_LIGHT_LIST_ARGS_H
#include "constellation_args.h"
#include "shaders/light/light_args.h"

#define TYN_LIGHT_LIST_MAX (TYN_CONSTELLATION_MAX + 68) // + TYN_LIGHTS_MAX

struct light_list_block { // storage buffer "light_list", read as words of four
    tyn_uint count;       // of lights
    tyn_vec3 mean; // of the light of all suns and the constellation: their sum / 4 pi, W/(m^2 sr)
    // In M, no `pad`: the constellation, suns, lamps. `shadow` is an index of shadow_args.h.
    TYN_STRUCT(light_block) lights[TYN_LIGHT_LIST_MAX];
};
TYN_ASSERT_SIZE(light_list_block, 16 + 64 * TYN_LIGHT_LIST_MAX);

#endif
