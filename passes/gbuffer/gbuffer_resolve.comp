// gbuffer_resolve.comp -- the triangle where the ray through the sample meets it.
//
// The rasteriser says which triangle it is; where the ray meets its plane is computed here, so that the
// point does not depend on the precision of interpolation (and is the one that a ray tracer finds).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_bindings.glsl"
#include "gbuffer_args.h"
#define SURFACE_TEXTURES 5
#define SURFACE_TEXELS 6
#include "surface_texture.glsl"
#include "gbuffer.glsl"

layout(constant_id = 0) const uint textured = 1u;
layout(push_constant, scalar) uniform args_block
{
    gbuffer_args args;
};
layout(set = 0, binding = 4, scalar) readonly buffer materials_buffer
{
    surface_material materials[];
};
layout(set = 0, binding = 7, r32ui) uniform readonly uimage2D seen;
layout(set = 0, binding = 8, rgba32f) uniform writeonly image2D surface_image;
layout(set = 0, binding = 9, rgba32f) uniform writeonly image2D albedo_image;
layout(set = 0, binding = 10, rgba32f) uniform writeonly image2D emission_image;
layout(local_size_x = 8, local_size_y = 8) in;

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
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(surface_image)))) {
        return;
    }
    uint triangle = imageLoad(seen, texel).r;
    if (triangle == 0u) {
        imageStore(surface_image, texel, vec4(0.0));
        imageStore(albedo_image, texel, vec4(0.0));
        imageStore(emission_image, texel, vec4(0.0));
        return;
    }
    vec2 at = vec2(texel) + 0.5;
    surface_triangle t = triangles[triangle - 1u];
    surface_vertex a = vertices[t.v0], b = vertices[t.v1], c = vertices[t.v2];
    facet_plane f = facet_plane(a.position, b.position - a.position, c.position - a.position, vec3(0.0));
    f.normal = cross(f.e1, f.e2);
    vec3 direction, other;
    vec4 w = meet(f, at, direction);

    surface_material m = materials[t.material];
    gbuffer_point p;
    p.distance = w.w;
    p.albedo = m.albedo;
    // A CPU device runs what is in here for all samples: a third of the time where there are no textures.
    if (textured != 0u && m.texture != TYN_SURFACE_NO_TEXTURE) {
        vec2 ua = vec2(a.u, a.v), ub = vec2(b.u, b.v), uc = vec2(c.u, c.v);
        vec3 dx = meet(f, at + vec2(1.0, 0.0), other).xyz - w.xyz;
        vec3 dy = meet(f, at + vec2(0.0, 1.0), other).xyz - w.xyz;
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
    vec4 surface, albedo, emission;
    gbuffer_pack(p, surface, albedo, emission);
    imageStore(surface_image, texel, surface);
    imageStore(albedo_image, texel, albedo);
    imageStore(emission_image, texel, emission);
}
