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
//  * Directions: the phase function times a guess of the radiance, by a field or about one light that the path keeps
//    (path_guide.glsl).
//  * Lamps: next-event estimation at collisions, and along each stretch equi-angular distances (Kulla and
//    Fajardo, "Importance sampling techniques for path tracing in participating media", 2012). Each distance
//    t gets weights of both that add up to 1; they need not be the true pdfs, so free flights in an unknown
//    medium are weighed as in a homogeneous one.
//  * Environment map: next-event estimation alone. Its direction is one of candidates from the map and from the phase
//    function, chosen by their product (path_guide.glsl).
//  * Thin media: the first flight is drawn as if the medium were args.stretch times as dense, with weights (Carter,
//    Cashwell and Taylor, "Monte Carlo sampling with continuously varying cross sections", 1972), or next to no path
//    would scatter; what is seen through the medium has its transmittance instead.
//  * Surfaces: a flight ends at the first one. Directions are drawn by the cosine; emitters by next-event
//    estimation (uniform over area, triangles by their power) and by directions, balance heuristic.
//
// A turn of the loop is a flight, and at its end a vertex with its shadow ray: threads of a subgroup fly
// together and scatter together, and one whose path has ended starts the next at once.
//
// The includer declares the resources of path_resources.glsl, and defines
//   bool path_next(inout uint element, inout uint first, inout uint end)  -- the next samples; false: there are no more
//   void path_begin(inout rng_state, vec2 random, out vec3 origin, out vec3 direction)  -- the next path
//   float path_begin_pdf(vec3 direction)  -- probes: 1/sr of the first directions of the path just begun
//   void path_direct(vec3 direction, vec3 irradiance)  -- probes: uncollided lamps and emitters at the point itself
//   void path_end(const path_result)                       -- the path's contribution
//   PATH_FIELDS, where paths may end in a field and be guided by one, and
//     vec3 path_field(vec3 at, vec3 way, const media_point m)  -- what scatters there against the path's way of light that has
//       scattered before, W/(m^2 sr)
//     path_guide path_guide_at(vec3 at, vec3 way, float g)  -- the guide there
#ifndef TYN_PATH_GLSL
#define TYN_PATH_GLSL
#ifndef PATH_ENDS_AT_FIRST_SURFACE
#define PATH_ENDS_AT_FIRST_SURFACE false // only what the surface emits counts then
#endif
#include "shaders/light/env_sampling.glsl"
#include "path_lights.glsl"
#include "path_media.glsl"
#include "path_guide.glsl"
#include "shaders/random/rng.glsl"
#include "path_surfaces.glsl"

const bool THIN = (FLAGS & TYN_PATH_THIN) != 0u;

struct path_result {
    vec3 radiance;      // scattered and emitted by the media
    vec3 single;        // its part of first order
    vec3 background;    // the environment and emitters, seen through the media
    vec3 reflected;     // what the first surface reflects, seen through the media
    vec3 transmittance; // to the first surface; mean 1 in vacuum: an unbiased estimate for each channel
    bool hit;           // met the domain of the media
    bool solid;         // met a surface first
};

struct path_counts { // of this thread
    uint collisions, non_finite, cut, hits;
};
path_counts path_count = path_counts(0u, 0u, 0u, 0u);
// Turns of this thread's loops, at most: one that no thread enters counts as well. A thread that has made PATH_TURNS
// leaves the rest to others: on lavapipe eight that run together share a limit of 65535
// (docs/writing-a-pass.md, "Shaders"), and their turns add up where they differ.
uint path_turns = 0u;
const uint PATH_TURNS = (FLAGS & TYN_PATH_SHORT_LOOPS) != 0u ? 6000u : 0xffffffffu;

bool path_next(inout uint element, inout uint first, inout uint end);
void path_begin(inout rng_state rng, vec2 random, out vec3 origin, out vec3 direction);
float path_begin_pdf(vec3 direction);
void path_direct(vec3 direction, vec3 irradiance);
void path_end(const path_result result);
#ifdef PATH_FIELDS
vec3 path_field(vec3 at, vec3 way, const media_point m);
path_guide path_guide_at(vec3 at, vec3 way, float g);
#endif

