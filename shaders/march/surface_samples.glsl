// surface_samples.glsl -- the surfaces that a pixel shows, in two groups: radiance, and distance or infinity.
//
// Before including: SURFACE_RADIANCE and GBUFFER_AT as bindings of what passes shade and gbuffer made; the block `camera`.
#ifndef TYN_SURFACE_SAMPLES_GLSL
#define TYN_SURFACE_SAMPLES_GLSL
#include "host_depth.glsl"
#include "shaders/surfaces/gbuffer.glsl"
#include "shaders/surfaces/piece_light.glsl"

layout(binding = SURFACE_RADIANCE, rgba32ui) uniform readonly uimage2D surface_image;

struct surface_samples {
    vec4 mean;     // radiance; distance, the shortest where they are not about equal
    float covered; // share that shows a surface
};

// One of the pixel's groups of samples, both if they are about equally far away, or samples that see nothing.
struct surface_group {
    vec4 mean;   // radiance and distance; with distance infinity: no surface
    float share; // of the pixel
    uint left;   // bits: the groups that are not among them, nor were before
    vec2 where;  // their middle in the pixel
};

// Of the groups `left` (bits), the nearest, and the other if it is up to 1.05 times as far; not with `one_piece`: the mean
// distance of both sides of an edge is behind the edge.
surface_group surface_group_from(ivec2 pixel, uint left, bool one_piece)
{
    gbuffer_pixel seen = gbuffer_pixel_at(pixel, camera.size.x);
    gbuffer_groups groups = gbuffer_groups_of(seen);
    uvec4 texel = imageLoad(surface_image, pixel);
    bool two = groups.second != 0u;
    piece_light first = piece_light_unpack(texel, two, 0), second = piece_light_unpack(texel, two, 1);
    vec2 away = vec2((left & 1u) != 0u && groups.first != 0u ? first.distance : TYN_INFINITY,
                     (left & 2u) != 0u && two ? second.distance : TYN_INFINITY);
    float nearest = min(away.x, away.y);
    bool none = nearest == TYN_INFINITY, both = !one_piece && !none && max(away.x, away.y) < 1.05 * nearest;
    uint among = none ? 4u : both ? 3u : away.x <= away.y ? 1u : 2u; // bits of groups, 4: nothing
    uint x = (among & 1u) != 0u ? groups.first : 0u, y = (among & 2u) != 0u ? groups.second : 0u;
    uint members = none ? gbuffer_all(seen) & ~(groups.first | groups.second) : x | y;
    piece_light sum = piece_light(vec3(0.0), 0.0);
    sum = piece_light_add(sum, bitCount(x), first.radiance, first.distance);
    sum = piece_light_add(sum, bitCount(y), second.radiance, second.distance);
    piece_light mean = piece_light_mean(sum, bitCount(members));
    surface_group group;
    group.mean = vec4(none ? vec3(0.0) : mean.radiance, none ? TYN_INFINITY : both ? mean.distance : nearest);
    group.share = float(bitCount(members)) / float(bitCount(gbuffer_all(seen)));
    group.left = left & ~among;
    group.where = gbuffer_middle(seen, members);
    return group;
}

surface_samples surface_samples_of(ivec2 pixel)
{
    surface_group near = surface_group_from(pixel, ~0u, false);
    surface_samples s = surface_samples(near.mean, near.mean.a < TYN_INFINITY ? near.share : 0.0);
    s.mean.rgb *= s.covered;
    if (s.covered > 0.0 && s.covered < 1.0) {
        surface_group far = surface_group_from(pixel, near.left, false);
        if (far.mean.a < TYN_INFINITY) {
            s.mean.rgb += far.share * far.mean.rgb;
            s.covered += far.share;
        }
    }
    return s;
}

#endif
