// majorant.glsl -- walks a ray through the bricks of the medium frame's box, each with its own bound
// of the extinction, so that tracking takes long steps where the medium is thin.
//
// Bricks tile the box [0, extent]; along a repeated axis the box continues for ever and the walk wraps.
// Positions stay unwrapped (lamps are not repeated); only the brick index and the origin of the period
// the ray is in are wrapped.
#ifndef TYN_MAJORANT_GLSL
#define TYN_MAJORANT_GLSL
#include "shaders/common/camera.glsl"
#include "shaders/common/scene_args.h"

struct brick_walk {
    ivec3 cell;   // brick
    vec3 period;  // origin of the period of the box that the ray is in, m
    vec3 inverse; // 1 / direction
};

// Span of the ray in the box, of unlimited length along repeated axes; empty if x >= y.
vec2 brick_span(const medium_block medium, vec3 origin, vec3 direction)
{
    const float FAR = 1e30;
    vec3 far = vec3(FAR) * vec3(medium.repeat);
    vec2 span = ray_box(origin, ray_inverse(direction), -far, medium.extent + far);
    return vec2(max(span.x, 0.0), span.y);
}

// `position` is in the box, up to rounding.
brick_walk brick_start(const medium_block medium, vec3 position, vec3 direction)
{
    brick_walk walk;
    walk.period = floor(position / medium.extent) * medium.extent * vec3(medium.repeat);
    walk.cell = clamp(ivec3(floor((position - walk.period) / medium.brick_size)), ivec3(0),
                      ivec3(medium.bricks) - 1);
    walk.inverse = ray_inverse(direction);
    return walk;
}

// Distance from `position` to where the ray leaves its brick, and through which axis.
float brick_exit(const medium_block medium, const brick_walk walk, vec3 position, out int axis)
{
    bvec3 up = greaterThan(walk.inverse, vec3(0.0));
    vec3 face = min(vec3(walk.cell + ivec3(up)) * medium.brick_size, medium.extent) + walk.period;
    vec3 t = (face - position) * walk.inverse;
    axis = t.x < t.y ? (t.x < t.z ? 0 : 2) : (t.y < t.z ? 1 : 2);
    return max(min(t.x, min(t.y, t.z)), 0.0);
}

// Goes on to the next brick; false if the ray leaves the box there.
bool brick_step(const medium_block medium, inout brick_walk walk, int axis)
{
    ivec3 along = ivec3(equal(ivec3(0, 1, 2), ivec3(axis)));
    ivec3 way = along * ivec3(sign(walk.inverse));
    walk.cell += way;
    ivec3 last = ivec3(medium.bricks) - 1;
    if (all(greaterThanEqual(walk.cell, ivec3(0))) && all(lessThanEqual(walk.cell, last))) {
        return true;
    }
    ivec3 wraps = along * ivec3(medium.repeat);
    if (wraps == ivec3(0)) {
        return false;
    }
    walk.period += vec3(wraps * way) * medium.extent;
    walk.cell = mix(walk.cell, last - last * max(way, ivec3(0)), notEqual(wraps, ivec3(0)));
    return true;
}

#endif
