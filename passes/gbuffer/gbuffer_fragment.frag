// gbuffer_fragment.frag -- the triangle where the ray through the sample meets it.
//
// The rasteriser says which triangle it is; where the ray meets its plane is computed here, so that the
// point does not depend on the precision of interpolation (and is the one that a ray tracer finds).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_bindings.glsl"
#define SURFACE_TEXTURES 5
#define SURFACE_TEXELS 6
#include "surface_texture.glsl"
#include "gbuffer.glsl"

layout(set = 0, binding = 4, scalar) readonly buffer materials_buffer
{
    surface_material materials[];
};
layout(location = 0) flat in uint triangle;
layout(location = 0) out vec4 surface;
layout(location = 1) out vec4 albedo;
layout(location = 2) out vec4 emission;

struct facet_plane { // world
    vec3 corner, e1, e2, normal; // not of unit length
};

// Where a ray through image position `at` (samples) meets the plane: weights of the corners, and distance.
vec4 meet(facet_plane f, vec2 at, out vec3 direction)
{
    camera_ray ray = camera_ray_through(camera, at / float(args.samples));
    direction = turn(surfaces.to_world, ray.direction);
    vec3 from = shift(surfaces.to_world, ray.origin) - f.corner;
    // Cramer's rule: from + distance direction = b e1 + c e2.
    float det = -dot(direction, f.normal);
    vec3 q = cross(from, direction);
    float b = dot(f.e2, q) / det, c = -dot(f.e1, q) / det;
    return vec4(1.0 - b - c, b, c, dot(from, f.normal) / det);
}

void main()
{
    surface_triangle t = triangles[triangle];
    surface_vertex a = vertices[t.v0], b = vertices[t.v1], c = vertices[t.v2];
    facet_plane f = facet_plane(a.position, b.position - a.position, c.position - a.position, vec3(0.0));
    f.normal = cross(f.e1, f.e2);
    vec3 direction, other;
    vec4 w = meet(f, gl_FragCoord.xy, direction);

    surface_material m = materials[t.material];
    gbuffer_point p;
    p.distance = w.w;
    p.albedo = m.albedo;
    if (m.texture != TYN_SURFACE_NO_TEXTURE) {
        // Exact differences: those of neighbouring invocations do not exist where these read no buffers.
        vec2 ua = vec2(a.u, a.v), ub = vec2(b.u, b.v), uc = vec2(c.u, c.v);
        vec3 dx = meet(f, gl_FragCoord.xy + vec2(1.0, 0.0), other).xyz - w.xyz;
        vec3 dy = meet(f, gl_FragCoord.xy + vec2(0.0, 1.0), other).xyz - w.xyz;
        p.albedo *= surface_texture_around(m.texture, w.x * ua + w.y * ub + w.z * uc,
                                           dx.x * ua + dx.y * ub + dx.z * uc,
                                           dy.x * ua + dy.y * ub + dy.z * uc);
    }
    bool front = dot(direction, f.normal) < 0.0;
    p.emission = front || (m.flags & TYN_SURFACE_DOUBLE_SIDED) != 0u ? m.emission : vec3(0.0);
    // Normals of vertices are only as good as their weights: outside of the triangle by a rounding.
    w = clamp(w, vec4(0.0), vec4(1.0));
    vec3 normal = w.x * a.normal + w.y * b.normal + w.z * c.normal;
    float side = front ? 1.0 : -1.0;
    p.facet = side * normalize(turn(surfaces.from_world, f.normal));
    p.normal =
        dot(normal, normal) > 1e-12 ? side * normalize(turn(surfaces.from_world, normal)) : p.facet;
    gbuffer_pack(p, surface, albedo, emission);
}