const float PATH_ROULETTE = 0.1; // paths, and transmittance, below this weight are played for
const float PATH_FAR = 1e30;
const uint PATH_MAP_CANDIDATES = 4u; // directions from the map, and as many from what scatters

// The stretch of a ray seen from a lamp: distances along the ray and the angles that they span.
struct lamp_view {
    vec2 span;
    float closest, height, angle0, angle1;
};

lamp_view lamp_see(vec3 lamp, vec3 origin, vec3 direction, vec2 span)
{
    lamp_view v;
    v.closest = dot(lamp - origin, direction);
    // Along a repeated axis the rest of an endless ray is left to free flights.
    v.span = vec2(span.x, min(span.y, max(v.closest, span.x) + 1e3 * length(medium.extent)));
    // Any height gives an unbiased sampler. A ray through a lamp beyond its ends gets one that leaves the
    // two angles apart in floats.
    float beyond = max(v.span.x - v.closest, v.closest - v.span.y);
    v.height = max(length(lamp - origin - v.closest * direction), max(1e-6 * length(medium.extent), 1e-3 * beyond));
    v.angle0 = atan((v.span.x - v.closest) / v.height);
    v.angle1 = max(atan((v.span.y - v.closest) / v.height), v.angle0 + 1e-7);
    return v;
}

float lamp_pdf(const lamp_view v, float t)
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
        light_block light = light_get(i);
        if (light.kind == TYN_LIGHT_KIND_DIRECTIONAL) {
            continue;
        }
        vec3 to = light.position - origin;
        float height = length(to - max(dot(to, direction), 0.0) * direction);
        float weight = max3(light.color) / max(height, 1e-6 * length(medium.extent));
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

// A path as its flights change it.
struct path_state {
    vec3 vertex, way;   // where it is, and where it goes on to
    vec3 beta, rho;     // see above
    vec3 hero;          // 1 in the hero channel
    float kept;         // of its power: what was neither absorbed nor lost in roulette
    uint depth, steps;  // scatterings and reflections; effort
    float end;          // distance to the surface ahead, m
};

// The media ahead, up to the next surface.
vec2 path_span(const path_state path)
{
    vec2 span = media_span(path.vertex, path.way);
    return SURFACES ? vec2(span.x, min(span.y, path.end)) : span;
}

// Light of one order: 0 is seen straight from its source.
void path_add(inout path_result result, vec3 light, uint depth)
{
    if (depth == 0u) {
        result.background += light;
    } else if (result.solid) {
        result.reflected += light;
    } else {
        result.radiance += light;
        result.single += depth == 1u ? light : vec3(0.0);
    }
}

vec3 path_weight(const path_state path)
{
    return GREY ? path.beta : path.beta / channel_mean(path.rho);
}

// The phase function of the channel that directions are drawn for.
phase path_phase(const path_state path, const media_point m)
{
    if (GREY) {
        return m.phase[0];
    }
    return phase_select(m.phase, path.hero);
}

// Extinction of each channel over the largest, where coefficients are one constant times density.
vec3 path_tint;

