// path_fluxes.comp -- where sunlight goes that enters a box: paths from the suns and the surroundings, followed until
// they leave. Reflectance, transmittance and absorption of a whole cloud field have no noise but that of these
// paths: an eye that looks for the light has to find every gap between clouds first.
//
// A path starts on the box's faces, uniformly over their area across the light, so its power is that of all light
// from there; along periodic axes the box has no faces, and the others stand for one period. It carries its power
// with it: what a collision absorbs is tallied there and taken away (survival biasing: Lux and Koblinger, "Monte
// Carlo particle transport methods", 1991), so a path adds to every sum, and roulette ends it once it is faint.
// Nothing is drawn by the eye: directions are those of the phase function.
//
// All paths of a thread are one sample of the statistics (path_fluxes_sum.comp).
#include "shaders/path/path_args.h"

const bool PROBE = false;
#include "shaders/path/path_resources.glsl"

TYN_WRITE(18, partials, float partials[]); // [value][thread]: mean over the thread's paths, W
TYN_UPDATE(19, counters, counters_block counters);

#include "shaders/path/path.glsl"
#include "shaders/path/path_entry.glsl"

// Sums over this thread's paths, W.
vec3 incident, leaving[6], direct, reflected, transmitted, absorbed_media, absorbed_surfaces, arriving_surfaces;

// Direction of travel of the next path's light, and its power over the probability of drawing it, W.
vec3 draw_light(float total, float u, inout rng_state rng, out vec3 power)
{
    float left = u * total;
    vec3 way = vec3(0.0, 0.0, 1.0);
    power = vec3(0.0);
    float drawn = 0.0;
    for (uint i = 0u; i < args.num_lights && LIGHTS > 0u; i++) {
        light_block sun = light_get(i);
        drawn = light_drawn_by(sun);
        if (left < drawn || (i + 1u == args.num_lights && ENVIRONMENT == TYN_PATH_ENV_NONE)) {
            way = sun.direction;
            power = sun.color * (total / max(max3(sun.color), 1e-37));
            return way;
        }
        left -= drawn;
    }
    if (ENVIRONMENT == TYN_PATH_ENV_MAP) {
        float pdf;
        way = -env_sample(env, rng_next(rng), pdf);
        power = environment_radiance(env, env_map_wrapped, -way) / max(pdf, 1e-37);
    } else if (ENVIRONMENT == TYN_PATH_ENV_CONSTANT) {
        vec2 random = rng_vec2(rng_next(rng).xy);
        float z = 1.0 - 2.0 * random.x, across = sqrt(max(1.0 - z * z, 0.0));
        way = vec3(across * cos(2.0 * HG_PI * random.y), across * sin(2.0 * HG_PI * random.y), z);
        power = 4.0 * HG_PI * env.radiance;
    }
    power *= sum3(faces_across(way)) * total / max(sky_drawn_by(), 1e-37);
    return way;
}

// Through which face, 2 axis + (1: the far one), light leaves the box.
uint face_left(const path_state path)
{
    vec3 inverse = ray_inverse(path.way);
    vec3 t = max((args.box_lo - path.vertex) * inverse, (args.box_hi - path.vertex) * inverse);
    t += 3e38 * vec3(medium.repeat);
    uint axis = t.x < t.y ? (t.x < t.z ? 0u : 2u) : (t.y < t.z ? 1u : 2u);
    return 2u * axis + (path.way[axis] > 0.0 ? 1u : 0u);
}

void leave(const path_state path, vec3 power, vec3 entered)
{
    uint face = face_left(path);
    for (uint i = 0u; i < 6u; i++) {
        leaving[i] += i == face ? power : vec3(0.0);
    }
    // The side that the light shines on.
    bool back = path.way[face >> 1] * entered[face >> 1] < 0.0;
    reflected += back ? power : vec3(0.0);
    transmitted += back ? vec3(0.0) : power;
    direct += path.depth == 0u ? power : vec3(0.0);
}

