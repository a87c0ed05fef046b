// impostor.comp -- one thread a pixel: where its ray meets the plane of the march, what that shows there.
#include "shaders/common/scene_args.h"
#include "shaders/march/background.glsl"
#include "impostor_args.h"

layout(local_size_x = 8, local_size_y = 8) in;
TYN_ARGS(impostor_args args);
TYN_UNIFORM(0, medium, medium_block medium);
TYN_READ(1, taken, camera_block taken);
TYN_UNIFORM(2, camera, camera_block camera);
TYN_UNIFORM(3, environment, env_block environment);
layout(binding = 4) uniform sampler2D env_map_wrapped;
layout(binding = 5) uniform sampler2D marched_tex;
layout(binding = 6) uniform sampler2D left_tex;
layout(binding = 7, rgba32f) uniform writeonly image2D radiance_image;
layout(binding = 8, rgba32f) uniform writeonly image2D transmittance_image;

// Where the march shows what it saw of the point q, 0 to 1 along its sides; outside of that nothing.
vec2 impostor_place(vec3 q)
{
    vec3 to = q - taken.origin;
    float depth = camera_select(taken, 1.0, max(dot(to, taken.forward), 1e-20));
    vec2 s = vec2(dot(to, taken.right) / (depth * taken.half_width), dot(to, taken.up) / (depth * taken.half_height));
    return 0.5 + 0.5 * vec2(s.x - taken.shift.x, taken.shift.y - s.y);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), camera.size))) {
        return;
    }
    camera_ray ray = camera_ray_through(camera, vec2(pixel) + 0.5);
    float away = dot(0.5 * medium.extent - ray.origin, taken.forward), along = dot(ray.direction, taken.forward);
    vec4 radiance = vec4(0.0);
    vec3 left = vec3(1.0);
    if (away > 0.0 && along > 1e-3) {
        vec2 uv = impostor_place(ray.origin + (away / along) * ray.direction);
        if (all(greaterThan(uv, vec2(0.0))) && all(lessThan(uv, vec2(1.0)))) {
            radiance = textureLod(marched_tex, uv, 0.0);
            left = textureLod(left_tex, uv, 0.0).rgb;
        }
    }
    if (args.background == 1u) {
        radiance.rgb += left * background_radiance(environment, env_map_wrapped, camera, ray.direction,
                                                   vec2(pixel) + 0.5, 1.0);
        radiance.a = 1.0;
    }
    imageStore(radiance_image, pixel, radiance);
    imageStore(transmittance_image, pixel, vec4(left, 1.0));
}