// Transmittance from `origin` to `distance`, an unbiased estimate for each channel.
vec3 path_transmittance(vec3 origin, vec3 direction, float distance, inout rng_state rng, inout uint steps)
{
    vec2 span = media_span(origin, direction);
    float left = min(span.y, distance) - span.x;
    if (!(left > 0.0)) {
        return vec3(1.0);
    }
    if (HOMOGENEOUS) {
        return exp(-grey(path_shapes[0].sigma_s + path_shapes[0].sigma_a) * left);
    }
    vec3 passed = vec3(1.0), at = origin + span.x * direction;
    brick_walk walk = brick_start(medium, at, direction);
    vec2 bounds = media_bounds(walk.cell);
    float tau = rng_exponential(rng_next(rng).x);
    while (steps < args.max_steps) {
        // Bricks without a collision. The least extinction is taken out analytically, the rest is tracked.
        int axis;
        float face = brick_exit(medium, walk, at, axis), ahead = min(face, left);
        float tracked = bounds.y - bounds.x;
        while (tau >= tracked * ahead && steps < args.max_steps) {
            steps++;
            tau -= tracked * ahead;
            at += ahead * direction;
            left -= ahead;
            passed *= exp(-bounds.x * ahead * path_tint);
            if (left <= 0.0 || !brick_step(medium, walk, axis)) {
                left = 0.0;
                break;
            }
            bounds = media_bounds(walk.cell);
            tracked = bounds.y - bounds.x;
            face = brick_exit(medium, walk, at, axis);
            ahead = min(face, left);
        }
        if (left <= 0.0) {
            break;
        }
        steps++;
        path_count.collisions++;
        uvec4 bits = rng_next(rng);
        float moved = tau / tracked;
        tau = rng_exponential(bits.x);
        at += moved * direction;
        left -= moved;
        passed *= exp(-bounds.x * moved * path_tint);
        vec3 more = media_at(at, 0.0, vec3(0.0)).sigma_t - bounds.x * path_tint;
        passed *= clamp(1.0 - more / tracked, 0.0, 1.0);
        float most = max3(passed);
        if (most < PATH_ROULETTE) {
            float survival = most / PATH_ROULETTE;
            if (rng_float(bits.y) >= survival) {
                passed = vec3(0.0);
                break;
            }
            passed /= survival;
        }
    }
    // Not followed to the end: the safety cap, or a device that ends long loops by itself.
    if (left > 0.0 && max3(passed) > 0.0) {
        steps = args.max_steps;
        passed = vec3(0.0);
    }
    return passed;
}

// What a flight found.
struct path_flight {
    bool collided;
    float distance; // from the vertex, m
    vec3 at;
    media_point m;
    vec3 glow;      // emission on the way, already weighed by the path
    float spare;    // a random number nobody has used
};

// Emission on the next `moved` metres: track-length estimator, at one point of them.
void path_glow(inout path_flight f, const path_state path, float moved, inout rng_state rng)
{
    vec3 somewhere = f.at + moved * rng_float(rng_next(rng).x) * path.way;
    f.glow += path_weight(path) * media_at(somewhere, 0.0, path.hero).emission * moved;
}

