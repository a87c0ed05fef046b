// camera.glsl -- rays of image positions, and where a ray is inside a box.
#ifndef TYN_CAMERA_GLSL
#define TYN_CAMERA_GLSL
#include "scene_args.h"

struct camera_ray {
    vec3 origin;    // M, m
    vec3 direction; // unit, away from the camera
};

// What is of parallel rays, or of rays that meet in the eye: both are computed, and one is taken. A branch on nothing
// but values of a uniform buffer makes lavapipe compile the kernel anew when these change: whenever the camera moves.
float camera_select(const camera_block camera, float parallel, float perspective)
{
    return mix(perspective, parallel, camera.orthographic != 0u);
}

vec3 camera_select(const camera_block camera, vec3 parallel, vec3 perspective)
{
    return mix(perspective, parallel, bvec3(camera.orthographic != 0u));
}

// Pixels of the picture, or of that of which it is a part.
vec2 camera_whole(const camera_block camera)
{
    return vec2(camera.size + camera.beyond);
}

// Width and height of a pixel, at 1 m (perspective) or in m.
vec2 camera_pixel(const camera_block camera)
{
    return 2.0 * vec2(camera.half_width, camera.half_height) / camera_whole(camera);
}

// How far image position `pixel` (column + u, row + v), row 0 on top, (u, v) in [0, 1)^2, is beside the axis: at 1 m
// (perspective) or in m.
vec3 camera_across(const camera_block camera, vec2 pixel)
{
    vec2 s = 2.0 * (pixel + vec2(camera.corner)) / camera_whole(camera) - 1.0;
    return (s.x + camera.shift.x) * camera.half_width * camera.right + (camera.shift.y - s.y) * camera.half_height * camera.up;
}

// Ray through an image position.
camera_ray camera_ray_through(const camera_block camera, vec2 pixel)
{
    vec3 across = camera_across(camera, pixel);
    return camera_ray(camera_select(camera, camera.origin + across, camera.origin),
                      camera_select(camera, camera.forward, normalize(camera.forward + across)));
}

// 1 / direction with components that are never infinite, so that a ray within a face of a box gives
// no 0 * inf.
vec3 ray_inverse(vec3 direction)
{
    vec3 sign_of = mix(vec3(-1.0), vec3(1.0), greaterThanEqual(direction, vec3(0.0)));
    return sign_of / max(abs(direction), vec3(1e-18));
}

// Distances at which the ray enters and leaves the box [lo, hi]; empty if x >= y.
vec2 ray_box(vec3 origin, vec3 inverse_direction, vec3 lo, vec3 hi)
{
    vec3 a = (lo - origin) * inverse_direction;
    vec3 b = (hi - origin) * inverse_direction;
    vec3 enter = min(a, b), leave = max(a, b);
    return vec2(max(max(enter.x, enter.y), enter.z), min(min(leave.x, leave.y), leave.z));
}

// The same for the sphere of radius r about 0; `direction` need not be unit.
vec2 ray_sphere(vec3 origin, vec3 direction, float r)
{
    // Distance of the line to the centre first: stable for origins far away.
    float dd = dot(direction, direction);
    float closest = -dot(origin, direction) / dd;
    vec3 nearest = origin + closest * direction;
    float h2 = r * r - dot(nearest, nearest);
    if (h2 <= 0.0) {
        return vec2(1.0, 0.0);
    }
    float half_chord = sqrt(h2 / dd);
    return vec2(closest - half_chord, closest + half_chord);
}

// M -> local unit box of a shape.
vec3 shape_vector(const shape_block shape, vec3 v)
{
    return vec3(dot(shape.rows[0].xyz, v), dot(shape.rows[1].xyz, v), dot(shape.rows[2].xyz, v));
}

vec3 shape_point(const shape_block shape, vec3 p)
{
    return shape_vector(shape, p) + vec3(shape.rows[0].w, shape.rows[1].w, shape.rows[2].w);
}

// Span of a ray in local coordinates.
vec2 ray_unit_shape(uint kind, vec3 origin, vec3 direction)
{
    if (kind == TYN_SHAPE_KIND_SPHERE) {
        return ray_sphere(origin, direction, 0.5);
    }
    return ray_box(origin, ray_inverse(direction), vec3(-0.5), vec3(0.5));
}

#endif
