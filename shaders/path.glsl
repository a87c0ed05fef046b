// path.glsl -- unbiased light paths in participating media, followed from the eye.
//
// The estimators, and where they are from:
//  * Free flights by delta tracking, transmittance by ratio tracking, both against the bricks' bounds
//    (Novak et al., "Monte Carlo methods for volumetric light transport simulation", 2018, 4.2 and 4.3). Where
//    the least extinction of a brick is known it is taken out analytically (residual ratio tracking).
//  * Colour: free flights and directions are drawn for one channel, the hero, chosen per path. `beta`
//    is the path's measurement over the hero's pdf, `rho` every channel's pdf over the hero's; a contribution
//    is beta / mean(rho), the balance heuristic over channels (Miller, Georgiev and Jarosz, "A null-scattering
//    path integral formulation of light transport", 2019), which is bounded by 3 times the best channel's.
//  * Directions: the phase function, or light lobes with probability c_n = 0.2 0.8^n at vertex n: a mixture
//    with the lobes of g and g^2 about the direction to one light that the path keeps. The weight p / q is at most
//    1 / (1 - c_n); at high g it brings paths back into the light's own lobe.
//  * Lamps: next-event estimation at collisions, and along each stretch equi-angular distances (Kulla and
//    Fajardo, "Importance sampling techniques for path tracing in participating media", 2012). Each distance
//    t gets weights of both that add up to 1; they need not be the true pdfs, so free flights in an unknown
//    medium are weighed as in a homogeneous one.
//  * Environment map: next-event estimation and phase sampling, balance heuristic over directions.
//
// One loop, one stage per turn, so that threads of a subgroup at different stages stay together.
//
// The includer declares the resources of path_media.glsl and path_lights.glsl, and defines
//   void path_begin(inout rng_state, out vec3 origin, out vec3 direction)  -- start of the next path
//   void path_direct(vec3 direction, vec3 radiance)  -- probes: uncollided lamps at the point itself
//   void path_end(path_result)                       -- the path's contribution
#ifndef TYN_PATH_GLSL
#define TYN_PATH_GLSL
#include "env_sampling.glsl"
#include "path_lights.glsl"
#include "path_media.glsl"
#include "path_phase.glsl"
#include "rng.glsl"

struct path_result {
    vec3 radiance;      // scattered and emitted by the media
    vec3 single;        // its part of first order
    vec3 background;    // the environment, seen through the media
    vec3 transmittance; // mean 1 in vacuum: an unbiased estimate for each channel
    bool hit;           // met the domain of the media
};

struct path_counts { // of this thread
    uint collisions, non_finite, cut, hits;
};
path_counts path_count = path_counts(0u, 0u, 0u, 0u);

void path_begin(inout rng_state rng, out vec3 origin, out vec3 direction);
void path_direct(vec3 direction, vec3 radiance);
void path_end(path_result result);

const float PATH_MIXTURE_FIRST = 0.2, PATH_MIXTURE_LOG2_DECAY = -0.32192809; // log2 0.8
const float PATH_ROULETTE = 0.1; // paths, and transmittance, below this weight are played for
const float PATH_FAR = 1e30;

const uint STAGE_BEGIN = 0u;   // no path
const uint STAGE_STRETCH = 1u; // at a vertex, about to leave it
const uint STAGE_FLIGHT = 2u;  // delta tracking from the vertex
const uint STAGE_SHADOW = 3u;  // ratio tracking from the vertex to a light
const uint STAGE_ALONG = 4u;   // ratio tracking along the stretch to the equi-angular point
const uint STAGE_ASIDE = 5u;   // ratio tracking from there to the lamp
const uint STAGE_END = 6u;

// The stretch of a ray seen from a lamp: distances along the ray and the angles that they span.
struct lamp_view {
    vec2 span;
    float closest, height, angle0, angle1;
};

lamp_view lamp_see(vec3 lamp, vec3 origin, vec3 direction, vec2 span)
{
    lamp_view v;
    v.closest = dot(lamp - origin, direction);
    v.height = max(length(lamp - origin - v.closest * direction), 1e-6);
    // Along a repeated axis the rest of an endless ray is left to free flights.
    v.span = vec2(span.x, min(span.y, max(v.closest, span.x) + 1e3 * length(medium.extent)));
    v.angle0 = atan((v.span.x - v.closest) / v.height);
    v.angle1 = max(atan((v.span.y - v.closest) / v.height), v.angle0 + 1e-7);
    return v;
}

