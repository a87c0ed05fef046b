// shade_edges.comp -- pixels that show several pieces of surface, or one beside nothing: one after another.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_edges.glsl"
#include "shade_piece.glsl"
#define GBUFFER_SURFACES 31
#define GBUFFER_TRIANGLES 32
#define GBUFFER_VERTICES 33
#define GBUFFER_MATERIALS 34
#define SURFACE_TEXTURES 35
#define SURFACE_TEXELS 36
#define GBUFFER_TEXTURED shade_has(SHADE_TEXTURED)
#define GBUFFER_SAMPLES shade_samples
#include "gbuffer_triangle.glsl"

layout(local_size_x = GBUFFER_EDGES) in;

layout(binding = 28, rg32ui) uniform writeonly uimage2D radiance_image; // packed_colour.glsl, and the piece's number
layout(binding = 29, scalar) readonly buffer edge_count_buffer
{
    gbuffer_edge_count edge_count;
};
layout(binding = 30, scalar) readonly buffer edges_buffer
{
    uint edges[];
};

// What sample k of a pixel shows, a surface, and where (M).
gbuffer_point sample_of(ivec2 pixel, int k, out vec3 at)
{
    vec2 place = vec2(shade_texel(pixel * shade_samples, k)) + 0.5;
    camera_ray ray = gbuffer_ray(place);
    gbuffer_point s = gbuffer_point_of(gbuffer_triangle_of(shade_colours(pixel, k / 4)[k % 4] - 1u), place, ray);
    at = ray.origin + s.distance * ray.direction;
    return s;
}

// The piece of surface that the first of the samples `left` of a pixel shows, and those that show it: bits.
shade_point piece_of(ivec2 pixel, uint left, out vec3 albedo, out vec3 emission, out uint members)
{
    gbuffer_point first;
    vec3 at0 = vec3(0.0), normal = vec3(0.0), off = vec3(0.0);
    albedo = emission = vec3(0.0);
    members = 0u;
    for (uint some = left; some != 0u; some &= some - 1u) {
        vec3 at;
        gbuffer_point s = sample_of(pixel, findLSB(some), at);
        if (members == 0u) {
            first = s;
            at0 = at;
        }
        bool same = members == 0u || gbuffer_same(first, at0, s.facet, at, s.distance);
        float share = same ? 1.0 : 0.0;
        members |= same ? some & -some : 0u;
        albedo += share * s.albedo;
        emission += share * s.emission;
        normal += share * s.normal;
        off += share * (at - at0);
    }
    // In their middle, but on the plane of the one whose facet is to be in a shadow or not.
    float share = 1.0 / float(bitCount(members));
    albedo *= share;
    emission *= share;
    off = (off - dot(off, first.facet) * first.facet) * share;
    return shade_point(at0 + off, normalize(normal), first.facet);
}

// The part of the picture that the samples `members` of a pixel fill, or the rectangle around them.
vec4 part_of(ivec2 corner, uint members)
{
    vec4 part = vec4(1e9, 1e9, -1e9, -1e9);
    for (uint some = members; some != 0u; some &= some - 1u) {
        vec2 texel = vec2(shade_texel(corner, findLSB(some)));
        part = vec4(min(part.xy, texel), max(part.zw, texel + 1.0));
    }
    return part / float(shade_samples);
}

void main()
{
    uint n = gbuffer_edge();
    if (n >= edge_count.count) {
        return;
    }
    int count = shade_samples * shade_samples;
    ivec2 pixel = ivec2(edges[n] & 0xffffu, edges[n] >> 16), corner = pixel * shade_samples;
    uint left = 0u; // bit k: sample k shows a surface and is not shaded yet
    for (int k = 0; k < count; k++) {
        ivec2 texel = shade_texel(corner, k);
        bool shown = shade_distance(texel) > 0.0;
        left |= shown ? 1u << k : 0u;
        if (!shown) {
            imageStore(radiance_image, texel, uvec4(0u));
        }
    }
    for (uint piece = 0u; left != 0u; piece++) {
        vec3 albedo, emission;
        uint members;
        shade_point p = piece_of(pixel, left, albedo, emission, members);
        vec4 part = part_of(corner, members);
        vec3 irradiance;
        if (shade_step == 1) {
            irradiance = irradiance_at(p, part);
            irradiance += shade_has(SHADE_VPLS) ? smooth_light_beside(p, 0.5 * (part.xy + part.zw)) : vec3(0.0);
        } else {
            irradiance = smooth_light_around(p, 0.5 * (part.xy + part.zw)) + sharp_light_at(p, part);
        }
        uvec2 radiance = colour_pack(emission + albedo * irradiance / PI) | uvec2(0u, min(piece, 3u) << 30);
        for (uint some = members; some != 0u; some &= some - 1u) {
            imageStore(radiance_image, shade_texel(corner, findLSB(some)), uvec4(radiance, 0u, 0u));
        }
        left &= ~members;
    }
}
