// gbuffer_mixed.comp -- pixels whose samples see several triangles, or one beside nothing. They may make up one piece
// of surface; else the pixel is an edge.
#include "gbuffer_sample.glsl"

layout(local_size_x = GBUFFER_EDGES) in;

TYN_UPDATE(14, edge_count, gbuffer_edge_count edge_count);
TYN_WRITE(15, edges, uint edges[]);

void main()
{
    uint n = gbuffer_edge();
    if (n == 0u) {
        edge_count.groups.z = 1u;
    }
    if (n >= mixed_count.count) {
        return;
    }
    ivec2 pixel = ivec2(mixed[n] & 0xffffu, mixed[n] >> 16), corner = samples * pixel;
    const int count = samples * samples, middle = (samples / 2) * (samples + 1);
    bool whole = true;
    gbuffer_point first;
    gbuffer_colours colours = GBUFFER_BLACK;
    gbuffer_facing nearest = gbuffer_facing(GBUFFER_SEVERAL, 0, vec3(0.0), vec3(0.0));
    int nearest_rank = count;
    vec3 at = vec3(0.0), normal = vec3(0.0);
    for (int k = 0; k < count; k++) {
        ivec2 texel = texel_of(corner, k);
        uint index = imageLoad(seen, texel).r;
        if (index == 0u) {
            whole = false;
            imageStore(distances_image, texel, vec4(0.0));
            continue;
        }
        vec2 place = vec2(texel) + 0.5;
        camera_ray ray = gbuffer_ray(place);
        gbuffer_point p = gbuffer_point_of(gbuffer_triangle_of(index - 1u), place, ray);
        imageStore(distances_image, texel, vec4(p.distance));
        vec3 there = ray.origin + p.distance * ray.direction;
        if (k == 0) {
            first = p;
            at = there;
        }
        int rank = (k - middle + count) % count; // from the middle on
        if (rank < nearest_rank) {
            nearest_rank = rank;
            nearest = gbuffer_facing(GBUFFER_SEVERAL, k, p.normal, p.facet);
        }
        whole = whole && gbuffer_same(first, at, p.facet, there, p.distance);
        normal += p.normal;
        colours = gbuffer_add(colours, 1.0, p.colours);
    }
    if (whole) {
        first.normal = normalize(normal);
        first.colours = gbuffer_add(GBUFFER_BLACK, 1.0 / float(count), colours);
        store_whole(pixel, first);
    } else {
        imageStore(facing_image, pixel, gbuffer_facing_pack(nearest));
        int texels = gbuffer_texels(samples);
        for (int t = 0; t < texels; t++) {
            uvec4 indices = uvec4(0u);
            for (int k = 0; k < min(4, count - 4 * t); k++) {
                indices[k] = imageLoad(seen, texel_of(corner, 4 * t + k)).r;
            }
            imageStore(colours_image, ivec2(pixel.x * texels + t, pixel.y), indices);
        }
        uint m = atomicAdd(edge_count.count, 1u);
        edges[m] = uint(pixel.y) << 16 | uint(pixel.x);
        uvec2 groups = gbuffer_edge_groups(m, row);
        atomicMax(edge_count.groups.x, groups.x);
        atomicMax(edge_count.groups.y, groups.y);
    }
}