// Flies on from the vertex to the next real collision, or to the end of the way or out of the media.
path_flight path_fly(inout path_state path, inout rng_state rng, inout bool hit)
{
    path_flight f;
    f.collided = false;
    f.distance = 0.0;
    f.at = path.vertex;
    f.glow = vec3(0.0);
    uvec4 bits = rng_next(rng);
    float tau = rng_exponential(bits.x);
    f.spare = rng_float(bits.y);
    vec2 span = path_span(path);
    if (span.x >= span.y) {
        return f;
    }
    hit = true;
    bool stretched = THIN && path.depth == 0u;
    float stretch = stretched ? args.stretch : 1.0;
    if (HOMOGENEOUS) {
        // Distances from the hero's own exponential: a pdf for every channel, and no null collisions.
        f.m = media_at(path.vertex, 0.0, path.hero);
        float sigma_t = GREY ? f.m.sigma_t.x : dot(f.m.sigma_t, path.hero), left = span.y - span.x;
        sigma_t *= stretch;
        f.collided = tau < sigma_t * left;
        float moved = f.collided ? tau / sigma_t : left;
        path.steps++;
        path_count.collisions += f.collided ? 1u : 0u;
        f.distance = span.x + moved;
        f.at = path.vertex + f.distance * path.way;
        if ((FLAGS & TYN_PATH_EMISSIVE) != 0u) {
            // Of the whole stretch, with each channel's own attenuation: `moved` follows the hero's.
            vec3 depth = f.m.sigma_t * left;
            vec3 reach = mix((1.0 - exp(-depth)) / max(f.m.sigma_t, vec3(1e-30)),
                             left * (1.0 - 0.5 * depth), lessThan(depth, vec3(1e-3)));
            f.glow = path_weight(path) * f.m.emission * reach;
        }
        if (!GREY || stretched) {
            path.beta *= exp((sigma_t - f.m.sigma_t) * moved) / (f.collided ? stretch : 1.0);
        }
        if (!GREY) {
            path.rho *= exp((sigma_t - stretch * f.m.sigma_t) * moved);
        }
        return f;
    }
    // A stretched flight leaves as much for null collisions as for others, or their weights would be large.
    float room = stretched ? 2.0 * stretch : 1.0;
    f.at += span.x * path.way;
    f.distance = span.x;
    brick_walk walk = brick_start(medium, f.at, path.way);
    float bound = room * media_bounds(walk.cell).y;
    bool inside = true;
    while (path.steps < args.max_steps) {
        // Bricks without a collision.
        int axis;
        float ahead = brick_exit(medium, walk, f.at, axis);
        ahead = SURFACES ? min(ahead, path.end - f.distance) : ahead;
        while (tau >= bound * ahead && path.steps < args.max_steps) {
            path.steps++;
            if ((FLAGS & TYN_PATH_EMISSIVE) != 0u) {
                path_glow(f, path, ahead, rng);
            }
            tau -= bound * ahead;
            f.at += ahead * path.way;
            f.distance += ahead;
            inside = !(SURFACES && f.distance >= path.end) && brick_step(medium, walk, axis);
            if (!inside) {
                break;
            }
            bound = room * media_bounds(walk.cell).y;
            ahead = brick_exit(medium, walk, f.at, axis);
            ahead = SURFACES ? min(ahead, path.end - f.distance) : ahead;
        }
        if (!inside) {
            break;
        }
        path.steps++;
        path_count.collisions++;
        float moved = tau / bound;
        if ((FLAGS & TYN_PATH_EMISSIVE) != 0u) {
            path_glow(f, path, moved, rng);
        }
        bits = rng_next(rng);
        tau = rng_exponential(bits.x);
        f.at += moved * path.way;
        f.distance += moved;
        f.m = media_at(f.at, rng_float(bits.z), path.hero);
        float sigma_t = GREY ? f.m.sigma_t.x : dot(f.m.sigma_t, path.hero);
        if (rng_float(bits.y) * bound < stretch * sigma_t) {
            f.collided = true;
            path.beta /= stretch;
            break;
        }
        if (!GREY || stretched) {
            // A null collision: the path goes straight on, its colour does not.
            vec3 none = max(bound - stretch * f.m.sigma_t, 0.0);
            float drawn = max(GREY ? none.x : dot(none, path.hero), 1e-30);
            path.beta *= (stretched ? bound - f.m.sigma_t : none) / drawn;
            path.rho *= GREY ? vec3(1.0) : none / drawn;
        }
    }
    if (!f.collided && inside) { // as there
        path.steps = args.max_steps;
    }
    return f;
}

// The light that a lamp sends to the stretch ahead of the vertex and from there back to it, by an
// equi-angular distance.
vec3 path_lamp(inout path_state path, inout rng_state rng)
{
    vec2 span = path_span(path);
    uvec4 bits = rng_next(rng);
    float probability;
    uint lamp = lamp_choose(path.vertex, path.way, rng_float(bits.x), probability);
    if (span.x >= span.y || lamp == args.num_lights) {
        return vec3(0.0);
    }
    lamp_view v = lamp_see(light_get(lamp).position, path.vertex, path.way, span);
    float angle = mix(v.angle0, v.angle1, rng_float(bits.y));
    float distance = clamp(v.closest + v.height * tan(angle), v.span.x, v.span.y);
    float pdf = lamp_pdf(v, distance);
    vec3 at = path.vertex + distance * path.way;
    media_point m = media_at(at, rng_float(bits.z), vec3(1.0 / 3.0));
    if (!(max3(m.part_s) > 0.0) || !(pdf > 0.0)) {
        return vec3(0.0);
    }
    light_sample light = light_towards(lamp, at, rng);
    if (surface_hides(at, light.direction, light.distance, SURFACE_NONE)) {
        return vec3(0.0);
    }
    vec3 sent = path_weight(path) * m.part_s * phase_between(m.phase, path.way, light.direction) * light.arriving;
    sent *= channel_mean(m.sigma_s) / channel_mean(m.part_s) * (1.0 - flight_weight(pdf, distance)) /
            (pdf * probability);
    sent *= path_transmittance(path.vertex, path.way, distance, rng, path.steps);
    return sent * path_transmittance(at, light.direction, light.distance, rng, path.steps);
}

