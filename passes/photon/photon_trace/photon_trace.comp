// photon_trace.comp -- photons of suns, lamps and the environment, and the cells that they pass.
//
// A beam of light goes on in steps of Woodcock tracking with the bricks' bounds sigma_T; at each point that it examines it leaves
// its power, times its transmittance as ratio tracking has it, over sigma_T. One of these points is drawn as the collision
// from which the photon goes on, with what the medium did not absorb (Elek et al. 2012, Sec 4.1). So a beam goes on beyond
// the collision, until next to nothing of it is left.
//
// Colour is as in path.glsl: directions and collisions are drawn for the hero.
//
// A turn of the loop is a brick that is crossed, or a point; threads of a subgroup so scatter and fly together.
#include "shaders/path/path_args.h"

const bool PROBE = false;
#include "shaders/path/path_resources.glsl"
#include "photon_trace_args.h"
#include "shaders/light/ordinate_args.h"
#include "../common/photon_args.h"
#include "shaders/lattice/lattice.glsl"

TYN_UPDATE(18, ring, photon_ring ring; int words[]);
TYN_UPDATE(19, counters, counters_block counters);
TYN_READ(20, plan, photon_trace_plan plan_in);
TYN_UPDATE(21, flux, int flux_words[]);
TYN_READ(22, ordinates, ordinates_block ordinates);

#include "shaders/path/path.glsl"
photon_trace_plan plan;

struct photon {
    path_state path;   // at the beginning of its flight
    vec3 power;        // W, of the photon when it was drawn
    vec3 sent;         // ... at the beginning of its flight
    vec3 passed;       // transmittance of the beam, by channel, up to `at`
    vec3 at;
    float distance, tau; // from the vertex, m; to the next point
    brick_walk walk;
    uint lobe;         // where it came from
    vec3 direct;       // what cells get of it before it has scattered
    float cosine;      // product of the mean cosines of all its scatterings
    bool similar;      // it scatters alike in all directions now
    bool collided;     // the vertex after this flight is known:
    vec3 vertex, beta, rho;
    phase next[3];
    float g;
};

#include "photon_trace_start.glsl"

lattice_box photon_box;

float most_of(vec3 v)
{
    return max(v.x, max(v.y, v.z));
}

// Rounded up or down by chance, so that deposits below a unit are right on average.
int whole(float value, uint bits)
{
    return int(floor(value + float(bits & 0xffffu) * (1.0 / 65536.0)));
}

void add_light(uint at, int value)
{
    if (value != 0) {
        atomicAdd(words[at], value);
    }
}

void add_flux(uint at, int value)
{
    if (value != 0) {
        atomicAdd(flux_words[at], value);
    }
}

// `weight`: of the place among those of its cell.
void deposit(const photon p, float weight, float bound, uint slot, uvec4 bits)
{
    vec3 light = p.sent * p.passed * (weight * plan.per_unit / bound);
    light *= p.path.depth == 0u ? p.direct : vec3(1.0);
    if (light == vec3(0.0)) {
        return;
    }
    if (any(isnan(light)) || any(isinf(light))) {
        path_count.non_finite++;
        return;
    }
    vec3 c = lattice_from_m(photon_box, wrap(p.at));
    ivec3 cell = clamp(ivec3(floor(c)), ivec3(0), photon_box.dims - 1);
    uint cells = plan.dims.x * plan.dims.y * plan.dims.z;
    uint at = ((slot * plan.lobes + p.lobe) * cells + lattice_index(photon_box, cell)) * 4u;
    float mean = channel_mean(light);
    vec3 flux = mean * p.path.way;
    add_light(at, whole(light.x, bits.x));
    add_light(at + 1u, whole(light.y, bits.x >> 16));
    add_light(at + 2u, whole(light.z, bits.y));
    add_light(at + PHOTON_ORDER, whole(mean * (float(p.path.depth) / PHOTON_ORDER_UNIT), bits.w));
    add_flux(at, whole(flux.x, bits.z));
    add_flux(at + 1u, whole(flux.y, bits.z >> 16));
    add_flux(at + 2u, whole(flux.z, bits.y >> 16));
    add_flux(at + PHOTON_COUNT, 1);
}

// Leaves a vertex along path.way. False: it leaves the media for good.
bool take_off(inout photon p, inout rng_state rng)
{
    p.collided = false;
    p.passed = vec3(1.0);
    p.sent = p.power * path_weight(p.path);
    vec2 span = brick_span(medium, p.path.vertex, p.path.way);
    span.y = min(span.y, p.path.end);
    p.distance = span.x;
    p.at = p.path.vertex + span.x * p.path.way;
    p.walk = brick_start(medium, p.at, p.path.way);
    p.tau = rng_exponential(rng_next(rng).x);
    return span.x < span.y;
}