void follow(uint first, uint end)
{
    path_tint = vec3(1.0);
    float total = sky_drawn_by();
    for (uint i = 0u; i < args.num_lights && LIGHTS > 0u; i++) {
        total += light_drawn_by(light_get(i));
    }

    uint index = first;
    bool ended = true;
    rng_state rng;
    path_state path;
    vec3 power, entered;
    // As in path_run: a turn of the loop is a flight and what happens at its end.
    for (;;) {
        if (ended) {
            if (index >= end) {
                break;
            }
            ended = false;
            rng = rng_start(gl_GlobalInvocationID.x, index++, args.seed);
            uvec4 bits = rng_next(rng), more = rng_next(rng);
            path.way = draw_light(total, rng_float(bits.x), rng, power);
            path.vertex = draw_entry(path.way, vec3(rng_vec2(bits.yz), rng_float(bits.w)));
            path.beta = vec3(1.0);
            path.rho = vec3(1.0);
            path.hero = vec3(1.0, 0.0, 0.0);
            if (!GREY) {
                float u = 3.0 * rng_float(more.x);
                path.hero = vec3(u < 1.0, u >= 1.0 && u < 2.0, u >= 2.0);
            }
            path.kept = 1.0;
            path.depth = 0u;
            path.steps = 0u;
            path.end = PATH_FAR;
            entered = path.way;
            incident += power;
        }

        surface_hit ahead = surface_hit(PATH_FAR, SURFACE_NONE, vec2(0.0));
        vec3 period = vec3(0.0);
        if (SURFACES) {
            path.steps++;
            surface_trace(path.vertex, path.way, false, ahead, period);
            path.end = ahead.t;
        }
        bool met = false;
        path_flight f = path_fly(path, rng, met);
        path_count.hits += met && path.depth == 0u ? 1u : 0u;

        vec3 carried = power * path_weight(path);
        if (any(isnan(carried)) || any(isinf(carried))) {
            path_count.non_finite++;
            ended = true;
        } else if (path.steps >= args.max_steps) {
            path_count.cut++;
            ended = true;
        } else if (!f.collided && path.end >= PATH_FAR) {
            leave(path, carried, entered);
            ended = true;
        } else if (path.depth >= args.max_depth) {
            ended = true;
        } else {
            path.depth++;
            uvec4 bits = rng_next(rng);
            vec3 d;
            if (f.collided) {
                // Drawn for the hero; with several media the path goes on in one of them.
                float sigma_t = GREY ? f.m.sigma_t.x : dot(f.m.sigma_t, path.hero);
                float part = 1.0;
                vec3 chosen = vec3(1.0);
                if (SHAPES != 1u) {
                    part = dot(f.m.sigma_s, path.hero) / max(dot(f.m.part_s, path.hero), 1e-30);
                    chosen = f.m.part_s / max(f.m.sigma_s, vec3(1e-30));
                }
                vec3 density = GREY ? vec3(1.0) : path.rho * f.m.sigma_t / sigma_t;
                vec3 absorbs = path.beta * max(f.m.sigma_t - f.m.sigma_s, 0.0) / sigma_t;
                absorbed_media += power * (GREY ? absorbs : absorbs / channel_mean(density));
                path.beta *= f.m.part_s * (part / sigma_t);
                if (!GREY) {
                    path.rho *= f.m.sigma_t * chosen * (part / sigma_t);
                }
                d = phase_direction(path_phase(path, f.m), path.way, rng_vec2(bits.xy));
                if (!GREY) {
                    vec3 forward = phase_between(f.m.phase, path.way, d);
                    float divide = 1.0 / max(dot(forward, path.hero), 1e-30);
                    path.beta *= forward * divide;
                    path.rho *= forward * divide;
                }
                path.vertex = f.at;
            } else {
                surface_finding found = surface_find(ahead, period, path.way);
                arriving_surfaces += carried;
                absorbed_surfaces += carried * (1.0 - found.albedo);
                path.beta *= found.albedo;
                d = cosine_sample(found.point.normal, rng_vec2(bits.xy));
                path.vertex = surface_offset(found.point, found.point.normal);
            }
            path.way = d;
            float most = max3(path_weight(path));
            ended = !(most > 0.0);
            if (path.depth >= args.rr_depth && most < PATH_ROULETTE) {
                float survival = most / PATH_ROULETTE;
                ended = ended || rng_float(bits.z) >= survival;
                path.beta /= max(survival, 1e-30);
            }
        }
    }
    if (!ended || index < end) { // a device has ended the loop: these paths are missing
        path_count.cut++;
    }
}

void keep(uint value, vec3 sum, float share)
{
    for (uint c = 0u; c < 3u; c++) {
        partials[(3u * value + c) * args.slots + gl_GlobalInvocationID.x] = share * sum[c];
    }
}

void main()
{
    uint thread = gl_GlobalInvocationID.x;
    path_load();
    if (thread >= args.slots) {
        return;
    }
    incident = direct = reflected = transmitted = vec3(0.0);
    absorbed_media = absorbed_surfaces = arriving_surfaces = vec3(0.0);
    for (uint i = 0u; i < 6u; i++) {
        leaving[i] = vec3(0.0);
    }
    follow(args.first_sample, args.first_sample + args.num_samples);

    float share = 1.0 / float(args.num_samples);
    keep(TYN_PATH_FLUX_INCIDENT, incident, share);
    for (uint i = 0u; i < 6u; i++) {
        keep(TYN_PATH_FLUX_LEAVING + i, leaving[i], share);
    }
    keep(TYN_PATH_FLUX_DIRECT, direct, share);
    keep(TYN_PATH_FLUX_REFLECTED, reflected, share);
    keep(TYN_PATH_FLUX_TRANSMITTED, transmitted, share);
    keep(TYN_PATH_FLUX_ABSORBED_MEDIA, absorbed_media, share);
    keep(TYN_PATH_FLUX_ABSORBED_SURFACES, absorbed_surfaces, share);
    keep(TYN_PATH_FLUX_ARRIVING_SURFACES, arriving_surfaces, share);
    keep(TYN_PATH_FLUX_MISSING, incident - reflected - transmitted - absorbed_media - absorbed_surfaces, share);
    path_tally(thread == 0u && path_count.hits > 0u ? 1u : 0u);
}
