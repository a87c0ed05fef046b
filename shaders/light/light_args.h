// light_args.h -- suns, lamps and virtual point lights, and how much lamps of each kind shine in a direction.
// Included by C and GLSL; scalar layout.
#ifndef TYN_LIGHT_ARGS_H
#define TYN_LIGHT_ARGS_H
#include "shaders/common/shared.h"

#define TYN_LIGHT_KIND_DIRECTIONAL 0
#define TYN_LIGHT_KIND_POINT 1
#define TYN_LIGHT_KIND_SPOT 2   // as in KHR_lights_punctual
#define TYN_LIGHT_KIND_COSINE 3 // Lambertian

#define TYN_LIGHT_NO_SHADOW 0xffffffffu

// A sun, a lamp, or a virtual point light (VPL) that stands for light reflected or emitted by a piece of a
// surface. Whole rows of four words, so that it can be read as texels.
struct light_block {
    tyn_vec3 position; // M, m; not of suns
    tyn_uint kind;     // TYN_LIGHT_KIND_*
    tyn_vec3 color;    // W/m^2 (suns) or W/sr, along the direction
    // Lamps have all of their intensity within the cone of cos_inner about their direction and nothing
    // outside that of cos_outer: -1 and -1 if they shine alike all around, 1 and 0 of a cosine lobe.
    float cos_inner;
    tyn_vec3 direction; // M, unit, direction of travel
    float cos_outer;
    float radius;      // of the disc that a VPL stands for, m; 0: a point. Bounds 1 / r^2
    tyn_uint shadow;   // its shadow map, TYN_SHADOW_LAMP(n); TYN_LIGHT_NO_SHADOW: none
    float mean_cosine; // of a sun's disc as seen from the medium; 1: it is one direction
    tyn_uint pad;
};
TYN_ASSERT_SIZE(light_block, 64);

TYN_FUNCTION float light_strength(TYN_STRUCT(light_block) light)
{
    float most = light.color[0] > light.color[1] ? light.color[0] : light.color[1];
    return most > light.color[2] ? most : light.color[2];
}

// Share of a lamp's intensity at an angle to its direction, of which c is the cosine, times `weight`.
TYN_FUNCTION float light_lobe_times(TYN_STRUCT(light_block) light, float c, float weight)
{
    if (light.kind == TYN_LIGHT_KIND_POINT) {
        return weight;
    }
    if (light.kind == TYN_LIGHT_KIND_COSINE) {
        return c > 0.0f ? weight * c : 0.0f;
    }
    float width = light.cos_inner - light.cos_outer;
    if (width < 1e-6f) { // a sharp edge
        return c >= light.cos_outer ? weight : 0.0f;
    }
    float a = (c - light.cos_outer) / width;
    a = a < 0.0f ? 0.0f : a > 1.0f ? 1.0f : a;
    return weight * a * a;
}

TYN_FUNCTION float light_lobe(TYN_STRUCT(light_block) light, float c)
{
    return light_lobe_times(light, c, 1.0f);
}

// Its integral over all directions, sr.
TYN_FUNCTION float light_lobe_integral(TYN_STRUCT(light_block) light)
{
    const float PI = 3.14159265358979f;
    if (light.kind == TYN_LIGHT_KIND_POINT) {
        return 4.0f * PI;
    }
    if (light.kind == TYN_LIGHT_KIND_COSINE) {
        return PI;
    }
    return 2.0f * PI * (1.0f - (2.0f * light.cos_inner + light.cos_outer) / 3.0f);
}

#endif
