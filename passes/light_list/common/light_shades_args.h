// light_shades_args.h -- the directions of the sky (sky_map_args.h) that each light of the list stands for.
// Included by C and GLSL; scalar layout.
//
// A distant light in the environment's place is as wide as its region of the map: scattered from many directions and hidden bit by
// bit. Each direction counts for the light that is nearest to it, by its power. A sun without a shadow map of its own has one
// direction.
#include "light_list_args.h"
#include "shaders/light/ordinate_args.h"

// Directions with a light of their own, and for each light that none is nearest to the one that is nearest to it.
#define TYN_LIGHT_SHADES_MAX (TYN_ORDINATES_MAX + TYN_LIGHT_LIST_MAX)

struct light_shades_range { // of a light
    // In `shades`; 0: it is one direction, and has a shadow map of its own or none.
    tyn_uint first, count;
    tyn_uvec2 pad;
};
TYN_ASSERT_SIZE(light_shades_range, 16);

struct light_shade {
    tyn_uint direction; // whose map, if there are maps
    float share;        // of the light; of all of its shades 1
    tyn_uvec2 pad;
    tyn_vec3 along;    // of travel, M, unit
    float mean_cosine; // of the part of the sky that it stands for
};
TYN_ASSERT_SIZE(light_shade, 32);

struct light_shades_block { // storage buffer "light_shades", read as words of four
    TYN_STRUCT(light_shades_range) lights[TYN_LIGHT_LIST_MAX];
    TYN_STRUCT(light_shade) shades[TYN_LIGHT_SHADES_MAX];
};
TYN_ASSERT_SIZE(light_shades_block, 16 * TYN_LIGHT_LIST_MAX + 32 * TYN_LIGHT_SHADES_MAX);
