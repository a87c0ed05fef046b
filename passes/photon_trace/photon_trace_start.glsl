// photon_trace_start.glsl -- photons of suns, lamps and the environment as they start. Included after path.glsl.
//
// Of all photons together places and lights lie evenly: they are terms of the Kronecker sequence of Roberts (2018), the
// n-th photon's of all generations.
#ifndef PHOTON_TRACE_START_GLSL
#define PHOTON_TRACE_START_GLSL
#include "shaders/path/path_entry.glsl"

// Solid angle into which a lamp shines, sr; of a sun the area across its light, m^2.
float start_measure(light_block light)
{
    return light.kind == TYN_LIGHT_KIND_DIRECTIONAL ? sum3(faces_across(light.direction))
                                                    : 2.0 * HG_PI * (1.0 - light.cos_outer);
}

// What lights are drawn by, W.
float start_weight(light_block light)
{
    return max3(light.color) * start_measure(light);
}

float start_sky()
{
    return ENVIRONMENT == TYN_PATH_ENV_NONE ? 0.0 : max3(env.mean) * HG_PI * sum3(faces_across(vec3(1.0)));
}

float start_total()
{
    float total = start_sky();
    for (uint i = 0u; i < args.num_lights && LIGHTS > 0u; i++) {
        total += start_weight(light_get(i));
    }
    return total;
}

// Into a lamp's cone, uniform.
vec3 start_cone(light_block lamp, vec2 random)
{
    float z = 1.0 - random.x * (1.0 - lamp.cos_outer);
    float across = sqrt(max(1.0 - z * z, 0.0)), azimuth = 2.0 * HG_PI * random.y;
    vec3 axis = lamp.direction;
    vec3 side = normalize(abs(axis.x) < 0.7 ? cross(axis, vec3(1.0, 0.0, 0.0)) : cross(axis, vec3(0.0, 1.0, 0.0)));
    return z * axis + across * (cos(azimuth) * side + sin(azimuth) * cross(axis, side));
}

// The n-th photon, and its power over the probability of drawing it, W; `total` of start_total, > 0.
path_state start_path(float total, uint n, inout rng_state rng, out vec3 power)
{
    uvec3 shift = rng_pcg4d(uvec4(args.seed, 1u, 2u, 3u)).xyz;
    vec3 even = vec3((n * uvec3(3518319155u, 2882110345u, 2360945575u) + shift) >> 8) * (1.0 / 16777216.0);
    uvec4 bits = rng_next(rng);
    path_state path;
    path.beta = vec3(1.0);
    path.rho = vec3(1.0);
    path.hero = vec3(1.0, 0.0, 0.0);
    if (!GREY) {
        float u = 3.0 * rng_float(bits.x);
        path.hero = vec3(u < 1.0, u >= 1.0 && u < 2.0, u >= 2.0);
    }
    path.kept = 1.0;
    path.depth = 0u;
    path.steps = 0u;
    path.end = PATH_FAR;
    float left = even.z * total;
    for (uint i = 0u; i < args.num_lights && LIGHTS > 0u; i++) {
        light_block light = light_get(i);
        float weight = start_weight(light);
        if (left < weight || (i + 1u == args.num_lights && ENVIRONMENT == TYN_PATH_ENV_NONE)) {
            power = light.color * (total / max(max3(light.color), 1e-37));
            if (light.kind == TYN_LIGHT_KIND_DIRECTIONAL) {
                path.way = light.direction;
                path.vertex = draw_entry(path.way, vec3(even.xy, min(left / weight, 0.9999999)));
            } else {
                path.way = start_cone(light, even.xy);
                path.vertex = light.position;
                power *= light_lobe(light, dot(path.way, light.direction));
            }
            return path;
        }
        left -= weight;
    }
    float sky = start_sky();
    path.way = vec3(0.0, 0.0, 1.0);
    power = vec3(0.0);
    if (ENVIRONMENT == TYN_PATH_ENV_MAP) {
        float pdf;
        path.way = -env_sample(env, rng_next(rng), pdf);
        power = environment_radiance(env, env_map_wrapped, -path.way) / max(pdf, 1e-37);
    } else if (ENVIRONMENT == TYN_PATH_ENV_CONSTANT) {
        vec2 random = rng_vec2(bits.yz);
        float z = 1.0 - 2.0 * random.x, across = sqrt(max(1.0 - z * z, 0.0));
        path.way = vec3(across * cos(2.0 * HG_PI * random.y), across * sin(2.0 * HG_PI * random.y), z);
        power = 4.0 * HG_PI * env.radiance;
    }
    path.vertex = draw_entry(path.way, vec3(even.xy, min(left / max(sky, 1e-37), 0.9999999)));
    power *= sum3(faces_across(path.way)) * total / max(sky, 1e-37);
    return path;
}

#endif
