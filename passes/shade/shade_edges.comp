// shade_edges.comp -- pixels that show several pieces of surface, or one beside nothing: one after another.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_edges.glsl"
#include "shade_piece.glsl"

layout(local_size_x = GBUFFER_EDGES) in;

layout(binding = 29, scalar) readonly buffer edge_count_buffer
{
    gbuffer_edge_count edge_count;
};
layout(binding = 30, scalar) readonly buffer edges_buffer
{
    uint edges[];
};

// The VPLs' light at a sample of a pixel whose samples lie on several surfaces: of the pixels around the one
// that is most like it.
vec3 light_of_vpls(ivec2 pixel, shade_point p)
{
    float best = -1e30;
    vec3 light = vec3(0.0);
    for (int i = 0; i < 9; i++) {
        ivec2 at = clamp(pixel + ivec2(i % 3, i / 3) - 1, ivec2(0), ivec2(camera.size) - 1);
        shade_part found = shade_unpack(imageLoad(indirect_image, at));
        vec3 d = shade_part_position(at, found.along) - p.position;
        float like = dot(found.facet, p.facet) - abs(dot(d, p.facet)) * inversesqrt(dot(d, d) + 1e-36);
        if (found.along > 0.0 && like > best) {
            best = like;
            light = found.irradiance;
        }
    }
    return light;
}

// The piece of surface that the first of the samples `left` of a pixel shows, and those that show it: bits.
shade_point piece_of(ivec2 corner, uint left, out vec3 albedo, out vec3 emission, out uint members)
{
    int count = shade_samples * shade_samples, k0 = findLSB(left);
    ivec2 texel0 = shade_texel(corner, k0);
    gbuffer_point first = shade_sample(texel0);
    vec3 at0 = shade_position(texel0, first.distance), normal = vec3(0.0), off = vec3(0.0);
    albedo = emission = vec3(0.0);
    members = 0u;
    for (int k = k0; k < count; k++) {
        ivec2 texel = shade_texel(corner, k);
        gbuffer_point s = shade_sample(texel);
        vec3 at = shade_position(texel, s.distance);
        bool same = (left >> k & 1u) != 0u && gbuffer_same(first, at0, s.facet, at, s.distance);
        float share = same || k == k0 ? 1.0 : 0.0;
        members |= share > 0.0 ? 1u << k : 0u;
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
        bool shown = texelFetch(surface_tex, texel, 0).w > 0.0;
        left |= shown ? 1u << k : 0u;
        if (!shown) {
            imageStore(radiance_image, texel, vec4(vec3(0.0), NOWHERE));
        }
    }
    while (left != 0u) {
        vec3 albedo, emission;
        uint members;
        shade_point p = piece_of(corner, left, albedo, emission, members);
        vec3 irradiance = irradiance_at(p, part_of(corner, members));
        if (shade_has(SHADE_VPLS)) {
            irradiance += light_of_vpls(pixel, p);
        }
        vec3 radiance = emission + albedo * irradiance / PI;
        for (uint some = members; some != 0u; some &= some - 1u) {
            ivec2 texel = shade_texel(corner, findLSB(some));
            imageStore(radiance_image, texel, vec4(radiance, texelFetch(surface_tex, texel, 0).w));
        }
        left &= ~members;
    }
}
