// shadow_eval.comp -- visibility of lights at given points.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define SHADOWS_AT 0
#define SHADOWS_STORAGE
#include "shaders/light/shadow.glsl"

layout(local_size_x = 64) in;
struct point {
    vec3 p;
    uint light;
    vec3 normal; // 0: a point of the medium
};
layout(set = 0, binding = 2, scalar) readonly buffer points_buffer { point points[]; };
layout(set = 0, binding = 3, scalar) writeonly buffer results_buffer { float results[]; };

float visibility_of_surface(uint light, shadow_surface s)
{
    shadow_light l = shadow_light_of(light);
    return l.kind == TYN_SHADOW_SUN ? shadow_visibility_surface_sun_of(l, s) : shadow_visibility_surface_lamp_of(l, s);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < points.length()) {
        point q = points[i];
        results[i] = q.normal == vec3(0.0) ? shadow_visibility(q.light, q.p)
                                           : visibility_of_surface(q.light, shadow_surface(q.p, q.normal, 0.0, 0.0, 0.0));
    }
}
