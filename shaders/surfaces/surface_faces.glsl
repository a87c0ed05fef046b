// surface_faces.glsl -- does a surface face anything?
//
// Include after the declarations that surface_trace.glsl asks for.
#ifndef TYN_SURFACE_FACES_GLSL
#define TYN_SURFACE_FACES_GLSL
#include "shaders/common/camera.glsl"
#include "shaders/random/rng.glsl"
#include "surface_trace.glsl"

const uint SURFACE_FACES_RAYS = 16u;

// Is there anything in front of a surface at p (M; `world`: the same place), of the media's box or of other surfaces?
// Light reflected by the outer walls of a house is not seen by what is inside. What reaches beyond the surface's plane
// by less than a hundredth of the scene may be eaves, or a panel right above a floor of a kilometre: rays tell.
bool surface_faces_something(uint triangle, vec3 p, vec3 world, vec3 n, vec3 extent, inout rng_state rng)
{
    vec3 size = surfaces.hi - surfaces.lo;
    vec3 m = surface_turn(surfaces.to_world, n);
    // How far the boxes reach beyond the plane of the surface.
    float media = extent.x > 0.0 ? dot(max(n, vec3(0.0)), extent) - dot(n, p) : 0.0;
    float others = dot(m, 0.5 * (surfaces.lo + surfaces.hi) - world) + 0.5 * dot(abs(m), size);
    float reach = max(length(size), length(extent)), rounding = 1e-5 * reach;
    bool found = max(media, others) > 0.01 * reach, doubtful = !found && max(media, others) > rounding;

    vec3 side = normalize(abs(n.x) < 0.7 ? cross(n, vec3(1.0, 0.0, 0.0)) : cross(n, vec3(0.0, 1.0, 0.0)));
    vec3 across = cross(n, side), origin = world + rounding * m;
    for (uint i = 0u; i < SURFACE_FACES_RAYS && doubtful && !found; i++) {
        vec2 u = rng_vec2(rng_next(rng).xy);
        u.x = (float(i) + u.x) / float(SURFACE_FACES_RAYS); // cosine-weighted
        float r = sqrt(u.x), azimuth = 2.0 * 3.14159265 * u.y;
        vec3 d = sqrt(1.0 - u.x) * n + r * (cos(azimuth) * side + sin(azimuth) * across);
        surface_hit hit = surface_hit(3e38, SURFACE_NONE, vec2(0.0));
        found = surface_trace_world(surface_ray_make(origin, surface_turn(surfaces.to_world, d), triangle), true, hit);
        vec2 span = ray_box(p + rounding * n, ray_inverse(d), vec3(0.0), extent);
        found = found || (media > rounding && span.y > max(span.x, 0.0));
    }
    return found;
}

#endif
