// raymarch_background.comp -- pixels in which no medium can be seen.
#include "shaders/common/camera.glsl"
TYN_UNIFORM(0, camera, camera_block camera);
#include "shaders/march/background.glsl"
#include "shaders/march/host_depth.glsl"
#define SURFACE_RADIANCE 9
#define GBUFFER_AT 10
#include "shaders/march/surface_samples.glsl"
#include "raymarch_args.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 2) const uint raymarch_features = 0u;
TYN_UNIFORM(1, environment, env_block environment);
layout(binding = 2) uniform sampler2D env_map_wrapped;
layout(binding = 3) uniform sampler2D host_depth_tex;
layout(binding = 4, rgba32f) uniform writeonly image2D radiance_image;
layout(binding = 5, rgba32f) uniform writeonly image2D transmittance_image;
layout(binding = 6, rgba32f) uniform writeonly image2D depth_image;
layout(binding = 7, rgba32f) uniform writeonly image2D single_image;
layout(binding = 8, rgba32f) uniform writeonly image2D multiple_image;

TYN_ARGS(raymarch_args args);

// A macro: its value is a specialization constant, and engine/gpu/specialize.c drops what is off.
#define has(feature) ((raymarch_features & (feature)) != 0u)

void main()
{
    uvec2 p = gl_GlobalInvocationID.xy;
    bool inside = all(greaterThanEqual(p, args.first)) && all(lessThan(p, args.end));
    if (inside || any(greaterThanEqual(p, camera.size))) {
        return;
    }
    ivec2 pixel = ivec2(p);
    camera_ray ray = camera_ray_through(camera, vec2(pixel) + 0.5);
    float surface = TYN_INFINITY;
    if (has(RAYMARCH_HOST_DEPTH)) {
        surface = host_distance(host_depth_tex, camera, args.depth, pixel, ray.direction);
    }
    vec4 radiance = vec4(0.0);
    float open = surface == TYN_INFINITY ? 1.0 : 0.0; // share in which the environment is seen
    if (has(RAYMARCH_SURFACE)) {
        surface_samples samples = surface_samples_of(pixel);
        if (has(RAYMARCH_SURFACE_SEEN) && samples.mean.a < surface) {
            radiance = vec4(samples.mean.rgb, samples.covered);
        }
        open *= 1.0 - samples.covered;
        surface = min(surface, samples.mean.a);
    }
    if (has(RAYMARCH_BACKGROUND) && open > 0.0) {
        radiance += open * vec4(background_radiance(environment, env_map_wrapped, camera,
                                                    ray.direction, vec2(pixel) + 0.5, 1.0), 1.0);
    }
    imageStore(radiance_image, pixel, radiance);
    if (has(RAYMARCH_TRANSMITTANCE)) {
        imageStore(transmittance_image, pixel, vec4(1.0));
    }
    if (has(RAYMARCH_DEPTH)) {
        imageStore(depth_image, pixel, vec4(surface, TYN_INFINITY, 0.0, 0.0));
    }
    if (has(RAYMARCH_SINGLE)) {
        imageStore(single_image, pixel, vec4(vec3(0.0), 1.0));
    }
    if (has(RAYMARCH_MULTIPLE)) {
        imageStore(multiple_image, pixel, vec4(vec3(0.0), 1.0));
    }
}
