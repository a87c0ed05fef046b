// path_heading.glsl -- first directions of paths that start at a point, over the whole sphere: uniform, the lobes
// of the phase function about a light, or the environment map. Included after path.glsl.
#ifndef TYN_PATH_HEADING_GLSL
#define TYN_PATH_HEADING_GLSL

vec3 heading;      // direction of the path that is followed, away from the point
float heading_pdf; // 1/sr

vec3 heading_draw(vec3 point, inout rng_state rng)
{
    uvec4 bits = rng_next(rng);
    float map_share = ENVIRONMENT == TYN_PATH_ENV_MAP ? (LIGHTS > 0u ? 0.33 : 0.5) : 0.0;
    float lobe_share = LIGHTS > 0u ? (ENVIRONMENT == TYN_PATH_ENV_MAP ? 0.33 : 0.5) : 0.0;
    float g = max(shape_get(0u).g.x, 0.0);
    vec3 axis = vec3(0.0, 0.0, 1.0);
    if (LIGHTS > 0u) {
        light_choice choice = light_choose(point, rng_float(bits.y), false);
        axis = light_towards(min(choice.index, args.num_lights - 1u), point).direction;
    }
    float u = rng_float(bits.x);
    if (ENVIRONMENT == TYN_PATH_ENV_MAP && u < map_share) {
        float pdf;
        heading = env_sample(env, rng_next(rng), pdf);
    } else {
        u = (u - map_share) / (1.0 - map_share);
        float c = lobe_share / (1.0 - map_share);
        heading = phase_sample(u < c ? (u < 0.5 * c ? g : g * g) : 0.0, axis, rng_vec2(bits.zw));
    }
    vec3 lobes = 0.5 * (phase(vec3(g), axis, heading) + phase(vec3(g * g), axis, heading));
    heading_pdf = (1.0 - map_share - lobe_share) * (0.25 / HG_PI) + lobe_share * lobes.x;
    if (ENVIRONMENT == TYN_PATH_ENV_MAP) {
        heading_pdf += map_share * env_pdf(env, heading);
    }
    return heading;
}

#endif
