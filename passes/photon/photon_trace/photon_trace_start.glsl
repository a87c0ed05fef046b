// photon_trace_start.glsl -- photons of suns, lamps, surfaces that emit and the environment as they start. Included after path.glsl.
//
// Of all photons together places and lights lie evenly: they are terms of the Kronecker sequence of Roberts (2018), the
// n-th photon's of all generations.
#include "shaders/path/path_entry.glsl"

float start_emitters()
{
    return EMITTERS ? HG_PI * emitters.weight : 0.0;
}

float start_total()
{
    float total = sky_drawn_by() + start_emitters();
    for (uint i = 0u; i < args.num_lights && LIGHTS > 0u; i++) {
        total += light_drawn_by(light_get(i));
    }
    return total;
}

// Of light of `radiance` that travels along `way` from the map, what no sun that the march follows has.
vec3 start_beside_suns(vec3 way, vec3 radiance)
{
    vec3 left = vec3(1.0);
    for (uint i = 0u; i < plan.num_map_suns; i++) {
        if (dot(way, plan.map_suns[i].direction) >= plan.map_suns[i].cos_radius) {
            left = min(left, plan.map_suns[i].around / max(radiance, vec3(1e-37)));
        }
    }
    return left;
}

// Lobe of light that travels along `way` from the map: that of the region of the nearest principal ordinate. The regions' order
// is that of a tree of cuts, so neighbours in it share a lobe.
uint start_region(vec3 way)
{
    uint count = ordinates.count, nearest = 0u, regions = plan.lobes - plan.sky_first;
    float most = -2.0;
    for (uint i = 0u; regions > 1u && i < count; i++) {
        float cosine = dot(way, ordinates.list[i].direction);
        nearest = cosine > most ? i : nearest;
        most = max(most, cosine);
    }
    return plan.sky_first + nearest * regions / max(count, 1u);
}

// From a point of a surface that emits, by the cosine; `even` in [0, 1)^3, `total` as below.
void start_at_emitter(float total, vec3 even, inout rng_state rng, inout photon p)
{
    uvec4 bits = rng_next(rng);
    uint cell = min(uint(even.z * float(emitters.count)), emitters.count - 1u);
    uint index = surface_cell_pick(emitter_cells[cell], bits.x);
    surface_point point = surface_point_at(index, triangle_sample(even.xy));
    surface_material material = surface_material_at(surface_triangle_at(index).w);
    vec3 front = surface_emitted(material, true);
    bool two = max3(surface_emitted(material, false)) > 0.0, turned = two && (bits.y & 1u) != 0u;
    vec3 normal = turned ? -point.normal : point.normal;
    p.path.vertex = surface_offset(point, normal);
    p.path.way = cosine_sample(normal, rng_vec2(bits.zw));
    p.power = front * ((two ? 2.0 : 1.0) * total / max(max3(front), 1e-37));
    p.direct = vec3(1.0);
}

// Of the n-th photon where it begins, its lobe, what cells get of it before it has scattered, and its power over the probability
// of drawing it, W; `total` of start_total, > 0.
void start_photon(float total, uint n, inout rng_state rng, inout photon p)
{
    uvec3 shift = rng_pcg4d(uvec4(args.seed, 1u, 2u, 3u)).xyz;
    vec3 even = vec3((n * uvec3(3518319155u, 2882110345u, 2360945575u) + shift) >> 8) * (1.0 / 16777216.0);
    uvec4 bits = rng_next(rng);
    p.lobe = plan.lobes - 1u;
    p.path.beta = vec3(1.0);
    p.path.rho = vec3(1.0);
    p.path.hero = vec3(1.0, 0.0, 0.0);
    if (!GREY) {
        float u = 3.0 * rng_float(bits.x);
        p.path.hero = vec3(u < 1.0, u >= 1.0 && u < 2.0, u >= 2.0);
    }
    p.path.kept = 1.0;
    p.path.depth = 0u;
    p.path.steps = 0u;
    p.path.end = PATH_FAR;
    float left = even.z * total;
    for (uint i = 0u; i < args.num_lights && LIGHTS > 0u; i++) {
        light_block light = light_get(i);
        float weight = light_drawn_by(light);
        if (left < weight || (i + 1u == args.num_lights && !EMITTERS && ENVIRONMENT == TYN_PATH_ENV_NONE)) {
            p.power = light.color * (total / max(max3(light.color), 1e-37));
            p.direct = vec3((plan.marched[i >> 5] >> (i & 31u) & 1u) == 0u);
            if (light.kind == TYN_LIGHT_KIND_DIRECTIONAL) {
                p.path.way = light.direction;
                p.lobe = min(i, plan.lobes - 1u);
                p.path.vertex = draw_entry(p.path.way, vec3(even.xy, min(left / weight, 0.9999999)));
            } else {
                p.path.way = lamp_way(light, even.xy);
                p.path.vertex = light.position;
                p.power *= light_lobe(light, dot(p.path.way, light.direction));
            }
            return;
        }
        left -= weight;
    }
    if (EMITTERS) {
        float weight = start_emitters();
        if (left < weight || ENVIRONMENT == TYN_PATH_ENV_NONE) {
            start_at_emitter(total, vec3(even.xy, min(left / weight, 0.9999999)), rng, p);
            return;
        }
        left -= weight;
    }
    float sky = sky_drawn_by();
    p.path.way = vec3(0.0, 0.0, 1.0);
    p.power = vec3(0.0);
    p.direct = vec3(1.0);
    if (ENVIRONMENT == TYN_PATH_ENV_MAP) {
        float pdf;
        p.path.way = -env_sample(env, rng_next(rng), pdf);
        p.power = environment_radiance(env, env_map_wrapped, -p.path.way);
        p.direct = start_beside_suns(p.path.way, p.power);
        p.lobe = dot(p.path.way, plan.sun) >= plan.sun_cosine ? 0u : start_region(p.path.way);
        p.power /= max(pdf, 1e-37);
    } else if (ENVIRONMENT == TYN_PATH_ENV_CONSTANT) {
        vec2 random = rng_vec2(bits.yz);
        float z = 1.0 - 2.0 * random.x, across = sqrt(max(1.0 - z * z, 0.0));
        p.path.way = vec3(across * cos(2.0 * HG_PI * random.y), across * sin(2.0 * HG_PI * random.y), z);
        p.power = 4.0 * HG_PI * env.radiance;
    }
    p.path.vertex = draw_entry(p.path.way, vec3(even.xy, min(left / max(sky, 1e-37), 0.9999999)));
    p.power *= sum3(faces_across(p.path.way)) * total / max(sky, 1e-37);
}
