// guides.comp -- means over each pixel of albedo and normal of the surfaces that its samples see.
#include "shaders/common/scene_args.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint textured = 1u;
TYN_UNIFORM(0, camera, camera_block camera);
#define GEOMETRY_AT 1
#define MATERIALS_AT 5
#define GBUFFER_TEXTURED (textured != 0u)
#define GBUFFER_AT 8
#include "shaders/surfaces/gbuffer_triangle.glsl"
layout(set = 0, binding = GBUFFER_END, rgba32f) uniform writeonly image2D albedo_image;
layout(set = 0, binding = GBUFFER_END + 1, rgba32f) uniform writeonly image2D normal_image;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) {
        return;
    }
    gbuffer_pixel seen = gbuffer_pixel_at(pixel, camera.size.x);
    vec4 albedo = vec4(0.0);
    vec3 normal = vec3(0.0);
    for (uint left = gbuffer_shown(seen), members; left != 0u; left &= ~members) {
        gbuffer_point p = gbuffer_piece(seen, left, members);
        float share = float(bitCount(members)) / float(bitCount(gbuffer_all(seen)));
        albedo += share * vec4(gbuffer_colours_of(seen, members, p).albedo, 1.0);
        normal += share * p.normal;
    }
    imageStore(albedo_image, pixel, albedo);
    imageStore(normal_image, pixel, vec4(surface_turn(surfaces.to_world, normal), 0.0));
}
