// guides.comp -- means over each pixel of albedo and normal of the surfaces that its samples see.
#include "shaders/common/scene_args.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint textured = 1u;
layout(constant_id = 1) const int samples = 2; // along each side of a pixel
TYN_UNIFORM(0, camera, camera_block camera);
#define GEOMETRY_AT 1
#define MATERIALS_AT 5
#define GBUFFER_TEXTURED (textured != 0u)
#define GBUFFER_SAMPLES samples
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
    gbuffer_facing facing = gbuffer_facing_unpack(imageLoad(facing_image, pixel));
    const int texels = gbuffer_texels(samples), count = samples * samples;
    vec4 albedo = vec4(0.0);
    vec3 normal = vec3(0.0);
    if (facing.shown == GBUFFER_WHOLE) {
        albedo = vec4(gbuffer_unpack(imageLoad(colours_image, ivec2(pixel.x * texels, pixel.y))).albedo, 1.0);
        normal = facing.normal;
    }
    for (int k = 0; k < (facing.shown == GBUFFER_SEVERAL ? count : 0); k++) {
        uint index = imageLoad(colours_image, ivec2(pixel.x * texels + k / 4, pixel.y))[k % 4];
        if (index != 0u) {
            vec2 at = vec2(samples * pixel + ivec2(k % samples, k / samples)) + 0.5;
            gbuffer_point p = gbuffer_point_of(gbuffer_triangle_of(index - 1u), at, gbuffer_ray(at));
            albedo += vec4(p.colours.albedo, 1.0) / float(count);
            normal += p.normal / float(count);
        }
    }
    imageStore(albedo_image, pixel, albedo);
    imageStore(normal_image, pixel, vec4(surface_turn(surfaces.to_world, normal), 0.0));
}