float bound_of(const photon p)
{
    float bound = media_bounds(p.walk.cell).y;
    return max(bound * (p.similar ? plan.reduced : plan.scaled), plan.least);
}

// Of what scatters a part goes straight on: that of the medium drawn, so that it is right on average.
void scale_forward(inout media_point m)
{
    vec3 absorbs = max(m.sigma_t - m.sigma_s, 0.0), left = vec3(1.0);
    similarity_clamp(left, m.phase);
    left *= 1.0 - delta_fraction(m.phase);
    m.sigma_s *= left;
    m.part_s *= left;
    m.sigma_t = absorbs + m.sigma_s;
    m.phase = phase_of_mean_cosine(delta_cosine(m.phase));
}

// What similarity leaves of scattering into all directions alike, of that with mean cosine g.
float similar_share(float g)
{
    float share = 1.0 - max(g, 0.0);
    return plan.similarity == PHOTON_SIMILARITY_PRINTED ? sqrt(share) : share;
}

// Examines the point p.at: deposit, collision, what of the beam goes on. True: the flight is over.
bool examine(inout photon p, float bound, uint slot, inout rng_state rng)
{
    uvec4 bits = rng_next(rng), more = rng_next(rng);
    p.tau = rng_exponential(bits.x);
    media_point m = media_at(p.at, rng_float(bits.z), p.path.hero);
    if (plan.beams == 1u) {
        scale_forward(m);
    }
    float weight = plan.per_extinction > 0.0 ? plan.per_extinction * channel_mean(m.sigma_t) : 1.0;
    deposit(p, weight, bound, slot, more);
    if (p.similar) {
        vec3 g = phase_mean_cosine(m.phase);
        vec3 share = vec3(similar_share(g.x), similar_share(g.y), similar_share(g.z));
        vec3 absorbs = max(m.sigma_t - m.sigma_s, 0.0);
        m.sigma_s *= share;
        m.part_s *= share;
        m.sigma_t = absorbs + m.sigma_s;
        m.phase = phase_of_mean_cosine(vec3(0.0));
    }
    float sigma_t = GREY ? m.sigma_t.x : dot(m.sigma_t, p.path.hero);
    vec3 none = max(bound - m.sigma_t, 0.0);
    if (!p.collided) {
        if (rng_float(bits.y) * bound < sigma_t) {
            float part = 1.0;
            vec3 chosen = vec3(1.0);
            if (SHAPES != 1u) {
                part = dot(m.sigma_s, p.path.hero) / max(dot(m.part_s, p.path.hero), 1e-30);
                chosen = m.part_s / max(m.sigma_s, vec3(1e-30));
            }
            p.collided = true;
            p.vertex = p.at;
            p.beta = p.path.beta * m.part_s * (part / sigma_t);
            p.rho = GREY ? p.path.rho : p.path.rho * m.sigma_t * chosen * (part / sigma_t);
            p.next = m.phase;
            p.g = phase_mean_cosine(phase_select(m.phase, GREY ? vec3(1.0, 0.0, 0.0) : p.path.hero));
        } else if (!GREY) {
            float drawn = max(dot(none, p.path.hero), 1e-30);
            p.path.beta *= none / drawn;
            p.path.rho *= none / drawn;
        }
    }
    p.passed *= none / bound;
    float left = most_of(p.passed);
    bool silent = p.path.depth == 0u && p.direct == vec3(0.0); // nothing of it is left in cells
    if (plan.stop >= 1.0 || silent) { // the beam ends where the photon collides
        p.passed = vec3(p.collided ? 0.0 : 1.0);
    } else if (left < plan.stop) {
        bool stays = plan.roulette == 1u && rng_float(bits.w) * plan.stop < left;
        p.passed *= stays ? plan.stop / max(left, 1e-30) : 0.0;
    }
    return p.collided && !(most_of(p.passed) > 0.0);
}

