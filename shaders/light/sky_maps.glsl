// sky_maps.glsl -- what surfaces hide of the directions of the sky.
//
// Define SKY_MAPS_AT as the first binding of the bundle TYN_SKY_MAPS (bundles.h). Include after shadow_frame.glsl.
#ifndef TYN_SKY_MAPS_GLSL
#define TYN_SKY_MAPS_GLSL
#include "sky_map_args.h"
#include "shadow_look.glsl"

layout(set = 0, binding = SKY_MAPS_AT) uniform sampler2D sky_atlas;
layout(set = 0, binding = SKY_MAPS_AT + 1) uniform usamplerBuffer sky_maps_texels;

shadow_light sky_map_of(uint n)
{
    int at = 5 * int(n);
    vec4 rows[3];
    for (int k = 0; k < 3; k++) {
        rows[k] = uintBitsToFloat(texelFetch(sky_maps_texels, at + k));
    }
    vec4 place = uintBitsToFloat(texelFetch(sky_maps_texels, at + 3));
    uvec4 kind = texelFetch(sky_maps_texels, at + 4);
    return shadow_light(rows, place.xy, place.z, place.w, uintBitsToFloat(kind.x), kind.y, kind.z, kind.w);
}

// The map of the same direction that shows place p: `map`, or beyond what it covers the wider one.
shadow_light sky_map_around(const shadow_light map, vec3 p)
{
    vec2 q = shadow_frame(map, p).xy;
    if (map.wider > 0u && any(greaterThanEqual(abs(q), vec2(1.0)))) {
        return sky_map_of(map.wider);
    }
    return map;
}

// Of a place in the medium: SHADOW_LIT_BY_*.
uint sky_map_lights(const shadow_light map, vec3 p)
{
    return shadow_lit_by(sky_atlas, shadow_place_sun(map, shadow_frame(map, p)));
}

#endif
