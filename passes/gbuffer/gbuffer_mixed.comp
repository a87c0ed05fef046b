// gbuffer_mixed.comp -- pixels whose samples see several triangles, or one beside nothing. If they make up one piece of
// surface the first sample gets the means; else the pixel is an edge.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_sample.glsl"

layout(local_size_x = GBUFFER_EDGES) in;

layout(set = 0, binding = 13, scalar) buffer edge_count_buffer
{
    gbuffer_edge_count edge_count;
};
layout(set = 0, binding = 14, scalar) writeonly buffer edges_buffer
{
    uint edges[];
};

void main()
{
    uint n = gbuffer_edge();
    if (n == 0u) {
        edge_count.groups.z = 1u;
    }
    if (n >= mixed_count.count) {
        return;
    }
    uint pixel = mixed[n];
    ivec2 corner = samples * ivec2(pixel & 0xffffu, pixel >> 16);
    bool whole = true;
    gbuffer_point first, mean;
    mean.normal = mean.albedo = mean.emission = vec3(0.0);
    vec3 at = vec3(0.0);
    for (int k = 0; k < samples * samples; k++) {
        ivec2 texel = corner + ivec2(k % samples, k / samples);
        uint index = imageLoad(seen, texel).r;
        if (index == 0u) {
            whole = false;
            store_none(texel, 0.0);
            continue;
        }
        vec2 place = vec2(texel) + 0.5;
        camera_ray ray = ray_at(place);
        gbuffer_point p = point_of(triangle_of(index - 1u), place, ray);
        store(texel, p, 0.0);
        vec3 there = ray.origin + p.distance * ray.direction;
        if (k == 0) {
            first = p;
            at = there;
        }
        whole = whole && gbuffer_same(first, at, p.facet, there, p.distance);
        mean.normal += p.normal;
        mean.albedo += p.albedo;
        mean.emission += p.emission;
    }
    if (whole) {
        float share = 1.0 / float(samples * samples);
        mean = gbuffer_point(first.distance, normalize(mean.normal), first.facet, share * mean.albedo,
                             share * mean.emission);
        store(corner, mean, GBUFFER_WHOLE);
    } else {
        uint m = atomicAdd(edge_count.count, 1u);
        edges[m] = pixel;
        uvec2 groups = gbuffer_edge_groups(m, row);
        atomicMax(edge_count.groups.x, groups.x);
        atomicMax(edge_count.groups.y, groups.y);
    }
}
