// path_distance.comp -- where the ray through the middle of each pixel meets the first surface.
#include "shaders/surfaces/surface_args.h"
#include "shaders/common/camera.glsl"
#include "shaders/surfaces/piece_light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

TYN_UNIFORM(0, camera, camera_block camera);
#define GEOMETRY_AT 1
#include "shaders/surfaces/surfaces.glsl"
layout(set = 0, binding = 5, rgba32ui) uniform writeonly uimage2D radiance_image;
layout(set = 0, binding = 6, r32ui) uniform writeonly uimage2D seen_image;

#include "shaders/surfaces/surface_trace.glsl"

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, camera.size))) {
        return;
    }
    camera_ray from = camera_ray_through(camera, vec2(pixel) + 0.5);
    surface_ray ray = surface_ray_make(surface_transform(surfaces.to_world, from.origin),
                                       surface_turn(surfaces.to_world, from.direction), SURFACE_NONE);
    surface_hit hit = surface_hit(uintBitsToFloat(0x7f800000u), SURFACE_NONE, vec2(0.0)); // infinity: none
    surface_trace_world(ray, false, hit);
    bool none = isinf(hit.t);
    piece_light dark = piece_light(vec3(0.0), none ? 0.0 : hit.t);
    imageStore(radiance_image, ivec2(pixel), piece_light_pack(dark, dark, false));
    imageStore(seen_image, ivec2(pixel), uvec4(none ? 0u : hit.triangle + 1u));
}
