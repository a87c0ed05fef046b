// path_lights.glsl -- drawing a light for next-event estimation.
//
// The includer declares the resources of path_resources.glsl.
#ifndef TYN_PATH_LIGHTS_GLSL
#define TYN_PATH_LIGHTS_GLSL
#include "shaders/common/scene_args.h"
#include "shaders/random/rng.glsl"

const uint LIGHT_MAP = 1u, LIGHT_EMITTERS = 2u; // what may be drawn beside suns and lamps

struct light_choice {
    uint index;         // args.num_lights: the environment map; one more: emissive triangles
    float probability;
    float emitters;     // probability of the emissive triangles
};

struct light_sample {
    vec3 direction; // towards the light, unit
    float distance; // m
    vec3 arriving;  // irradiance on a perpendicular plane in vacuum, W/m^2
};

light_block light_get(uint index)
{
    if (LIGHTS == 1u) {
        return path_light0;
    }
    return path_light(index);
}

// What a light sends to p from a point of itself.
light_sample light_from(const light_block light, vec3 from, vec3 p)
{
    if ((FLAGS & TYN_PATH_LAMPS) == 0u || light.kind == TYN_LIGHT_KIND_DIRECTIONAL) {
        return light_sample(-light.direction, 1e30, light.color);
    }
    vec3 to = from - p;
    float distance2 = max(dot(to, to), 1e-34);
    float distance = sqrt(distance2);
    vec3 direction = to / distance;
    float lobe = light_lobe(light, dot(-direction, light.direction));
    return light_sample(direction, distance, light.color * (lobe / distance2));
}

// A sample of light `index`. A lamp with an extent draws the point that it shines from by `rng`; points and cones need
// no draw.
light_sample light_towards(uint index, vec3 p, inout rng_state rng)
{
    light_block light = light_get(index);
    return light_from(light, light.position, p);
}

// What light `index` would send to `p` through vacuum: the weight of the draw.
float light_weight(uint index, vec3 p)
{
    light_block light = light_get(index);
    vec3 arriving = light_from(light, light.position, p).arriving;
    return max(arriving.x, max(arriving.y, arriving.z));
}

// About what the emissive triangles together send to `p` through vacuum.
float emitters_irradiance(vec3 p)
{
    vec3 to = path_emitters.xyz - p;
    return emitters.weight / max(dot(to, to), path_emitters.w);
}

// Draws a light in proportion to light_weight; the environment map by its mean fluence; emissive triangles by
// about what they send.
light_choice light_choose(vec3 p, float u, uint kinds)
{
    bool map = (kinds & LIGHT_MAP) != 0u && ENVIRONMENT == TYN_PATH_ENV_MAP;
    bool emitters = (kinds & LIGHT_EMITTERS) != 0u && (FLAGS & TYN_PATH_EMITTERS) != 0u;
    if (LIGHTS == 0u && !(map && emitters)) {
        return light_choice(args.num_lights + (emitters ? 1u : 0u), map || emitters ? 1.0 : 0.0, emitters ? 1.0 : 0.0);
    }
    if (LIGHTS == 1u && !map && !emitters) {
        return light_choice(0u, 1.0, 0.0);
    }
    float map_weight = map ? 12.5663706 * max(env.mean.x, max(env.mean.y, env.mean.z)) : 0.0;
    // Emitters are met by directions as well, so they need the smaller half of their share here.
    float emitters_weight = emitters ? 0.5 * emitters_irradiance(p) : 0.0;
    float total = emitters_weight;
    for (uint i = 0u; i < args.num_lights; i++) {
        total += light_weight(i, p);
    }
    // It is found in no other way: a third of the draws at least, however strong a sun or near a lamp is.
    map_weight = map ? max(map_weight, 0.5 * total) : 0.0;
    total += map_weight;
    if (!(total > 0.0)) {
        return light_choice(0u, 0.0, 0.0);
    }
    float at = u * total;
    float weight = 0.0;
    uint index = args.num_lights + 2u;
    for (uint i = 0u; i < args.num_lights; i++) {
        weight = light_weight(i, p);
        if (at < weight) {
            index = i;
            break;
        }
        at -= weight;
    }
    if (index > args.num_lights) {
        bool emitter = emitters && (at < emitters_weight || !map);
        index = args.num_lights + (emitter ? 1u : 0u);
        weight = emitter ? emitters_weight : map_weight;
    }
    return light_choice(index, weight / total, emitters_weight / total);
}

#endif