float lamp_pdf(lamp_view v, float t)
{
    float x = t - v.closest;
    if (t > v.span.y) {
        return 0.0;
    }
    return v.height / ((v.angle1 - v.angle0) * (v.height * v.height + x * x));
}

// Weight of free-flight sampling at distance t, against equi-angular sampling.
float flight_weight(float pdf_equiangular, float t)
{
    float guess = args.sigma_guess * exp(-args.sigma_guess * t);
    return guess / max(guess + pdf_equiangular, 1e-30);
}

// Draws a lamp for a stretch by what it sends to the nearest point of its line.
uint lamp_choose(vec3 origin, vec3 direction, float u, out float probability)
{
    float total = 0.0, kept = 0.0;
    uint index = args.num_lights;
    for (uint i = 0u; i < args.num_lights; i++) {
        if (lights[i].kind == TYN_LIGHT_KIND_DIRECTIONAL) {
            continue;
        }
        vec3 to = lights[i].position - origin;
        float height = length(to - max(dot(to, direction), 0.0) * direction);
        float weight = max3(lights[i].color) / max(height, 1e-6);
        total += weight;
        float share = weight / max(total, 1e-30);
        if (u < share) {
            index = i;
            kept = weight;
            u /= max(share, 1e-12);
        } else {
            u = (u - share) / max(1.0 - share, 1e-12);
        }
    }
    probability = kept / max(total, 1e-30);
    return index;
}

float channel_mean(vec3 v)
{
    return (v.x + v.y + v.z) * (1.0 / 3.0);
}

// One path's light: everything, and its first order.
void path_add(inout path_result result, vec3 radiance, bool first_order)
{
    result.radiance += radiance;
    if ((FLAGS & TYN_PATH_LAYERS) != 0u && first_order) {
        result.single += radiance;
    }
}

