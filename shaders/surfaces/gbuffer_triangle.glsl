// gbuffer_triangle.glsl -- pieces of surface that a pixel shows, from their triangles.
//
// The rasteriser says which triangle it is; where the ray meets its plane is computed here, so that the
// point does not depend on the precision of interpolation (and is the one that a ray tracer finds).
//
// Before including: the block `camera`; GEOMETRY_AT (surfaces.glsl). GBUFFER_AT for pieces, and for their colours MATERIALS_AT
// and GBUFFER_TEXTURED: may materials have textures?
#ifndef TYN_GBUFFER_TRIANGLE_GLSL
#define TYN_GBUFFER_TRIANGLE_GLSL
#include "shaders/common/camera.glsl"
#include "surfaces.glsl"
#include "surface_frame.glsl"
#include "gbuffer.glsl"

struct gbuffer_triangle { // world
    vec3 corner, e1, e2, normal; // not of unit length
    vec3 facet; // M, unit
    vec3 normals[3];
    vec2 uvs[3];
    uint material;
};

struct gbuffer_point {
    float distance; // m along the ray
    vec3 at;        // M
    vec3 normal;    // for shading, M
    vec3 facet;     // of the triangle, M
    bool front;     // that side is seen
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
    f.material = t.w;
    return f;
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

// What the ray sees of the triangle.
gbuffer_point gbuffer_point_of(const gbuffer_triangle f, const camera_ray ray)
{
    vec3 direction;
    vec4 w = gbuffer_meet(f, ray, direction);
    gbuffer_point p;
    p.distance = w.w;
    p.at = ray.origin + p.distance * ray.direction;
    p.front = dot(direction, f.normal) < 0.0;
    // Normals of vertices are only as good as their weights: outside of the triangle by a rounding.
    w = clamp(w, vec4(0.0), vec4(1.0));
    vec3 normal = w.x * f.normals[0] + w.y * f.normals[1] + w.z * f.normals[2];
    float side = p.front ? 1.0 : -1.0;
    p.facet = side * f.facet;
    p.normal =
        dot(normal, normal) > 1e-12 ? side * normalize(surface_turn(surfaces.from_world, normal)) : p.facet;
    return p;
}

// Do a sample that sees `other` and one that sees `first` lie on one piece of surface?
bool gbuffer_same(const gbuffer_point first, const gbuffer_point other)
{
    vec3 d = other.at - first.at;
    return dot(other.facet, first.facet) > 0.9 &&
           abs(dot(d, first.facet)) < 0.3 * length(d) + 1e-5 * other.distance;
}

gbuffer_point gbuffer_sample(const gbuffer_pixel p, int k, uint index)
{
    return gbuffer_point_of(gbuffer_triangle_of(index - 1u), camera_ray_through(camera, gbuffer_place(p, k)));
}

#ifdef GBUFFER_AT
// The piece of surface that the first of the samples `left` of a pixel sees, in the middle of those that see it, `members`.
gbuffer_point gbuffer_piece(const gbuffer_pixel p, uint left, out uint members)
{
    members = gbuffer_all(p);
    if (!gbuffer_is_mixed(p)) {
        return gbuffer_point_of(gbuffer_triangle_of(gbuffer_index(p, 0) - 1u), camera_ray_through(camera, vec2(p.at) + 0.5));
    }
    members = 0u;
    gbuffer_point first;
    vec3 normal = vec3(0.0), off = vec3(0.0);
    float inverses = 0.0;
    for (uint some = left; some != 0u; some &= some - 1u) {
        int k = findLSB(some);
        gbuffer_point s = gbuffer_sample(p, k, gbuffer_index(p, k));
        if (members == 0u) {
            first = s;
        }
        bool same = members == 0u || gbuffer_same(first, s);
        float share = same ? 1.0 : 0.0;
        members |= same ? some & -some : 0u;
        normal += share * s.normal;
        off += share * (s.at - first.at);
        inverses += share / s.distance;
    }
    // In their middle, but on the plane of the one whose facet is to be in a shadow or not. The reciprocal of the distance to a
    // plane is nearly linear over the pixel.
    float count = float(bitCount(members));
    first.at += (off - dot(off, first.facet) * first.facet) / count;
    first.normal = normalize(normal);
    first.distance = count / inverses;
    return first;
}
#endif

#if defined(GBUFFER_AT) && defined(MATERIALS_AT)
#include "reflectance.glsl"
#include "surface_texture.glsl"

struct gbuffer_colours {
    vec3 albedo;
    vec3 emission; // W/(m^2 sr)
};

// Colour of the triangle's texture, the mean over samples of a pixel.
vec3 gbuffer_texture(const gbuffer_triangle f, uint texture, const gbuffer_pixel p, uint members)
{
    vec3 sum = vec3(0.0), other;
    for (uint some = members; some != 0u; some &= some - 1u) {
        vec2 at = gbuffer_place(p, findLSB(some)), step = vec2(1.0 / float(p.side), 0.0);
        vec3 w = gbuffer_meet(f, camera_ray_through(camera, at), other).xyz;
        vec3 dx = gbuffer_meet(f, camera_ray_through(camera, at + step.xy), other).xyz - w;
        vec3 dy = gbuffer_meet(f, camera_ray_through(camera, at + step.yx), other).xyz - w;
        vec2 ua = f.uvs[0], ub = f.uvs[1], uc = f.uvs[2];
        sum += surface_texture_around(texture, w.x * ua + w.y * ub + w.z * uc, dx.x * ua + dx.y * ub + dx.z * uc,
                                      dy.x * ua + dy.y * ub + dy.z * uc);
    }
    return sum / float(bitCount(members));
}

// Mean over the samples `members` of a piece, which gbuffer_piece has found.
gbuffer_colours gbuffer_colours_of(const gbuffer_pixel p, uint members, const gbuffer_point found)
{
    gbuffer_colours sum = gbuffer_colours(vec3(0.0), vec3(0.0));
    uint left = members;
    while (left != 0u) { // a triangle at a time
        uint index = gbuffer_index(p, findLSB(left)), seeing = gbuffer_is_mixed(p) ? 0u : left;
        for (uint some = left; some != 0u && seeing != left; some &= some - 1u) {
            seeing |= gbuffer_index(p, findLSB(some)) == index ? some & -some : 0u;
        }
        surface_material material = surface_material_at(surface_triangle_at(index - 1u).w);
        vec3 colour = vec3(1.0);
        // A CPU device runs what is in here for all pixels: a third of the time where there are no textures.
        if (GBUFFER_TEXTURED && material.texture != TYN_SURFACE_NO_TEXTURE) {
            colour = gbuffer_texture(gbuffer_triangle_of(index - 1u), material.texture, p, seeing);
        }
        float share = float(bitCount(seeing)) / float(bitCount(members));
        sum.albedo += share * surface_reflected(material, colour);
        sum.emission += share * surface_emitted(material, found.front);
        left &= ~seeing;
    }
    return sum;
}
#endif

#endif