// Goes on from the collision. False: nothing is left of it.
bool scatter(inout photon p, inout rng_state rng)
{
    uvec4 bits = rng_next(rng);
    p.path.depth++;
    p.path.vertex = p.vertex;
    p.path.beta = p.beta;
    p.path.rho = p.rho;
    phase drawn = p.next[0];
    if (!GREY) {
        drawn = phase_select(p.next, p.path.hero);
    }
    vec3 d = phase_direction(drawn, p.path.way, rng_vec2(bits.xy));
    if (!GREY) {
        vec3 forward = phase_between(p.next, p.path.way, d);
        float divide = 1.0 / max(dot(forward, p.path.hero), 1e-30);
        p.path.beta *= forward * divide;
        p.path.rho *= forward * divide;
    }
    p.path.way = d;
    p.cosine *= p.g;
    p.similar = p.similar || (plan.similarity != PHOTON_SIMILARITY_OFF && abs(p.cosine) < plan.threshold);
    float most = most_of(path_weight(p.path));
    bool left = most > 0.0;
    if (p.path.depth >= args.rr_depth && most < PATH_ROULETTE) {
        float survival = most / PATH_ROULETTE;
        left = left && rng_float(bits.z) < survival;
        p.path.beta /= max(survival, 1e-30);
    }
    return left && p.path.depth < args.max_depth;
}

// Meets a surface. False: nothing is left.
bool reflect_there(inout photon p, const surface_hit ahead, vec3 period, inout rng_state rng)
{
    uvec4 bits = rng_next(rng);
    surface_finding found = surface_find(ahead, period, p.path.way);
    p.path.depth++;
    p.path.beta *= found.albedo;
    p.path.way = cosine_sample(found.point.normal, rng_vec2(bits.xy));
    p.path.vertex = surface_offset(found.point, found.point.normal);
    p.cosine = 0.0;
    float most = most_of(path_weight(p.path));
    bool left = most > 0.0;
    if (p.path.depth >= args.rr_depth && most < PATH_ROULETTE) {
        float survival = most / PATH_ROULETTE;
        left = left && rng_float(bits.z) < survival;
        p.path.beta /= max(survival, 1e-30);
    }
    return left && p.path.depth < args.max_depth;
}

void main()
{
    path_load();
    plan = plan_in;
    photon_box = lattice_box_of(medium.extent, ivec3(plan.dims));
    // Neighbouring threads take neighbouring photons.
    uint begin = args.first + gl_WorkGroupID.x * PHOTON_TRACE_GROUP * PHOTON_TRACE_EACH + gl_LocalInvocationIndex;
    uint index = begin, end = min(begin + PHOTON_TRACE_GROUP * PHOTON_TRACE_EACH,
                                  min(args.first + args.num, ring.count * plan.photons));
    path_tint = vec3(1.0);
    float total = start_total();
    bool ended = true, flies = false;
    rng_state rng;
    photon p;
    surface_hit ahead = surface_hit(PATH_FAR, SURFACE_NONE, vec2(0.0));
    vec3 period = vec3(0.0);
    uint slot = 0u;
    while (total > 0.0 && path_turns < PATH_TURNS) {
        path_turns++;
        if (ended) {
            if (index >= end) {
                break;
            }
            uint generation = ring.first + index / plan.photons, number = index % plan.photons;
            index += PHOTON_TRACE_GROUP;
            slot = generation % plan.slots;
            rng = rng_start(number, generation, args.seed);
            start_photon(total, generation * plan.photons + number, rng, p);
            p.power /= float(plan.photons);
            p.cosine = 1.0;
            p.similar = false;
            ended = false;
            flies = false;
        }
        if (!flies) {
            p.path.end = PATH_FAR;
            if (SURFACES) {
                ahead = surface_hit(PATH_FAR, SURFACE_NONE, vec2(0.0));
                surface_trace(p.path.vertex, p.path.way, false, ahead, period);
                p.path.end = ahead.t;
            }
            flies = take_off(p, rng);
            if (!flies) { // past the media
                ended = !(SURFACES && p.path.end < PATH_FAR) || !reflect_there(p, ahead, period, rng);
                continue;
            }
        }
        float bound = bound_of(p);
        int axis;
        float face = min(brick_exit(medium, p.walk, p.at, axis), p.path.end - p.distance);
        if (p.tau < bound * face) {
            float moved = p.tau / bound;
            p.at += moved * p.path.way;
            p.distance += moved;
            path_count.collisions++;
            flies = !examine(p, bound, slot, rng);
        } else {
            p.tau -= bound * face;
            p.at += face * p.path.way;
            p.distance += face;
            flies = !(SURFACES && p.distance >= p.path.end) && brick_step(medium, p.walk, axis);
        }
        if (!flies) {
            if (p.collided) {
                ended = !scatter(p, rng);
            } else {
                ended = !(SURFACES && p.path.end < PATH_FAR) || !reflect_there(p, ahead, period, rng);
            }
        }
    }
    // Photons that this thread did not get to.
    if (!ended || index < end) {
        path_count.cut += (ended ? 0u : 1u) + (index < end ? (end - index + PHOTON_TRACE_GROUP - 1u) / PHOTON_TRACE_GROUP : 0u);
    }
    path_tally(0u);
}
