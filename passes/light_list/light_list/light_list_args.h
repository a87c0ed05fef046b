// light_list_args.h -- push constants of the list of lights. Included by C and GLSL.
#include "../common/light_list_args.h"
#include "shaders/light/shadow_args.h"

struct light_list_args {
    tyn_uint constellation; // 1: there is one
    tyn_uint num_suns;      // the first of "suns"
    tyn_uint num_lamps;
    tyn_uint shadows; // 1: suns and lamps have shadow maps
    // Which of the suns that have a shadow map each of the first is, or TYN_LIGHT_NO_SHADOW.
    tyn_uint sun_shadow[4];
    tyn_uint suns_with_shadow; // so many of `sun_shadow` count
    tyn_uint first_lamp;       // in "lights"
    tyn_uint
        wide; // 1: lights of the constellation are as wide as their regions (mean cosines), else points
};
TYN_ASSERT_SIZE(light_list_args, 44);
