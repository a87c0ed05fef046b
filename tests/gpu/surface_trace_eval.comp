// surface_trace_eval.comp -- one ray a thread through triangles: given, or from a point of a triangle.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 64) in;
// 1: from a point of a triangle; and twice the number of triangles, if they are few.
layout(constant_id = 0) const uint SPEC = 0u;
const bool FROM_SURFACE = (SPEC & 1u) != 0u;
const uint FEW = SPEC >> 1u;
#define SURFACE_FEW FEW
#define GEOMETRY_AT 0
#include "shaders/surfaces/surfaces.glsl"

struct ray_in {
    vec3 origin; // M
    uint triangle;
    vec3 direction;
    float side; // of the triangle: 1 = front, -1 = back; the direction is turned to it
    vec2 barycentric;
};
struct ray_out {
    float t; // 3e38: none
    uint triangle;
    uint any; // one of any hits found before twice t, and none before half
    vec3 origin, direction;
};

layout(set = 0, binding = 4, scalar) readonly buffer rays_buffer { ray_in rays[]; };
layout(set = 0, binding = 5, scalar) writeonly buffer results_buffer { ray_out results[]; };

#include "shaders/surfaces/surface_trace.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= rays.length()) {
        return;
    }
    surface_load_few();
    ray_in r = rays[i];
    if (FROM_SURFACE) {
        surface_point p = surface_point_at(r.triangle, r.barycentric);
        vec3 normal = r.side * p.normal;
        r.origin = surface_offset(p, normal);
        float below = min(dot(r.direction, normal), 0.0);
        r.direction = normalize(r.direction - 2.0 * below * normal);
    }
    surface_ray ray = surface_ray_make(surface_transform(surfaces.to_world, r.origin),
                                       surface_turn(surfaces.to_world, r.direction), SURFACE_NONE);
    surface_hit hit = surface_hit(3e38, SURFACE_NONE, vec2(0.0));
    bool found = surface_trace_world(ray, false, hit);
    surface_hit near = surface_hit(0.5 * hit.t, SURFACE_NONE, vec2(0.0)),
                far = surface_hit(2.0 * hit.t + 1e-30, SURFACE_NONE, vec2(0.0));
    bool before = surface_trace_world(ray, true, near);
    bool behind = surface_trace_world(ray, true, far);
    results[i] = ray_out(hit.t, hit.triangle, !before && (behind || !found) ? 1u : 0u, r.origin, r.direction);
}
