// gbuffer_mixed.comp -- pixels whose samples see several triangles, or one beside nothing. They may make up one piece
// of surface; else the pixel shows several.
#include "shaders/common/scene_args.h"
#include "shaders/surfaces/gbuffer_edges.glsl"

layout(local_size_x = GBUFFER_EDGES) in;

layout(constant_id = 0) const int samples = 2; // along each side of a pixel
TYN_UNIFORM(0, camera, camera_block camera);
#define GEOMETRY_AT 1
#include "shaders/surfaces/gbuffer_triangle.glsl"
layout(binding = 5, r32ui) uniform uimage2D seen;
TYN_READ(6, mixed_count, gbuffer_edge_count mixed_count);
TYN_READ(7, mixed, uint mixed[]);

uint seen_by(const gbuffer_pixel p, int k)
{
    return imageLoad(seen, gbuffer_texel(p, k)).r;
}

void main()
{
    uint n = gbuffer_edge();
    if (n >= mixed_count.count) {
        return;
    }
    gbuffer_pixel p = gbuffer_pixel(ivec2(mixed[n] & 0xffffu, mixed[n] >> 16), samples, 0u);
    const int count = samples * samples;
    uint shown = 0u; // samples: bits
    for (int k = 0; k < count; k++) {
        shown |= seen_by(p, k) != 0u ? 1u << k : 0u;
    }
    uint second = 0u;
    int pieces = 0;
    bool apart = false; // samples of one piece are at several distances, as those of one step and the next, seen edge-on
    float nearest = 1e38, farthest = 0.0;
    for (uint left = shown; left != 0u; pieces++) {
        gbuffer_point first;
        uint members = 0u;
        for (uint some = left; some != 0u; some &= some - 1u) {
            int k = findLSB(some);
            gbuffer_point s = gbuffer_sample(p, k, seen_by(p, k));
            if (members == 0u) {
                first = s;
            }
            if (members == 0u || gbuffer_same(first, s)) {
                members |= some & -some;
                apart = apart || max(first.distance, s.distance) > 1.05 * min(first.distance, s.distance);
            }
            nearest = min(nearest, s.distance);
            farthest = max(farthest, s.distance);
        }
        left &= ~members;
        second = pieces == 1 ? members : second;
    }
    for (int k = 0; k < count; k++) {
        if ((pieces > 2 || apart) && (shown >> k & 1u) != 0u) { // what is near, and what is far
            bool far = gbuffer_sample(p, k, seen_by(p, k)).distance > sqrt(nearest) * sqrt(farthest);
            second = second & ~(1u << k) | (far ? 1u << k : 0u);
        }
    }
    bool several = pieces > 1 || shown != gbuffer_all(p);
    for (int k = 0; k < count; k++) {
        uint bits = k > 0 ? 0u : GBUFFER_MIXED | (several ? GBUFFER_SEVERAL : 0u);
        bits |= (second >> k & 1u) != 0u ? GBUFFER_SECOND : 0u;
        if (bits != 0u) {
            imageStore(seen, gbuffer_texel(p, k), uvec4(seen_by(p, k) | bits));
        }
    }
}
