// rsm_draw_args.h -- push constants of a reflective shadow map.
#include "shaders/common/shared.h"

struct rsm_draw_args {
    tyn_vec4 clip[4]; // world -> clip space, row by row
    tyn_vec3 extent;  // of the box of the media, m
    float texel;      // area of a texel across the sun, m^2; solid angle of one in the middle, sr
    tyn_uint kind;    // TYN_SHADOW_SUN, CONE or CUBE
    tyn_uint light;   // in the buffer "suns" (SUN) or "lights"
};
TYN_ASSERT_SIZE(rsm_draw_args, 88);