// Towards one light, by which the path is guided where there is no field: a direction (w 0) or a position (w 1); none: w -1.
vec4 path_keep_light(inout rng_state rng, float u)
{
    if ((FLAGS & TYN_PATH_GUIDED) == 0u || (FLAGS & TYN_PATH_FIELD) != 0u) {
        return vec4(0.0, 0.0, 0.0, -1.0);
    }
    if (LIGHTS == 0u && EMITTERS && ENVIRONMENT != TYN_PATH_ENV_MAP) {
        return vec4(path_emitters.xyz, 1.0);
    }
    if (LIGHTS == 1u && ENVIRONMENT != TYN_PATH_ENV_MAP) {
        bool distant = (FLAGS & TYN_PATH_LAMPS) == 0u || path_light0.kind == TYN_LIGHT_KIND_DIRECTIONAL;
        return distant ? vec4(-path_light0.direction, 0.0) : vec4(path_light0.position, 1.0);
    }
    // Any axis that does not depend on the path is unbiased.
    light_choice choice = light_choose(0.5 * medium.extent, u, LIGHT_MAP);
    if (LIGHTS > 0u && choice.index < args.num_lights) {
        light_block light = light_get(choice.index);
        bool distant = light.kind == TYN_LIGHT_KIND_DIRECTIONAL;
        return distant ? vec4(-light.direction, 0.0) : vec4(light.position, 1.0);
    }
    float pdf = 0.0;
    return ENVIRONMENT == TYN_PATH_ENV_MAP ? vec4(env_sample(env, rng_next(rng), pdf), 0.0)
                                           : vec4(0.0, 0.0, 0.0, -1.0);
}

bool path_direct_light = false; // path_direct is given light of a sun or a lamp

// Probes: the light of lamps, suns and emitters at the first point of a path, and how likely emitters were drawn.
float path_meet_lights(inout path_state path, inout rng_state rng)
{
    light_choice choice = light_choose(path.vertex, rng_float(rng_next(rng).x), LIGHT_EMITTERS);
    if (!(choice.probability > 0.0)) {
        return 0.0;
    }
    light_sample light;
    uint target = SURFACE_NONE;
    if (EMITTERS && choice.index > args.num_lights) {
        emitter_sample from = emitter_draw(path.vertex, rng);
        float pdf = from.pdf * choice.probability + path_begin_pdf(from.direction);
        target = from.triangle;
        light = light_sample(from.direction, from.distance,
                             from.pdf > 0.0 ? from.radiance * choice.probability / pdf : vec3(0.0));
    } else {
        light = light_towards(choice.index, path.vertex, rng);
    }
    path_direct_light = target == SURFACE_NONE;
    if (max3(light.arriving) > 0.0 && !surface_hides(path.vertex, light.direction, light.distance, target)) {
        vec3 passed = path_transmittance(path.vertex, light.direction, light.distance, rng, path.steps);
        path_direct(light.direction, light.arriving * passed / choice.probability);
    }
    return choice.emitters;
}

// What a path that leaves the media sees, with its weight. Once it has scattered, a map is looked for at its vertices.
void path_leave(inout path_result result, const path_state path, vec3 weight)
{
    if (path.depth == 0u) {
        result.transmittance = weight;
    }
    if (ENVIRONMENT == TYN_PATH_ENV_CONSTANT) {
        path_add(result, weight * env.radiance, path.depth);
    } else if (ENVIRONMENT == TYN_PATH_ENV_MAP && path.depth == 0u) {
        path_add(result, weight * environment_radiance(env, env_map_wrapped, path.way), 0u);
    }
}

// What goes on in `direction`, of light that arrives there: the phase function of each channel, or a surface's cosine; 1/sr.
vec3 path_scatters(const path_state path, const media_point m, bool at_surface, vec3 normal, vec3 direction)
{
    if (at_surface) {
        return vec3(max(dot(direction, normal), 0.0) * (1.0 / HG_PI));
    }
    return phase_between(m.phase, path.way, direction);
}

