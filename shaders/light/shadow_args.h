// shadow_args.h -- where each light's shadow map lies in the atlas. Included by C and GLSL; scalar layout.
#ifndef TYN_SHADOW_ARGS_H
#define TYN_SHADOW_ARGS_H
#include "shaders/common/shared.h"

// Index of a light among the maps: the suns that have beams first, then the lamps (points and spots).
#define TYN_SHADOW_SUNS 4 // of suns, in their order; TYN_BEAM_MAX_SUNS
#define TYN_SHADOW_LAMPS 64
#define TYN_SHADOW_MAX (TYN_SHADOW_SUNS + TYN_SHADOW_LAMPS)
#define TYN_SHADOW_LAMP(n) (TYN_SHADOW_SUNS + (n)) // n: in order of the lights that are no suns

#define TYN_SHADOW_NONE 0u // everything is lit
#define TYN_SHADOW_SUN 1u  // parallel
#define TYN_SHADOW_CONE 2u // one perspective map
#define TYN_SHADOW_CUBE 3u // six, face f at (f % 3, f / 3)

// Depths are reversed, 1 near and 0 far: those of lamps are near / (distance along the map's axis), so
// that floating point is as fine far away as it is close by.
struct shadow_light { // element of storage buffer "shadows", TYN_SHADOW_MAX of them
    tyn_vec4 rows[3]; // M -> the light's frame. SUN: (u, v, depth), u and v in [-1, 1] on the map.
                      // CONE: m, along the axis z. CUBE: m, axes of the cube
    tyn_vec2 offset;  // of the first map in the atlas, texels
    float texels;     // a side of a map
    float scale;      // CONE, CUBE: u = scale x / z, v = scale y / z
    float near;       // CONE, CUBE: m; what is nearer to the light casts no shadow
    tyn_uint kind;    // TYN_SHADOW_*
    tyn_uint wider;   // of the sky's maps: the one that covers all surfaces; 0: none does more than this
    tyn_uint pad;
};
TYN_ASSERT_SIZE(shadow_light, 80);

struct shadow_map_args { // of a map
    tyn_vec4 clip[4];    // world -> clip space, row by row
};
TYN_ASSERT_SIZE(shadow_map_args, 64);

#endif
