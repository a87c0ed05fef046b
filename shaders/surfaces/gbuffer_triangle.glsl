// gbuffer_triangle.glsl -- a triangle where the ray through a sample of the picture meets it.
//
// The rasteriser says which triangle it is; where the ray meets its plane is computed here, so that the
// point does not depend on the precision of interpolation (and is the one that a ray tracer finds).
//
// Before including: the block `camera`; GEOMETRY_AT and MATERIALS_AT (surfaces.glsl); GBUFFER_TEXTURED: may materials have
// textures? GBUFFER_SAMPLES: along each side of a pixel.
#ifndef TYN_GBUFFER_TRIANGLE_GLSL
#define TYN_GBUFFER_TRIANGLE_GLSL
#include "shaders/common/camera.glsl"
#include "reflectance.glsl"
#include "surface_frame.glsl"
#include "surface_texture.glsl"
#include "gbuffer.glsl"

struct gbuffer_triangle { // world
    vec3 corner, e1, e2, normal; // not of unit length
    vec3 facet; // M, unit
    vec3 normals[3];
    vec2 uvs[3];
    surface_material material;
};

gbuffer_triangle gbuffer_triangle_of(uint index)
{
    uvec4 t = surface_triangle_at(index);
    vec4 a = surface_vertex_place(t.x), b = surface_vertex_place(t.y), c = surface_vertex_place(t.z);
    gbuffer_triangle f;
    f.corner = a.xyz;
    f.e1 = b.xyz - a.xyz;
    f.e2 = c.xyz - a.xyz;
    f.normal = cross(f.e1, f.e2);
    f.facet = normalize(surface_turn(surfaces.from_world, f.normal));
    vec4 na = surface_vertex_facing(t.x), nb = surface_vertex_facing(t.y), nc = surface_vertex_facing(t.z);
    f.normals = vec3[3](na.xyz, nb.xyz, nc.xyz);
    f.uvs = vec2[3](vec2(a.w, na.w), vec2(b.w, nb.w), vec2(c.w, nc.w));
    f.material = surface_material_at(t.w);
    return f;
}

camera_ray gbuffer_ray(vec2 at)
{
    return camera_ray_through(camera, at / float(GBUFFER_SAMPLES));
}

// Where a ray meets the plane: weights of the corners, and distance.
vec4 gbuffer_meet(const gbuffer_triangle f, const camera_ray ray, out vec3 direction)
{
    direction = surface_turn(surfaces.to_world, ray.direction);
    vec3 from = surface_transform(surfaces.to_world, ray.origin) - f.corner;
    // Cramer's rule: from + distance direction = b e1 + c e2.
    float det = -dot(direction, f.normal);
    vec3 q = cross(from, direction);
    float b = dot(f.e2, q) / det, c = -dot(f.e1, q) / det;
    return vec4(1.0 - b - c, b, c, dot(from, f.normal) / det);
}

// Albedo at the weights w of a ray through image position `at`.
vec3 gbuffer_albedo_at(const gbuffer_triangle f, vec2 at, vec3 w)
{
    vec3 colour = vec3(1.0), other;
    // A CPU device runs what is in here for all samples: a third of the time where there are no textures.
    if (GBUFFER_TEXTURED && f.material.texture != TYN_SURFACE_NO_TEXTURE) {
        vec3 dx = gbuffer_meet(f, gbuffer_ray(at + vec2(1.0, 0.0)), other).xyz - w;
        vec3 dy = gbuffer_meet(f, gbuffer_ray(at + vec2(0.0, 1.0)), other).xyz - w;
        vec2 ua = f.uvs[0], ub = f.uvs[1], uc = f.uvs[2];
        colour = surface_texture_around(f.material.texture, w.x * ua + w.y * ub + w.z * uc,
                                        dx.x * ua + dx.y * ub + dx.z * uc, dy.x * ua + dy.y * ub + dy.z * uc);
    }
    return surface_reflected(f.material, colour);
}

// What the ray through image position `at` (samples) sees of the triangle.
gbuffer_point gbuffer_point_of(const gbuffer_triangle f, vec2 at, const camera_ray ray)
{
    vec3 direction;
    vec4 w = gbuffer_meet(f, ray, direction);
    gbuffer_point p;
    p.distance = w.w;
    bool front = dot(direction, f.normal) < 0.0;
    p.colours = gbuffer_colours(gbuffer_albedo_at(f, at, w.xyz), surface_emitted(f.material, front));
    // Normals of vertices are only as good as their weights: outside of the triangle by a rounding.
    w = clamp(w, vec4(0.0), vec4(1.0));
    vec3 normal = w.x * f.normals[0] + w.y * f.normals[1] + w.z * f.normals[2];
    float side = front ? 1.0 : -1.0;
    p.facet = side * f.facet;
    p.normal =
        dot(normal, normal) > 1e-12 ? side * normalize(surface_turn(surfaces.from_world, normal)) : p.facet;
    return p;
}

#endif
