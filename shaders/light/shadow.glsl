// shadow.glsl -- whether a light sees a point, past the surfaces of the scene.
//
// Define SHADOWS_AT as the first binding of the bundle TYN_SHADOWS (bundles.h). A point is shadowed by
// what its light's map has in front of it; where there is no map everything is lit.
#ifndef TYN_SHADOW_GLSL
#define TYN_SHADOW_GLSL
#define SHADOW_LIGHTS (SHADOWS_AT + 1)
#include "shadow_frame.glsl"
#include "shadow_look.glsl"

layout(set = 0, binding = SHADOWS_AT) uniform sampler2D shadow_atlas;

float shadow_all_lit(const shadow_place place)
{
    return (shadow_lit_by(shadow_atlas, place) & SHADOW_LIT_BY_ALL) != 0u ? 1.0 : 0.0;
}

uint shadow_sun_lights(const shadow_light l, vec3 p)
{
    return shadow_lit_by(shadow_atlas, shadow_place_sun(l, shadow_frame(l, p)));
}

float shadow_visibility_sun_of(const shadow_light l, vec3 p)
{
    return (shadow_sun_lights(l, p) & SHADOW_LIT_BY_ALL) != 0u ? 1.0 : 0.0;
}

float shadow_visibility_sun(uint light, vec3 p)
{
    return shadow_visibility_sun_of(shadow_light_of(light), p);
}

// `q` in the lamp's frame.
uint shadow_lamp_lights_at(const shadow_light l, vec3 q)
{
    bool cube = l.kind == TYN_SHADOW_CUBE;
    uint face = mix(0u, shadow_face(q), cube);
    q = mix(q, shadow_on_face(face, q), bvec3(cube));
    return shadow_lit_by(shadow_atlas, shadow_place_lamp(l, face, q));
}

float shadow_visibility_lamp_at(const shadow_light l, vec3 q)
{
    return (shadow_lamp_lights_at(l, q) & SHADOW_LIT_BY_ALL) != 0u ? 1.0 : 0.0;
}

float shadow_visibility_lamp(uint light, vec3 p)
{
    shadow_light l = shadow_light_of(light);
    return shadow_visibility_lamp_at(l, shadow_frame(l, p));
}

// 1 where the light (an index of shadow_args.h) sees the point `p` of the medium (M), else 0.
float shadow_visibility(uint light, vec3 p)
{
    return light < TYN_SHADOW_SUNS ? shadow_visibility_sun(light, p)
                                   : shadow_visibility_lamp(light, p);
}

float shadow_visibility_surface_sun_of(const shadow_light l, const shadow_surface s)
{
    return shadow_visibility_on_sun_map(shadow_atlas, l, s);
}

float shadow_visibility_surface_lamp_of(const shadow_light l, const shadow_surface s)
{
    vec3 q = shadow_frame(l, s.p), m = shadow_frame_direction(l, s.n);
    uint face = 0u;
    if (l.kind == TYN_SHADOW_CUBE) {
        face = shadow_face(q);
        q = shadow_on_face(face, q);
        m = shadow_on_face(face, m);
    }
    shadow_place place = shadow_place_lamp(l, face, q);
    // 1 / z = (m.x u / scale + m.y v / scale + m.z) / dot(m, q)
    float height = dot(m, q);
    vec2 slope = l.near * m.xy / (l.scale * (abs(height) > 1e-20 ? height : 1e-20));
    // Depths are as small as near makes them. What p is off its plane by is to be seen from the lamp.
    float texel = 2.0 / (l.scale * l.texels);
    float off = 1e-5 * length(s.p) + s.off, bent = s.bent + SHADOW_BESIDE * s.bend * texel * q.z;
    float rounding = place.depth * min(off / max(abs(height), 1e-20) + bent / max(abs(height), SHADOW_SLANT * length(q)), 0.25);
    return shadow_visibility_on_plane(shadow_atlas, l, place, slope, rounding, texel * place.depth);
}

#endif
