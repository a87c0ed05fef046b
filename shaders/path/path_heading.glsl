// path_heading.glsl -- first directions of paths that start at a point, over the whole sphere: uniform, the lobes
// of the phase function about a light, or the environment map. From a surface, by the cosine to its normal instead
// of uniform. Included after path.glsl.
#ifndef TYN_PATH_HEADING_GLSL
#define TYN_PATH_HEADING_GLSL

vec3 heading;      // direction of the path that is followed, away from the point
vec3 heading_axis; // of the lobes about a light
vec3 heading_normal; // of the surface that the point is on; else 0
float heading_pdf; // 1/sr

// Shares of the map and of the lobes about a light.
vec2 heading_shares()
{
    bool map = ENVIRONMENT == TYN_PATH_ENV_MAP;
    return vec2(map ? (LIGHTS > 0u ? 0.33 : 0.5) : 0.0, LIGHTS > 0u ? (map ? 0.33 : 0.5) : 0.0);
}

// pdf of direction `d`, 1/sr.
float heading_density(vec3 d)
{
    vec2 shares = heading_shares();
    bool free = heading_normal == vec3(0.0);
    float rest = free ? 0.25 / HG_PI : max(dot(d, heading_normal), 0.0) * (1.0 / HG_PI);
    float pdf = (1.0 - shares.x - shares.y) * rest;
    if (LIGHTS > 0u) {
        pdf += shares.y * light_lobes_pdf(shape_get(0u).phase, heading_axis, d).x;
    }
    if (ENVIRONMENT == TYN_PATH_ENV_MAP) {
        pdf += shares.x * env_pdf(env, d);
    }
    return pdf;
}

// `surface_normal`: of the surface that the point is on; 0 if it is free.
vec3 heading_draw(vec3 point, vec3 surface_normal, inout rng_state rng)
{
    heading_normal = surface_normal;
    uvec4 bits = rng_next(rng);
    vec2 shares = heading_shares();
    heading_axis = vec3(0.0, 0.0, 1.0);
    if (LIGHTS > 0u) {
        light_choice choice = light_choose(point, rng_float(bits.y), 0u);
        light_block light = light_get(min(choice.index, args.num_lights - 1u));
        heading_axis = light_from(light, light.position, point).direction;
    }
    float u = rng_float(bits.x);
    if (ENVIRONMENT == TYN_PATH_ENV_MAP && u < shares.x) {
        float pdf;
        heading = env_sample(env, rng_next(rng), pdf);
    } else {
        u = (u - shares.x) / (1.0 - shares.x);
        float c = shares.y / (1.0 - shares.x);
        if (u >= c && heading_normal != vec3(0.0)) {
            heading = cosine_sample(heading_normal, rng_vec2(bits.zw));
        } else {
            phase p = u < c ? phase_about_light(shape_get(0u).phase[0], u < 0.5 * c) : phase_of_mean_cosine(0.0);
            heading = phase_direction(p, heading_axis, rng_vec2(bits.zw));
        }
    }
    heading_pdf = max(heading_density(heading), 1e-30);
    return heading;
}

float path_begin_pdf(vec3 direction)
{
    return heading_density(direction);
}

#endif
