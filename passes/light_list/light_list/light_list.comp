// light_list.comp -- all lights as they shine on the medium: the constellation turned with the environment, then
// suns and lamps of the scene.
#include "light_list_args.h"
#include "shaders/common/scene_args.h"

layout(local_size_x = 64) in;
TYN_ARGS(light_list_args args);
TYN_READ(0, constellation, constellation_block constellation);
TYN_UNIFORM(1, suns, light_block suns[TYN_LIGHTS_MAX]);
TYN_UNIFORM(2, lights, light_block lights[TYN_LIGHTS_MAX]);
TYN_UNIFORM(3, environment, env_block environment);
TYN_WRITE(4, light_list, light_list_block light_list);

light_block light_of_constellation(uint i)
{
    const constellation_light star = constellation.lights[i];
    const vec3 towards = star.direction.x * environment.rows[0].xyz + star.direction.y * environment.rows[1].xyz +
                         star.direction.z * environment.rows[2].xyz; // rows are orthonormal
    light_block light;
    light.position = vec3(0.0);
    light.kind = TYN_LIGHT_KIND_DIRECTIONAL;
    light.color = environment.radiance * star.power;
    light.cos_inner = light.cos_outer = -1.0;
    light.direction = -towards;
    light.radius = 0.0;
    light.shadow = TYN_LIGHT_NO_SHADOW;
    // Of a cone with the region's solid angle.
    light.mean_cosine = args.wide != 0u ? 1.0 - star.solid_angle / (4.0 * 3.14159265359) : 1.0;
    light.pad = 0u;
    return light;
}

light_block light_of_scene(uint i)
{
    light_block light;
    if (i < args.num_suns) {
        light = suns[i];
        light.shadow = TYN_LIGHT_NO_SHADOW;
        [[unroll]] for (uint k = 0u; k < 4u; k++) {
            light.shadow = k == i && k < args.suns_with_shadow ? args.sun_shadow[k] : light.shadow;
        }
    } else {
        light = lights[args.first_lamp + i - args.num_suns];
        light.shadow = args.shadows != 0u ? TYN_SHADOW_LAMP(i - args.num_suns) : TYN_LIGHT_NO_SHADOW;
        light.mean_cosine = 1.0; // a point
    }
    return light;
}

void main()
{
    const uint stars = args.constellation != 0u ? min(constellation.count, uint(TYN_CONSTELLATION_MAX)) : 0u;
    const uint count = stars + args.num_suns + args.num_lamps;
    for (uint i = gl_LocalInvocationIndex; i < count; i += 64u) {
        if (i < stars) {
            light_list.lights[i] = light_of_constellation(i);
        } else {
            light_list.lights[i] = light_of_scene(i - stars);
        }
    }
    if (gl_LocalInvocationIndex == 0u) {
        vec3 sum = vec3(0.0);
        for (uint i = 0u; i < stars; i++) {
            sum += environment.radiance * constellation.lights[i].power;
        }
        for (uint i = 0u; i < args.num_suns; i++) {
            sum += suns[i].color;
        }
        light_list.count = count;
        light_list.mean = sum * (1.0 / (4.0 * 3.14159265359));
    }
}