// Follows samples [first, end) of one pixel or point.
void path_run(uint element, uint first, uint end)
{
    uint index = first, stage = STAGE_BEGIN;
    rng_state rng = rng_start(element, first, args.seed);
    path_result result;
    // Extinction of each channel over the largest, where coefficients are constants times density.
    vec3 tint = GREY ? vec3(1.0) : (medium.sigma_s + medium.sigma_a) / max(medium.sigma_t_max, 1e-30);

    // The path.
    vec3 vertex, way;         // where it is, and where it goes on to
    vec3 beta, rho, hero;     // see above; 1 in the hero channel
    uint depth, steps;        // scatterings so far; effort so far
    vec4 lobe;                // direction towards a light (w 0) or a lamp's position (w 1); none: w -1
    float pdf_phase, pdf_map; // of `way`; probability with which the map was drawn at the vertex
    bool alive;               // goes on after the shadow ray

    // The ray that is tracked.
    vec3 at, along;
    float gone, left; // distances from its start and to its end, m
    float tau;        // optical depth to the next tentative collision
    brick_walk walk;
    float bound, ground; // extinction of the brick: most and least of the largest channel, 1/m
    bool starts = false, arrives = false;
    vec3 passed, pending; // transmittance so far; what arrives if nothing is lost
    uint lamp;            // of the equi-angular sample
    float lamp_at, lamp_factor;

    for (;;) {
        arrives = false;

        if (stage == STAGE_BEGIN) {
            if (index >= end) {
                break;
            }
            rng = rng_start(element, index++, args.seed);
            result = path_result(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), false);
            beta = vec3(1.0);
            rho = vec3(1.0);
            hero = vec3(1.0, 0.0, 0.0);
            lobe = vec4(0.0, 0.0, 0.0, -1.0);
            depth = 0u;
            steps = 0u;
            pdf_phase = 1.0;
            pdf_map = 0.0;
            alive = true;
            path_begin(rng, vertex, way);
            uvec4 bits = rng_next(rng);
            if (!GREY) {
                float u = 3.0 * rng_float(bits.x);
                hero = vec3(u < 1.0, u >= 1.0 && u < 2.0, u >= 2.0);
            }
            if ((FLAGS & TYN_PATH_MIXTURE) != 0u) {
                // Any axis that does not depend on the path is unbiased.
                light_choice choice = light_choose(0.5 * medium.extent, rng_float(bits.y), true);
                if (LIGHTS > 0u && choice.index < args.num_lights) {
                    light_block light = lights[choice.index];
                    lobe = light.kind == TYN_LIGHT_KIND_DIRECTIONAL ? vec4(-light.direction, 0.0)
                                                                    : vec4(light.position, 1.0);
                } else if (ENVIRONMENT == TYN_PATH_ENV_MAP) {
                    float pdf;
                    lobe = vec4(env_sample(env, rng_next(rng), pdf), 0.0);
                }
            }
            stage = STAGE_STRETCH;
            if (PROBE && LIGHTS > 0u && (FLAGS & TYN_PATH_SCATTERED) == 0u) {
                light_choice choice = light_choose(vertex, rng_float(bits.z), false);
                if (choice.probability > 0.0) {
                    light_sample light = light_towards(choice.index, vertex);
                    at = vertex;
                    along = light.direction;
                    left = light.distance;
                    pending = light.arriving / choice.probability;
                    passed = vec3(1.0);
                    stage = STAGE_SHADOW;
                    starts = true;
                }
            }
        }

        if (stage == STAGE_STRETCH) {
            at = vertex;
            along = way;
            left = PATH_FAR;
            starts = true;
            stage = STAGE_FLIGHT;
            if ((FLAGS & TYN_PATH_EQUIANGULAR) != 0u && depth < args.max_depth) {
                vec2 span = media_span(vertex, way);
                uvec4 bits = rng_next(rng);
                float probability;
                lamp = lamp_choose(vertex, way, rng_float(bits.x), probability);
                if (span.x < span.y && lamp < args.num_lights) {
                    lamp_view v = lamp_see(lights[lamp].position, vertex, way, span);
                    float angle = mix(v.angle0, v.angle1, rng_float(bits.y));
                    lamp_at = clamp(v.closest + v.height * tan(angle), v.span.x, v.span.y);
                    float pdf = lamp_pdf(v, lamp_at);
                    lamp_factor = (1.0 - flight_weight(pdf, lamp_at)) / (pdf * probability);
                    left = lamp_at;
                    passed = vec3(1.0);
                    stage = STAGE_ALONG;
                }
            }
        }

        if (starts) {
            starts = false;
            vec2 span = media_span(at, along);
            span.y = min(span.y, left);
            if (span.x >= span.y) {
                arrives = true;
            } else if (HOMOGENEOUS && stage != STAGE_FLIGHT) {
                passed *= exp(-(shapes[0].sigma_s + shapes[0].sigma_a) * (span.y - span.x));
                arrives = true;
            } else {
                at += span.x * along;
                gone = span.x;
                left = span.y - span.x;
                tau = rng_exponential(rng_next(rng).x);
                if (HOMOGENEOUS) {
                    bound = max3(shapes[0].sigma_s + shapes[0].sigma_a);
                    ground = 0.0;
                } else {
                    walk = brick_start(medium, at, along);
                    vec2 bounds = media_bounds(walk.cell);
                    bound = bounds.y;
                    ground = bounds.x;
                }
                if (stage == STAGE_FLIGHT) {
                    result.hit = true;
                }
            }
        }

        if (!arrives) {
            bool flight = stage == STAGE_FLIGHT;
            float ahead = left;
            int axis = 0;
            if (!HOMOGENEOUS) {
                float face = brick_exit(medium, walk, at, axis);
                arrives = left <= face;
                ahead = min(left, face);
            }
            // Shadow rays lose the least extinction analytically and track the rest.
            float tracked = flight ? bound : bound - ground;
            bool collides = tau < tracked * ahead;
            float moved = collides ? tau / tracked : ahead;
            if ((FLAGS & TYN_PATH_EMISSIVE) != 0u && flight) {
                // Track-length estimator, at one point of the way that is unlikely to be the same again.
                uvec4 bits = rng_next(rng);
                vec3 glow = media_at(at + moved * rng_float(bits.x) * along, 0.0, hero).emission;
                result.radiance += beta / channel_mean(rho) * glow * moved;
            }
            at += moved * along;
            gone += moved;
            left -= moved;
            if (!flight) {
                passed *= exp(-ground * moved * tint);
            }
            if (++steps > args.max_steps) {
                path_count.cut++;
                stage = STAGE_END;
            } else if (!collides) {
                tau -= tracked * ahead;
                if (HOMOGENEOUS) {
                    arrives = true;
                } else if (!arrives) {
                    if (brick_step(medium, walk, axis)) {
                        vec2 bounds = media_bounds(walk.cell);
                        bound = bounds.y;
                        ground = bounds.x;
                    } else {
                        arrives = true;
                    }
                }
            } else {
                arrives = false;
                path_count.collisions++;
                uvec4 bits = rng_next(rng);
                tau = rng_exponential(bits.x);
                media_point m = media_at(at, rng_float(bits.z), hero);
                if (!flight) {
                    vec3 kept = 1.0 - (m.sigma_t - ground * tint) / tracked;
                    passed *= clamp(kept, 0.0, 1.0);
                    float most = max3(passed);
                    if (most < PATH_ROULETTE) {
                        float survival = most / PATH_ROULETTE;
                        bool survives = rng_float(bits.y) < survival;
                        passed = survives ? passed / survival : vec3(0.0);
                        arrives = !survives;
                    }
                } else {
                    float sigma_t = GREY ? m.sigma_t.x : dot(m.sigma_t, hero);
                    if (rng_float(bits.y) * bound >= sigma_t) {
                        if (!GREY) {
                            // Null collision: the path goes straight on, its colour does not.
                            vec3 none = max(bound - m.sigma_t, 0.0);
                            float divide = 1.0 / max(dot(none, hero), 1e-30);
                            beta *= none * divide;
                            rho *= none * divide;
                        }
                    } else if (depth >= args.max_depth) {
                        stage = STAGE_END;
                    } else {
                        // A real collision. With several media the path goes on in one of them.
                        depth++;
                        float part = ONE_SHAPE == 1u ? 1.0 : dot(m.sigma_s, hero) /
                                                             max(dot(m.part_s, hero), 1e-30);
                        beta *= m.part_s * (part / sigma_t);
                        if (!GREY) {
                            vec3 chosen = ONE_SHAPE == 1u ? vec3(1.0)
                                                          : m.part_s / max(m.sigma_s, vec3(1e-30));
                            rho *= m.sigma_t * chosen * (part / sigma_t);
                        }
                        vec3 weight = GREY ? beta : beta / channel_mean(rho);
                        bits = rng_next(rng);

                        vec3 toward = vec3(0.0);
                        float c = 0.0;
                        if ((FLAGS & TYN_PATH_MIXTURE) != 0u && lobe.w >= 0.0) {
                            toward = lobe.w > 0.0 ? lobe.xyz - at : lobe.xyz;
                            toward *= inversesqrt(max(dot(toward, toward), 1e-30));
                            c = PATH_MIXTURE_FIRST * exp2(PATH_MIXTURE_LOG2_DECAY * float(depth - 1u));
                        }

                        // Next-event estimation.
                        pending = vec3(0.0);
                        light_choice choice = light_choose(at, rng_float(bits.x), true);
                        if (choice.probability > 0.0) {
                            if (LIGHTS > 0u && choice.index < args.num_lights) {
                                light_sample light = light_towards(choice.index, at);
                                float factor = 1.0 / choice.probability;
                                if ((FLAGS & TYN_PATH_EQUIANGULAR) != 0u &&
                                    lights[choice.index].kind != TYN_LIGHT_KIND_DIRECTIONAL) {
                                    lamp_view v = lamp_see(lights[choice.index].position, vertex, way,
                                                           media_span(vertex, way));
                                    factor *= flight_weight(lamp_pdf(v, gone), gone);
                                }
                                along = light.direction;
                                left = light.distance;
                                pending = weight * phase(m.g, way, along) * light.arriving * factor;
                            } else if (ENVIRONMENT == TYN_PATH_ENV_MAP) {
                                float pdf;
                                along = env_sample(env, rng_next(rng), pdf);
                                left = PATH_FAR;
                                vec3 forward = phase(m.g, way, along);
                                float other = channel_mean(mixture_pdf(m.g, forward, toward, along, c));
                                pending = weight * forward * environment_radiance(env, env_map, along) /
                                          max(pdf * choice.probability + other, 1e-30);
                            }
                        }

                        // The next direction.
                        vec3 d = mixture_sample(GREY ? m.g.x : dot(m.g, hero), way, toward, c,
                                                rng_float(bits.y), rng_vec2(bits.zw));
                        if ((FLAGS & TYN_PATH_MIXTURE) != 0u || !GREY || ENVIRONMENT == TYN_PATH_ENV_MAP) {
                            vec3 forward = phase(m.g, way, d);
                            vec3 pdf = mixture_pdf(m.g, forward, toward, d, c);
                            float divide = 1.0 / max(GREY ? pdf.x : dot(pdf, hero), 1e-30);
                            beta *= forward * divide;
                            if (!GREY) {
                                rho *= pdf * divide;
                            }
                            pdf_phase = channel_mean(pdf);
                            pdf_map = choice.environment;
                        }
                        vertex = at;
                        way = d;

                        float most = max3(GREY ? beta : beta / channel_mean(rho));
                        alive = most > 0.0;
                        if (depth >= args.rr_depth && most < PATH_ROULETTE) {
                            float survival = most / PATH_ROULETTE;
                            alive = rng_float(rng_next(rng).x) < survival;
                            beta /= max(survival, 1e-30);
                        }

                        stage = alive ? STAGE_STRETCH : STAGE_END;
                        if (max3(pending) > 0.0) {
                            passed = vec3(1.0);
                            if (HOMOGENEOUS) {
                                float length = min(media_span(at, along).y, left);
                                passed = exp(-m.sigma_t * length);
                                path_add(result, pending * passed, depth == 1u);
                            } else {
                                stage = STAGE_SHADOW;
                                starts = true;
                            }
                        }
                    }
                }
            }
        }

        if (arrives) {
            vec3 weight = GREY ? beta : beta / channel_mean(rho);
            if (stage == STAGE_FLIGHT) {
                if (ENVIRONMENT != TYN_PATH_ENV_NONE) {
                    vec3 sky = weight * (ENVIRONMENT == TYN_PATH_ENV_MAP
                                             ? environment_radiance(env, env_map, way)
                                             : env.radiance);
                    if (ENVIRONMENT == TYN_PATH_ENV_MAP && pdf_map > 0.0) {
                        sky *= pdf_phase / (pdf_phase + pdf_map * env_pdf(env, way));
                    }
                    if (depth == 0u) {
                        result.background = sky;
                    } else {
                        path_add(result, sky, depth == 1u);
                    }
                }
                if (depth == 0u) {
                    result.transmittance = weight;
                }
                stage = STAGE_END;
            } else if (stage == STAGE_SHADOW) {
                if (PROBE && depth == 0u) {
                    path_direct(along, pending * passed);
                } else {
                    path_add(result, pending * passed, depth == 1u);
                }
                stage = alive ? STAGE_STRETCH : STAGE_END;
            } else if (stage == STAGE_ALONG) {
                at = vertex + lamp_at * way;
                media_point m = media_at(at, rng_float(rng_next(rng).x), vec3(1.0 / 3.0));
                light_sample light = light_towards(lamp, at);
                float part = max3(m.part_s) > 0.0 ? channel_mean(m.sigma_s) / channel_mean(m.part_s) : 0.0;
                pending = weight * m.part_s * phase(m.g, way, light.direction) * light.arriving *
                          (part * lamp_factor);
                along = light.direction;
                left = light.distance;
                stage = STAGE_ASIDE;
                starts = true;
            } else {
                path_add(result, pending * passed, depth == 0u);
                at = vertex;
                along = way;
                left = PATH_FAR;
                stage = STAGE_FLIGHT;
                starts = true;
            }
        }

        if (stage == STAGE_END) {
            vec3 sum = result.radiance + result.background + result.single + result.transmittance;
            if (any(isnan(sum)) || any(isinf(sum))) {
                path_count.non_finite++;
                result = path_result(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), result.hit);
            }
            path_count.hits += result.hit ? 1u : 0u;
            path_end(result);
            stage = STAGE_BEGIN;
        }
    }
}

// Adds this thread's counts to `counters`, which the includer declares.
void path_tally(uint slot)
{
    atomicAdd(counters.steps, (path_count.collisions + 15u) / 16u);
    if (path_count.non_finite > 0u) {
        atomicAdd(counters.non_finite, path_count.non_finite);
    }
    if (path_count.cut > 0u) {
        atomicAdd(counters.cut, path_count.cut);
    }
    if (path_count.hits > 0u && slot == 0u) {
        atomicAdd(counters.pixels, 1u);
    }
}

#endif