// The map's light in `direction` as the vertex scatters it, over the direction's pdf.
vec3 path_map(const path_state path, const media_point m, bool at_surface, vec3 normal, inout rng_state rng, out vec3 direction)
{
    vec3 light = vec3(0.0);
    float total = 0.0, there = 0.0, u = rng_float(rng_next(rng).x);
    direction = vec3(0.0, 0.0, 1.0);
    [[unroll]] for (uint i = 0u; i < 2u * PATH_MAP_CANDIDATES; i++) {
        uvec4 bits = rng_next(rng);
        vec3 d;
        float drawn;
        if (i < PATH_MAP_CANDIDATES) {
            d = env_sample(env, bits, drawn);
        } else {
            d = at_surface ? cosine_sample(normal, rng_vec2(bits.xy))
                           : phase_direction(path_phase(path, m), path.way, rng_vec2(bits.xy));
            drawn = env_pdf(env, d);
        }
        vec3 forward = path_scatters(path, m, at_surface, normal, d);
        drawn = float(PATH_MAP_CANDIDATES) * (drawn + (GREY ? forward.x : dot(forward, path.hero)));
        vec3 product = forward * environment_radiance(env, env_map_wrapped, d);
        float weight = channel_mean(product);
        if (guide_takes(weight / max(drawn, 1e-37), total, u)) {
            direction = d;
            light = product;
            there = weight;
        }
    }
    return there > 0.0 ? light * (total / there) : vec3(0.0);
}

// What guides the path where it scatters; false: nothing.
bool path_guide_of(const path_state path, const path_flight f, vec4 kept_light, out path_guide guide)
{
    // The same for all heroes: heuristics over emitters' directions add up to 1 over all of them.
    float g = channel_mean(phase_mean_cosine(f.m.phase));
#ifdef PATH_FIELDS
    if ((FLAGS & TYN_PATH_FIELD) != 0u) {
        guide = path_guide_at(f.at, path.way, g);
        return true;
    }
#endif
    if ((FLAGS & TYN_PATH_GUIDED) == 0u || kept_light.w < 0.0) {
        return false;
    }
    vec3 toward = kept_light.xyz;
    if ((FLAGS & (TYN_PATH_LAMPS | TYN_PATH_EMITTERS)) != 0u && kept_light.w > 0.0) {
        toward -= f.at;
        toward *= inversesqrt(max(dot(toward, toward), 1e-30));
    }
    guide = guide_towards(toward, path.depth - 1u, path.way, g);
    return true;
}

