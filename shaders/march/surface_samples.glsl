// surface_samples.glsl -- the samples of the scene's surfaces in a pixel: radiance, and distance or infinity.
//
// Before including: SURFACE_RADIANCE and SURFACE_DISTANCES as bindings of what passes shade and gbuffer made.
#ifndef TYN_SURFACE_SAMPLES_GLSL
#define TYN_SURFACE_SAMPLES_GLSL
#include "host_depth.glsl"
#include "shaders/colour/packed_colour.glsl"

layout(binding = SURFACE_RADIANCE, rg32ui) uniform readonly uimage2D surface_image;
layout(binding = SURFACE_DISTANCES) uniform sampler2D distances_tex;

// Samples along each side of a pixel.
int surface_side(const camera_block camera)
{
    return textureSize(distances_tex, 0).x / int(camera.size.x);
}

// Of sample i: radiance, and distance or infinity.
float surface_distance(ivec2 pixel, int side, int i)
{
    float away = texelFetch(distances_tex, pixel * side + ivec2(i % side, i / side), 0).r;
    return away > 0.0 ? away : TYN_INFINITY;
}

vec3 surface_radiance(ivec2 pixel, int side, int i)
{
    return colour_unpack(imageLoad(surface_image, pixel * side + ivec2(i % side, i / side)).xy);
}

// The piece of surface that it shows, of those in the pixel; all from the fourth on have one number.
uint surface_piece(ivec2 pixel, int side, int i)
{
    return imageLoad(surface_image, pixel * side + ivec2(i % side, i / side)).y >> 30;
}

struct surface_samples {
    int side;     // samples along each side of the pixel
    vec4 mean;    // radiance and distance, if they are even; else the distance is the shortest
    bool even;    // about equally far away, or no surface at all
    float covered; // share that shows a surface
};

// Samples that are about equally far away.
struct surface_group {
    vec4 mean;   // radiance and distance; with distance infinity: no surface
    float share; // of the pixel's samples
    uint left;   // bits: the samples that are not among them, nor were before
    vec2 where;  // their middle in the pixel
};

// Of the samples `left` (bits), the nearest and those up to 1.05 times as far. `one_piece`: only on the same piece of
// surface: their mean distance is on it, where that of both sides of an edge is behind the edge.
surface_group surface_group_from(const camera_block camera, ivec2 pixel, uint left, bool one_piece)
{
    int side = surface_side(camera);
    float nearest = TYN_INFINITY, count = 0.0;
    int first = 0;
    for (int i = 0; i < side * side; i++) {
        float away = (left >> i & 1u) != 0u ? surface_distance(pixel, side, i) : TYN_INFINITY;
        first = away < nearest ? i : first;
        nearest = min(nearest, away);
    }
    uint piece = surface_piece(pixel, side, first);
    vec3 sum = vec3(0.0);
    vec2 where = vec2(0.0);
    float inverses = 0.0;
    for (int i = 0; i < side * side; i++) {
        float away = surface_distance(pixel, side, i);
        bool here = (left >> i & 1u) != 0u && (away < 1.05 * nearest || nearest == TYN_INFINITY);
        here = here && (!one_piece || nearest == TYN_INFINITY || surface_piece(pixel, side, i) == piece);
        sum += here && nearest < TYN_INFINITY ? surface_radiance(pixel, side, i) : vec3(0.0);
        count += here ? 1.0 : 0.0;
        inverses += here ? 1.0 / max(away, 1e-30) : 0.0;
        where += here ? (vec2(i % side, i / side) + 0.5) / float(side) : vec2(0.0);
        left &= here ? ~(1u << i) : ~0u;
    }
    surface_group group;
    // The reciprocal of the distance to a plane is nearly linear over the pixel.
    group.mean = vec4(sum / max(count, 1.0), nearest < TYN_INFINITY ? count / inverses : TYN_INFINITY);
    group.share = count / float(side * side);
    group.left = left;
    group.where = where / max(count, 1.0);
    return group;
}

surface_samples surface_samples_of(const camera_block camera, ivec2 pixel)
{
    surface_samples s;
    s.side = surface_side(camera);
    float nearest = TYN_INFINITY, farthest = 0.0, inverses = 0.0, count = float(s.side * s.side);
    vec3 sum = vec3(0.0);
    s.covered = 0.0;
    for (int i = 0; i < s.side * s.side; i++) {
        float away = surface_distance(pixel, s.side, i);
        bool found = away < TYN_INFINITY;
        sum += found ? surface_radiance(pixel, s.side, i) : vec3(0.0);
        s.covered += found ? 1.0 / count : 0.0;
        nearest = min(nearest, away);
        farthest = max(farthest, away);
        inverses += 1.0 / max(away, 1e-30);
    }
    // The reciprocal of the distance to a plane is nearly linear over the pixel.
    s.even = nearest == TYN_INFINITY || farthest < 1.05 * nearest;
    s.mean = vec4(sum / count, s.even && nearest < TYN_INFINITY ? count / inverses : nearest);
    return s;
}

#endif
