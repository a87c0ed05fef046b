// surface_samples.glsl -- the samples of the scene's surfaces in a pixel: radiance, and distance or infinity.
#ifndef TYN_SURFACE_SAMPLES_GLSL
#define TYN_SURFACE_SAMPLES_GLSL
#include "host_depth.glsl"

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
    float end;   // all are nearer than this
    vec2 where;  // their middle in the pixel
};

// Of those not nearer than `from`, the nearest and what is up to 1.05 times as far.
surface_group surface_group_from(sampler2D surfaces, camera_block camera, ivec2 pixel, float from)
{
    int side = textureSize(surfaces, 0).x / int(camera.size.x);
    float nearest = TYN_INFINITY, count = 0.0;
    for (int i = 0; i < side * side; i++) {
        float away = texelFetch(surfaces, pixel * side + ivec2(i % side, i / side), 0).a;
        nearest = away >= from ? min(nearest, away) : nearest;
    }
    vec4 sum = vec4(0.0);
    vec2 where = vec2(0.0);
    float end = 1.05 * nearest, inverses = 0.0;
    for (int i = 0; i < side * side; i++) {
        vec4 found = texelFetch(surfaces, pixel * side + ivec2(i % side, i / side), 0);
        bool here = found.a >= nearest && (found.a < end || nearest == TYN_INFINITY);
        sum += here && nearest < TYN_INFINITY ? found : vec4(0.0);
        count += here ? 1.0 : 0.0;
        inverses += here ? 1.0 / max(found.a, 1e-30) : 0.0;
        where += here ? (vec2(i % side, i / side) + 0.5) / float(side) : vec2(0.0);
    }
    surface_group group;
    group.mean = sum / max(count, 1.0);
    // The reciprocal of the distance to a plane is nearly linear over the pixel.
    group.mean.a = nearest < TYN_INFINITY ? count / inverses : TYN_INFINITY;
    group.share = count / float(side * side);
    group.end = end;
    group.where = where / max(count, 1.0);
    return group;
}

surface_samples surface_samples_of(sampler2D surfaces, camera_block camera, ivec2 pixel)
{
    surface_samples s;
    s.side = textureSize(surfaces, 0).x / int(camera.size.x);
    float nearest = TYN_INFINITY, farthest = 0.0, inverses = 0.0, count = float(s.side * s.side);
    vec4 sum = vec4(0.0);
    s.covered = 0.0;
    for (int i = 0; i < s.side * s.side; i++) {
        vec4 found = texelFetch(surfaces, pixel * s.side + ivec2(i % s.side, i / s.side), 0);
        sum += found.a < TYN_INFINITY ? found : vec4(0.0);
        s.covered += found.a < TYN_INFINITY ? 1.0 / count : 0.0;
        nearest = min(nearest, found.a);
        farthest = max(farthest, found.a);
        inverses += 1.0 / max(found.a, 1e-30);
    }
    // The reciprocal of the distance to a plane is nearly linear over the pixel.
    s.even = nearest == TYN_INFINITY || farthest < 1.05 * nearest;
    s.mean = vec4(sum.rgb / count, s.even && nearest < TYN_INFINITY ? count / inverses : nearest);
    return s;
}

#endif