// Follows samples [index, end) of one pixel or point, and what path_next gives after them.
void path_run(uint element, uint index, uint end)
{
    path_tint = GREY ? vec3(1.0) : (medium.sigma_s + medium.sigma_a) / max(medium.sigma_t_max, 1e-30);

    bool ended = true;
    rng_state rng;
    path_state path;
    path.steps = 0u;
    path_result result;
    vec4 kept_light;      // path_keep_light
    float pdf_way;        // of the path's way, 1/sr
    float draw_emitters;  // probability with which these were drawn at the vertex

    for (;;) {
        if (ended) {
            path_turns += path.steps * (SHAPES != 0u ? 2u : 2u + medium.num_shapes);
            path.steps = 0u;
            if (index >= end && !path_next(element, index, end)) {
                break;
            }
            ended = false;
            rng = rng_start(element, index++, args.seed);
            result = path_result(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), false, false);
            path.beta = vec3(1.0);
            path.rho = vec3(1.0);
            path.hero = vec3(1.0, 0.0, 0.0);
            path.kept = 1.0;
            path.depth = 0u;
            path.end = PATH_FAR;
            pdf_way = 1.0;
            draw_emitters = 0.0;
            uvec4 bits = rng_next(rng);
            if (!GREY) {
                float u = 3.0 * rng_float(bits.z);
                path.hero = vec3(u < 1.0, u >= 1.0 && u < 2.0, u >= 2.0);
            }
            kept_light = path_keep_light(rng, rng_float(bits.w));
            path_begin(rng, rng_vec2(bits.xy), path.vertex, path.way);
            if (PROBE && (LIGHTS > 0u || EMITTERS) && (FLAGS & TYN_PATH_SCATTERED) == 0u) {
                draw_emitters = path_meet_lights(path, rng);
                pdf_way = path_begin_pdf(path.way);
            }
        }

        path_turns += LIGHTS < 2u ? 8u : 8u + 3u * args.num_lights; // all are asked, for a lamp and, twice, for a light
        surface_hit ahead = surface_hit(PATH_FAR, SURFACE_NONE, vec2(0.0));
        vec3 period = vec3(0.0);
        if (SURFACES) {
            path.steps++;
            surface_trace(path.vertex, path.way, false, ahead, period);
            path.end = ahead.t;
        }

        if ((FLAGS & TYN_PATH_EQUIANGULAR) != 0u && path.depth < args.max_depth) {
            path_add(result, path_lamp(path, rng), path.depth + 1u);
        }

        // What a stretched flight does not say.
        vec3 through = vec3(1.0);
        bool ends_thin = THIN && path.depth == 0u;
        if (ends_thin) {
            through = path_transmittance(path.vertex, path.way, PATH_FAR, rng, path.steps);
        }
        path_flight f = path_fly(path, rng, result.hit);
        path_add(result, f.glow, path.depth + 2u); // of no single order

        bool at_surface = SURFACES && !f.collided && path.end < PATH_FAR;
        surface_finding found;
        if (at_surface && path.steps < args.max_steps) {
            found = surface_find(ahead, period, path.way);
            vec3 weight = path_weight(path);
            vec3 emitted = weight * found.emission;
            if (EMITTERS && draw_emitters > 0.0) {
                float slope = abs(dot(found.point.normal, path.way));
                float drawn = draw_emitters * found.density * path.end * path.end;
                emitted *= pdf_way * slope / max(pdf_way * slope + drawn, 1e-37);
            }
            path_add(result, emitted, path.depth);
            if (path.depth == 0u) {
                result.transmittance = weight;
                result.solid = true;
            }
        }

        if (ends_thin) {
            path_leave(result, path, through);
        }
        if (path.steps >= args.max_steps) {
            path_count.cut++;
            ended = true;
        } else if (ends_thin && !f.collided) {
            ended = true;
        } else if (!f.collided && !at_surface && !ends_thin) {
            path_leave(result, path, path_weight(path));
            ended = true;
        } else if (path.depth >= args.max_depth || (at_surface && path.depth == 0u && PATH_ENDS_AT_FIRST_SURFACE)) {
            ended = true;
        } else {
            path.depth++;
            bool guided = false;
            path_guide guide;
            if (at_surface) {
                f.at = surface_offset(found.point, found.point.normal);
                path.beta *= found.albedo;
                path.kept *= max3(found.albedo);
            } else {
                // A real collision, drawn for the hero. With several media the path goes on in one of them.
                float sigma_t = GREY ? f.m.sigma_t.x : dot(f.m.sigma_t, path.hero);
                float part = 1.0;
                vec3 chosen = vec3(1.0);
                if (SHAPES != 1u) {
                    part = dot(f.m.sigma_s, path.hero) / max(dot(f.m.part_s, path.hero), 1e-30);
                    chosen = f.m.part_s / max(f.m.sigma_s, vec3(1e-30));
                }
                path.beta *= f.m.part_s * (part / sigma_t);
                path.kept *= dot(f.m.sigma_s, path.hero) / sigma_t;
                if (!GREY) {
                    path.rho *= f.m.sigma_t * chosen * (part / sigma_t);
                }
                guided = path_guide_of(path, f, kept_light, guide);
            }
            vec3 weight = path_weight(path);
            uvec4 bits = rng_next(rng);

            // Next-event estimation: `pending` is what the light sends here, `drawn` the pdf of its direction.
            light_choice choice = light_choose(f.at, rng_float(bits.x), LIGHT_MAP | LIGHT_EMITTERS);
            vec3 direction = vec3(0.0, 0.0, 1.0), pending = vec3(0.0);
            float distance = PATH_FAR, drawn = 0.0;
            uint target = SURFACE_NONE;
            if (choice.probability > 0.0) {
                if (LIGHTS > 0u && choice.index < args.num_lights) {
                    light_sample light = light_towards(choice.index, f.at, rng);
                    direction = light.direction;
                    distance = light.distance;
                    pending = weight * light.arriving / choice.probability;
                    if ((FLAGS & TYN_PATH_EQUIANGULAR) != 0u && distance < PATH_FAR && !at_surface) {
                        lamp_view v = lamp_see(light_get(choice.index).position, path.vertex, path.way,
                                               path_span(path));
                        pending *= flight_weight(lamp_pdf(v, f.distance), f.distance);
                    }
                } else if (EMITTERS && choice.index > args.num_lights) {
                    emitter_sample from = emitter_draw(f.at, rng);
                    direction = from.direction;
                    distance = from.distance;
                    target = from.triangle;
                    drawn = from.pdf * choice.probability;
                    pending = drawn > 0.0 ? weight * from.radiance : vec3(0.0);
                }
                vec3 scatters;
                if (ENVIRONMENT == TYN_PATH_ENV_MAP && choice.index == args.num_lights) {
                    scatters = path_map(path, f.m, at_surface, found.point.normal, rng, direction);
                    pending = weight / choice.probability;
                } else {
                    scatters = path_scatters(path, f.m, at_surface, found.point.normal, direction);
                }
                pending *= scatters;
                if (drawn > 0.0) {
                    float forward = channel_mean(scatters);
                    drawn += guided ? guide_pdf(guide, direction, forward) : forward;
                }
                pending *= drawn > 0.0 ? 1.0 / drawn : 1.0;
            }
            if (max3(pending) > 0.0 && !surface_hides(f.at, direction, distance, target)) {
                pending *= path_transmittance(f.at, direction, distance, rng, path.steps);
                path_add(result, pending, path.depth);
            }

#ifdef PATH_FIELDS
            // The last scattering: the flight that follows brings light straight from its source, the field all other.
            if ((FLAGS & TYN_PATH_ENDED) != 0u && path.depth >= args.max_depth && !at_surface) {
                path_add(result, weight * path_field(f.at, path.way, f.m), path.depth + 1u);
            }
#endif

            // The next direction.
            vec3 d;
            if (at_surface) {
                d = cosine_sample(found.point.normal, rng_vec2(bits.zw));
                pdf_way = max(dot(d, found.point.normal), 0.0) * (1.0 / HG_PI);
            } else {
                phase p = path_phase(path, f.m);
                float over_pdf = 1.0;
                if (guided) {
                    d = guide_direction(guide, p, path.way, rng, over_pdf);
                } else {
                    d = phase_direction(p, path.way, rng_vec2(bits.zw));
                }
                vec3 forward = phase_between(f.m.phase, path.way, d);
                float hero = max(GREY ? forward.x : dot(forward, path.hero), 1e-30);
                path.beta *= GREY ? vec3(over_pdf) : forward * (over_pdf / hero);
                path.rho *= GREY ? vec3(1.0) : forward / hero;
                pdf_way = guided ? guide_pdf(guide, d, channel_mean(forward)) : channel_mean(forward);
            }
            draw_emitters = choice.emitters;
            path.vertex = f.at;
            path.way = d;

            // A way that the phase function hardly takes has next to no weight, but may lead right into the light's own
            // narrow lobe: roulette by the weight would leave all of that to a few fireflies.
            float most = max3(path_weight(path));
            ended = !(most > 0.0);
            most = max(most, path.kept);
            if (path.depth >= args.rr_depth && most < PATH_ROULETTE) {
                float survival = most / PATH_ROULETTE;
                ended = f.spare >= survival;
                path.beta /= max(survival, 1e-30);
                path.kept /= max(survival, 1e-30);
            }
        }

        if (ended) {
            vec3 sum = result.radiance + result.background + result.reflected + result.single + result.transmittance;
            if (any(isnan(sum)) || any(isinf(sum))) {
                path_count.non_finite++;
                result = path_result(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), result.hit, result.solid);
            }
            path_count.hits += result.hit ? 1u : 0u;
            path_end(result);
        }
    }
    if (!ended || index < end) { // a device has ended the loop: these samples are missing
        path_count.cut++;
    }
}

// Adds this thread's counts to `counters`, which the includer declares; and how many pixels or points met media.
void path_tally(uint pixels)
{
    atomicAdd(counters.steps, (path_count.collisions + 15u) / 16u);
    if (path_count.non_finite > 0u) {
        atomicAdd(counters.non_finite, path_count.non_finite);
    }
    if (path_count.cut > 0u) {
        atomicAdd(counters.cut, path_count.cut);
    }
    if (pixels > 0u) {
        atomicAdd(counters.pixels, pixels);
    }
}

#endif
