// shadow_frame.glsl -- the maps' list, and places in the frames of their lights.
//
// Define SHADOW_LIGHTS as the binding of the list that pass shadow_map makes (without it there is none), and SHADOWS_STORAGE or SHADOWS_TEXELS if
// that is a storage buffer or one of texels: a uniform one is faster on lavapipe, which has room for seven.
#ifndef TYN_SHADOW_FRAME_GLSL
#define TYN_SHADOW_FRAME_GLSL
#include "shadow_args.h"

#ifdef SHADOW_LIGHTS
#ifdef SHADOWS_TEXELS
layout(set = 0, binding = SHADOW_LIGHTS) uniform usamplerBuffer shadows_texels;

shadow_light shadow_light_of(uint n)
{
    int at = 5 * int(n);
    vec4 rows[3];
    for (int k = 0; k < 3; k++) {
        rows[k] = uintBitsToFloat(texelFetch(shadows_texels, at + k));
    }
    vec4 place = uintBitsToFloat(texelFetch(shadows_texels, at + 3));
    uvec4 kind = texelFetch(shadows_texels, at + 4);
    return shadow_light(rows, place.xy, place.z, place.w, uintBitsToFloat(kind.x), kind.y, kind.z, kind.w);
}
#else
#ifdef SHADOWS_STORAGE
TYN_READ(SHADOW_LIGHTS, shadows, shadow_light shadows[]);
#else
TYN_UNIFORM(SHADOW_LIGHTS, shadows, shadow_light shadows[TYN_SHADOW_MAX]);
#endif

shadow_light shadow_light_of(uint n)
{
    return shadows[n];
}
#endif
#endif

vec3 shadow_frame(const shadow_light l, vec3 p)
{
    return vec3(dot(l.rows[0].xyz, p) + l.rows[0].w, dot(l.rows[1].xyz, p) + l.rows[1].w,
                dot(l.rows[2].xyz, p) + l.rows[2].w);
}

vec3 shadow_frame_direction(const shadow_light l, vec3 n)
{
    return vec3(dot(l.rows[0].xyz, n), dot(l.rows[1].xyz, n), dot(l.rows[2].xyz, n));
}

// The face of the cube that a direction goes through, and the components along its u, v and axis.
uint shadow_face(vec3 q)
{
    vec3 a = abs(q);
    bool x = a.x >= a.y && a.x >= a.z, y = a.y >= a.z;
    float major = x ? q.x : y ? q.y : q.z;
    return (x ? 0u : y ? 2u : 4u) + (major < 0.0 ? 1u : 0u);
}

vec3 shadow_on_face(uint face, vec3 q)
{
    vec3 turned = face < 2u ? q.yzx : face < 4u ? q.zxy : q;
    return vec3(turned.xy, (face & 1u) != 0u ? -turned.z : turned.z);
}

#endif
