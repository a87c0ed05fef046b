// gbuffer_sample.glsl -- the triangle where the ray through a sample meets it.
//
// The rasteriser says which triangle it is; where the ray meets its plane is computed here, so that the
// point does not depend on the precision of interpolation (and is the one that a ray tracer finds).
#include "gbuffer_bindings.glsl"
#include "gbuffer_edges.glsl"
#define SURFACE_TEXTURES 5
#define SURFACE_TEXELS 6
#include "surface_texture.glsl"
#include "gbuffer.glsl"

layout(constant_id = 0) const uint textured = 1u;
layout(constant_id = 1) const int samples = 2; // along each side of a pixel
layout(constant_id = 2) const uint row = GBUFFER_ROW;
// The scene's structs as rows of four: a CPU device reads a vector per lane in little more than the time of a number.
layout(set = 0, binding = 2, scalar) readonly buffer triangle_rows_buffer
{
    uvec4 triangle_rows[]; // surface_triangle
};
layout(set = 0, binding = 3, scalar) readonly buffer vertex_rows_buffer
{
    vec4 vertex_rows[]; // surface_vertex: position, u; normal, v
};
layout(set = 0, binding = 4, scalar) readonly buffer material_rows_buffer
{
    uvec4 material_rows[]; // surface_material: albedo, flags; emission, texture
};
layout(set = 0, binding = 7, r32ui) uniform readonly uimage2D seen;
layout(set = 0, binding = 8, rgba32f) uniform writeonly image2D surface_image;
layout(set = 0, binding = 9, rgba32f) uniform writeonly image2D albedo_image;
layout(set = 0, binding = 10, rgba32f) uniform writeonly image2D emission_image;
layout(set = 0, binding = 11, scalar) buffer mixed_count_buffer
{
    gbuffer_edge_count mixed_count;
};
layout(set = 0, binding = 12, scalar) buffer mixed_buffer // as edges, of pixels whose samples see several triangles
{
    uint mixed[];
};

struct gbuffer_triangle { // world
    vec3 corner, e1, e2, normal; // not of unit length
    vec3 facet; // M, unit
    vec3 normals[3];
    vec2 uvs[3];
    surface_material material;
};

gbuffer_triangle triangle_of(uint index)
{
    uvec4 t = triangle_rows[index]; // corners, material
    vec4 a = vertex_rows[2u * t.x], b = vertex_rows[2u * t.y], c = vertex_rows[2u * t.z];
    gbuffer_triangle f;
    f.corner = a.xyz;
    f.e1 = b.xyz - a.xyz;
    f.e2 = c.xyz - a.xyz;
    f.normal = cross(f.e1, f.e2);
    f.facet = normalize(turn(surfaces.from_world, f.normal));
    vec4 na = vertex_rows[2u * t.x + 1u], nb = vertex_rows[2u * t.y + 1u], nc = vertex_rows[2u * t.z + 1u];
    f.normals = vec3[3](na.xyz, nb.xyz, nc.xyz);
    f.uvs = vec2[3](vec2(a.w, na.w), vec2(b.w, nb.w), vec2(c.w, nc.w));
    uvec4 reflected = material_rows[2u * t.w], sent = material_rows[2u * t.w + 1u];
    f.material = surface_material(uintBitsToFloat(reflected.rgb), reflected.a, uintBitsToFloat(sent.rgb), sent.a);
    return f;
}

camera_ray ray_at(vec2 at)
{
    return camera_ray_through(camera, at / float(samples));
}

// Where a ray meets the plane: weights of the corners, and distance.
vec4 meet(gbuffer_triangle f, camera_ray ray, out vec3 direction)
{
    direction = turn(surfaces.to_world, ray.direction);
    vec3 from = shift(surfaces.to_world, ray.origin) - f.corner;
    // Cramer's rule: from + distance direction = b e1 + c e2.
    float det = -dot(direction, f.normal);
    vec3 q = cross(from, direction);
    float b = dot(f.e2, q) / det, c = -dot(f.e1, q) / det;
    return vec4(1.0 - b - c, b, c, dot(from, f.normal) / det);
}

// Albedo at the weights w of a ray through image position `at`.
vec3 albedo_of(gbuffer_triangle f, vec2 at, vec3 w)
{
    vec3 albedo = f.material.albedo, other;
    // A CPU device runs what is in here for all samples: a third of the time where there are no textures.
    if (textured != 0u && f.material.texture != TYN_SURFACE_NO_TEXTURE) {
        vec3 dx = meet(f, ray_at(at + vec2(1.0, 0.0)), other).xyz - w;
        vec3 dy = meet(f, ray_at(at + vec2(0.0, 1.0)), other).xyz - w;
        vec2 ua = f.uvs[0], ub = f.uvs[1], uc = f.uvs[2];
        albedo *= surface_texture_around(f.material.texture, w.x * ua + w.y * ub + w.z * uc,
                                         dx.x * ua + dx.y * ub + dx.z * uc,
                                         dy.x * ua + dy.y * ub + dy.z * uc);
    }
    return albedo;
}

// What the ray through image position `at` (samples) sees of the triangle.
gbuffer_point point_of(gbuffer_triangle f, vec2 at, camera_ray ray)
{
    vec3 direction;
    vec4 w = meet(f, ray, direction);
    gbuffer_point p;
    p.distance = w.w;
    p.albedo = albedo_of(f, at, w.xyz);
    bool front = dot(direction, f.normal) < 0.0;
    p.emission =
        front || (f.material.flags & TYN_SURFACE_DOUBLE_SIDED) != 0u ? f.material.emission : vec3(0.0);
    // Normals of vertices are only as good as their weights: outside of the triangle by a rounding.
    w = clamp(w, vec4(0.0), vec4(1.0));
    vec3 normal = w.x * f.normals[0] + w.y * f.normals[1] + w.z * f.normals[2];
    float side = front ? 1.0 : -1.0;
    p.facet = side * f.facet;
    p.normal =
        dot(normal, normal) > 1e-12 ? side * normalize(turn(surfaces.from_world, normal)) : p.facet;
    return p;
}

void store(ivec2 texel, gbuffer_point p, float flag)
{
    vec4 surface, albedo, emission;
    gbuffer_pack(p, surface, albedo, emission);
    imageStore(surface_image, texel, surface);
    imageStore(albedo_image, texel, albedo);
    imageStore(emission_image, texel, emission + vec4(0.0, 0.0, 0.0, flag));
}

void store_none(ivec2 texel, float flag)
{
    imageStore(surface_image, texel, vec4(0.0));
    imageStore(albedo_image, texel, vec4(0.0));
    imageStore(emission_image, texel, vec4(0.0, 0.0, 0.0, flag));
}
