// raymarch.glsl -- the light that reaches the eye along one ray.
//
//   L = int { e^-tau'(s) [sigma_s' J + emission]
//             + sigma_s sum_n E_n e^-tau_a(n) [K_tms e^-tau'(s) + K_lobe e^-tau(s)] } ds
//       + e^-tau L_behind + (e^-tau' - e^-tau) B
//
// tau is the true optical depth along the view ray, tau' the one in which forward scattering counts
// as not scattered (delta scaling), (n) are depths along sun or lamp n; E of a lamp is I / r^2. J
// is the light that has scattered out of the suns' forward peaks (texture inscatter), K_tms and
// K_lobe hold the first and all forward orders exactly (scatter_lut.glsl). B is the environment as
// forward scattering smears it (glow.glsl), of a uniform one its radiance: the lattice has it delta
// scaled, so that what went through or was scattered forward must add up to e^-tau', or a uniform
// surrounding would not look uniform.
//
// Every step takes the medium at its middle and integrates the attenuation exactly: int_0^ds e^(-sigma t)
// dt = ds (1 - e^-x) / x with x = sigma ds. Light is taken at the centroid of that weight.
//
// Include after camera, environment, medium, beam, radial, scatter_lut, lattice, lattice_walls and
// shadow. RAYMARCH_GREY: all channels of the medium are equal, so optical depths are scalars.
#include "raymarch_medium.glsl"
#include "raymarch_suns.glsl"

const int RAYMARCH_CHUNK = 32; // steps between two looks at the distance map: empty ones are cheap
const int RAYMARCH_LATER = 8; // steps near walls that are dealt with together
// Optical depth of a step (scaled, where that counts) above which it is shortened, and to what: light from outside
// fades within it as much as the view does.
// A step of depth x makes light that falls off as e^-x too dark by x^2 / 24: 4 % and 1 %.
const float RAYMARCH_DENSE = 1.0, RAYMARCH_SHORT = 0.5;
// Scaled depth behind args.stop, in every channel, of what hides all: 1e-3 e^-9 is half the last digit of 1.
const float RAYMARCH_GONE = 9.0;
// A last step that takes less than a hundredth of the light behind it, 1 / (1 + 99), tells no more of what is behind than
// one that takes as much. What is left out so is args.stop of it at most.
const float RAYMARCH_REST = 99.0;

struct march_result {
    vec3 radiance; // of the medium alone
    vec3 transmittance;
    vec3 scaled_transmittance; // e^-tau'
};

// tau - tau'
vec3 march_forward_depth(const march_result r)
{
    // e^-tau may be too small for a float where e^-tau' is not; in one medium the depths are in proportion.
    vec3 depth = log(max(r.scaled_transmittance, 1e-37) / max(r.transmittance, 1e-37));
    if (medium_mode == TYN_MEDIUM_DENSITY) {
        march_medium unit = march_medium_of(medium_of_density(1.0));
        depth = -log(max(r.scaled_transmittance, 1e-37)) *
                vec3((unit.extinction + unit.hidden - unit.scaled_extinction) / max(unit.scaled_extinction, 1e-30));
    }
    return depth;
}

// Is there a wall about p, so that the lattice must not be blended freely?
bool march_near_walls(vec3 p)
{
    if (raymarch_has(RAYMARCH_REPEAT)) {
        p = medium_wrap(p);
    }
    lattice_box box = lattice_box_of(medium.extent, textureSize(inscatter_tex, 0) - 2);
    return walls_near(walls_place_of(box, p));
}

// How long the step after one through `m` may be.
float march_next_step(const march_medium m)
{
    if (!raymarch_has(RAYMARCH_WALLS | RAYMARCH_SHADOWS)) {
        return args.step;
    }
    float by_depth = args.step_depth / max(spectrum_max(m.extinction), 1e-30);
    return march_any(m) ? clamp(by_depth, args.step, args.longest) : args.step;
}

// Light of the lattice at a point, as texture inscatter has it.
vec3 march_field_between_walls(vec3 p, uint room)
{
    if (raymarch_has(RAYMARCH_REPEAT)) {
        p = medium_wrap(p);
    }
    lattice_box box = lattice_box_of(medium.extent, textureSize(inscatter_tex, 0) - 2);
    return walls_fetch(inscatter_tex, box, walls_blend_in(box, walls_place_of(box, p), p, room), ivec3(1)).rgb;
}

const int MARCH_ROOM_STEPS = 8;

// The room (rooms.h) that a ray is in at the distance s from p, which it is in all the way from the eye: that of the nearest place
// before in a cell without walls. `start`: the eye is so far before p. TYN_ROOMS_ANY: unknown.
uint march_room(vec3 p, vec3 direction, float s, float start)
{
    lattice_box box = lattice_box_of(medium.extent, textureSize(inscatter_tex, 0) - 2);
    uint room = TYN_ROOMS_ANY;
    for (int k = 0; k < MARCH_ROOM_STEPS && s > -start && room == TYN_ROOMS_ANY; k++) {
        room = walls_room_told(box, p + s * direction, false);
        s -= 0.75 * box.dx;
    }
    return room;
}

// The same without walls about; uvw is its place in the texture.
vec3 march_field(vec3 p, vec3 uvw)
{
    if (raymarch_has(RAYMARCH_REPEAT)) {
        uvw = lattice_inscatter_uvw(medium.extent, textureSize(inscatter_tex, 0), medium_wrap(p));
    }
    return textureLod(inscatter_tex, uvw, 0.0).rgb;
}

vec3 march_tinted(vec3 J)
{
    return raymarch_has(RAYMARCH_ONE_CHANNEL) ? J.r * args.tint : J;
}

// Centroid of a step's weights, in steps.
float march_centroid(const march_medium m, float ds)
{
    return step_centroid((0.5 * ds) * spectrum_mean(m.extinction + (raymarch_has(RAYMARCH_KERNELS)
                                                                        ? m.scaled_extinction
                                                                        : m.extinction)));
}

#include "raymarch_lamps.glsl"
#include "raymarch_near.glsl"

// Moves `s` on to the next brick that is not empty, or to `end`.
float march_skip(vec3 origin, vec3 direction, vec3 inverse, float s, float end)
{
    float smallest = min(min(medium.brick_size.x, medium.brick_size.y), medium.brick_size.z);
    vec3 per_brick = 1.0 / medium.brick_size;
    ivec3 last = ivec3(medium.bricks) - 1;
    vec3 first = origin;
    while (s < end) {
        if (raymarch_has(RAYMARCH_REPEAT)) { // as seen from the period at hand
            vec3 p = first + s * direction;
            origin = first + (medium_wrap(p) - p);
        }
        ivec3 brick = clamp(ivec3((origin + s * direction) * per_brick), ivec3(0), last);
        float away = texelFetch(distance_tex, brick, 0).r - (raymarch_has(RAYMARCH_NOISE) ? 1.0 : 0.0);
        if (away < 0.5) {
            return s;
        }
        // All bricks less than `away` apart are empty.
        vec3 lo = (vec3(brick) + 1.0 - away) * medium.brick_size;
        vec3 hi = (vec3(brick) + away) * medium.brick_size;
        s = max(s, ray_box(origin, inverse, lo, hi).y);
        s += max(1e-4 * smallest, 1e-6 * s);
    }
    return end;
}

// Where a ray has been marched to, and what it has brought so far.
struct march_state {
    float s;    // distance, m
    float next; // longest next step, m
    spectrum through, through_scaled; // e^-tau, e^-tau'
    spectrum hidden;
    vec3 radiance; // of the medium alone
    vec3 before;   // that before the last step
    spectrum through_before; // through_scaled before it
    vec3 single;   // first-order part, where a layer wants it
    float half_distance; // where the mean transmittance falls to 1/2, or infinity
    uint steps;
    march_shadows shadow;
};

// `offset` in (0, 1] is the length of the first step in steps.
march_state march_start(float offset)
{
    march_state state;
    state.s = 0.0;
    state.next = offset * args.step;
    state.through = state.through_scaled = state.through_before = spectrum(1.0);
    state.hidden = spectrum(0.0);
    state.radiance = state.before = state.single = vec3(0.0);
    state.half_distance = TYN_INFINITY;
    state.steps = 0u;
    state.shadow = march_shadows(0u, 0u, 0u, 0u, 0u, 0.0, vec2(0.0));
    return state;
}

// What is constant along a ray. Texture coordinates are linear along it.
struct march_line {
    vec3 origin, direction;
    vec3 medium0, medium1; // of the medium
    vec3 field0, field1;   // of the lattice's light
    float inside; // light is not looked up beyond: a ray may end a little behind the surface it stands for
};

march_line march_line_of(vec3 origin, vec3 direction, float inside)
{
    ivec3 size = textureSize(inscatter_tex, 0);
    march_line line;
    line.origin = origin;
    line.direction = direction;
    line.medium0 = origin / medium.extent;
    line.medium1 = direction / medium.extent;
    line.field0 = lattice_inscatter_uvw(medium.extent, size, origin);
    // A difference of two places a metre apart is lost to rounding where a box is many kilometres wide.
    line.field1 = direction / (lattice_box_of(medium.extent, size - 2).dx * vec3(size));
    line.inside = inside;
    return line;
}

// Steps whose light is gathered after others, as some devices run what only few rays need for all.
struct march_waiting {
    float wall_at[RAYMARCH_LATER]; // near walls: where the lattice's light is looked up, m
    spectrum wall_weight[RAYMARCH_LATER];
    int walls, last_wall;       // how many; the last step's, or -1
    march_near_steps near_lamps; // near lamps as well
    bool last_near;             // the last step is
};

// Not arguments, as some compilers copy arrays that are.
march_waiting waiting;
march_sun ray_suns[TYN_BEAM_MAX_SUNS]; // as the ray sees them

bool march_has_room()
{
    return waiting.walls < RAYMARCH_LATER && waiting.near_lamps.count < MARCH_NEAR_STEPS;
}

// A step, and the integrals of e^-tau and e^-tau' over it, m.
struct march_step {
    float s, ds, at; // beginning, length and centroid, m
    spectrum weight, weight_scaled;
};

// Light of suns and lamps that the step scatters towards the eye.
vec3 march_beams(const march_lamps lamps, const march_medium unit, const march_medium m, vec3 origin, vec3 direction,
                 const march_step b, inout march_shadows shadow, inout vec3 single)
{
    vec3 light = vec3(0.0);
    // Selections, as a loop whose trip count is a constant 0 stays in the module (specialize.h).
    if (raymarch_num_suns > 0u) {
        for (uint n = 0u; n < raymarch_num_suns; n++) {
            float lit = 1.0;
            if (raymarch_has(RAYMARCH_SHADOWS)) {
                lit = march_lit_of(true, ray_suns[n].map, n, b.s, b.ds, shadow).metres / max(b.ds, 1e-30);
            }
            light += march_sunlight(ray_suns[n], unit, m, origin + b.at * direction, b.at, lit * b.weight,
                                    lit * b.weight_scaled, single);
        }
    }
    if (raymarch_num_lamps > 0u) {
        [[unroll]] for (uint n = 0u; n < march_lamps_kept; n++) {
            light += march_lamplight(ray_lamps[n], 4u + n, lamps, unit, m, b.s, b.ds, b.at, b.weight, b.weight_scaled,
                                     shadow, single);
        }
    }
    if (raymarch_num_lamps > MARCH_LAMPS_KEPT) {
        for (uint n = MARCH_LAMPS_KEPT; n < raymarch_num_lamps; n++) {
            light += march_lamplight(march_lamp_of(n, lamps), 4u + n, lamps, unit, m, b.s, b.ds, b.at, b.weight,
                                     b.weight_scaled, shadow, single);
        }
    }
    return light;
}

// Goes through the step of the length ds through m; `is`: false if there is none, and then ds is 0. All its light but
// that of suns and lamps.
march_step march_through(const march_medium m, float ds, bool is, const march_line line, vec2 near_lamps, inout march_state state)
{
    spectrum x = m.extinction * ds, x_scaled = m.scaled_extinction * ds;
    spectrum e = exp(-x), e_scaled = exp(-x_scaled);
    march_step step;
    step.s = state.s;
    step.ds = ds;
    step.at = state.s + ds * march_centroid(m, ds);
    step.weight = ds * state.through * mean_attenuation(x, e);
    step.weight_scaled = ds * state.through_scaled * mean_attenuation(x_scaled, e_scaled);
    state.before = is ? state.radiance : state.before;
    state.through_before = is ? state.through_scaled : state.through_before;
    if (raymarch_has(RAYMARCH_FIELD)) {
        float there = min(step.at, line.inside);
        vec3 p = line.origin + there * line.direction;
        vec3 uvw = line.field0 + there * line.field1;
        if (raymarch_has(RAYMARCH_NOISE)) {
            vec3 moved = march_noise(p);
            p += moved;
            uvw += moved / (lattice_box_of(medium.extent, textureSize(inscatter_tex, 0) - 2).dx *
                            vec3(textureSize(inscatter_tex, 0)));
        }
        vec3 J = march_tinted(march_field(p, uvw));
        vec3 light = (m.scaled_scattering * step.weight_scaled) * J;
        if (raymarch_has(RAYMARCH_WALLS)) {
            bool near = is && march_near_walls(p);
            waiting.last_wall = near ? waiting.walls : is ? -1 : waiting.last_wall;
            if (near) {
                waiting.wall_at[waiting.walls] = there;
                waiting.wall_weight[waiting.walls] = m.scaled_scattering * step.weight_scaled;
                waiting.walls++;
            }
            light = near ? vec3(0.0) : light;
        }
        state.radiance += light;
    }
    if (raymarch_has(RAYMARCH_EMISSION)) {
        state.radiance += m.emission * step.weight_scaled;
    }
    if (raymarch_num_near > 0u) {
        bool near = is && state.s < near_lamps.y && state.s + ds > near_lamps.x;
        waiting.last_near = is ? near : waiting.last_near;
        if (near) {
            waiting.near_lamps.at[waiting.near_lamps.count] = state.s;
            waiting.near_lamps.ds[waiting.near_lamps.count] = ds;
            waiting.near_lamps.weight[waiting.near_lamps.count] = step.weight;
            waiting.near_lamps.weight_scaled[waiting.near_lamps.count] = step.weight_scaled;
            waiting.near_lamps.count++;
        }
    }
    if (raymarch_has(RAYMARCH_DEPTH)) {
        float t0 = spectrum_mean(state.through * exp(-state.hidden));
        float t1 = spectrum_mean(state.through * e * exp(-state.hidden - m.hidden * ds));
        if (t0 > 0.5 && t1 <= 0.5) {
            state.half_distance = state.s + ds * log(2.0 * t0) / log(t0 / t1);
        }
    }
    state.through *= e;
    state.through_scaled *= e_scaled;
    state.hidden += m.hidden * ds;
    state.s += ds;
    state.next = is ? march_next_step(m) : state.next;
    return step;
}

// Marches on from where `state` is to the distance `end` from `origin`, which is inside the box. `start`: how far
// from the eye the origin is. The result is that of a ray that ends there; `state` can be marched farther.
march_result march_ray(inout march_state state, vec3 origin, vec3 direction, float end, float start)
{
    march_medium unit = march_medium_of(medium_of_density(1.0));
    if (raymarch_num_suns > 0u) {
        for (uint n = 0u; n < raymarch_num_suns; n++) {
            ray_suns[n] = march_sun_of(n, unit, origin, direction);
        }
    }
    float pixel = camera_pixel(camera).x;
    bool orthographic = camera.orthographic != 0u;
    march_lamps lamps = march_lamps(origin, direction, start, orthographic ? pixel : 0.0,
                                    orthographic ? 0.0 : pixel);
    if (raymarch_num_lamps > 0u) {
        [[unroll]] for (uint n = 0u; n < march_lamps_kept; n++) {
            ray_lamps[n] = march_lamp_of(n, lamps);
        }
    }
    march_near near = march_near_of(lamps, end);
    vec3 inverse = ray_inverse(direction);
    float inside = raymarch_has(RAYMARCH_WALLS | RAYMARCH_SHADOWS) ? max(end - 5e-4 * (start + end), 0.0) : end;
    march_line line = march_line_of(origin, direction, inside);
    state.shadow.across = orthographic ? vec2(pixel, 0.0) : pixel * vec2(start, 1.0);
    state.shadow.inside = max(min(inside, end - 0.5 * march_shadow_piece()), 0.0);
    while (state.s < end && spectrum_max(state.through_scaled) > args.stop) {
        float from = state.s;
        state.s = march_skip(origin, direction, inverse, from, end);
        state.shadow.known = state.s > from ? 0u : state.shadow.known;
        waiting.walls = waiting.near_lamps.count = 0;
        waiting.last_wall = -1;
        waiting.last_near = false;
        int i = 0;
        while (i < RAYMARCH_CHUNK && state.s < end && spectrum_max(state.through_scaled) > args.stop &&
               march_has_room()) {
            // Neighbouring rays look for their next step that is not empty together. The loop is tested at its top, and
            // what is used after it has a value before it: of rays that have left a loop tested at its end some devices
            // go on computing what is used behind it.
            march_medium m = march_medium_of(medium_of_density(0.0));
            march_step step = march_step(0.0, 0.0, 0.0, spectrum(0.0), spectrum(0.0));
            bool found = false;
            while (!found && i < RAYMARCH_CHUNK && state.s < end && spectrum_max(state.through_scaled) > args.stop &&
                   march_has_room()) {
                float ds = min(state.next, end - state.s);
                if (raymarch_num_lamps > 0u) {
                    ds = min(ds, march_lamp_step(lamps, state.s));
                }
                m = march_medium_at(unit, line.medium0 + (state.s + 0.5 * ds) * line.medium1);
                bool any = march_any(m);
                // Of the channels that are not gone: a dense one must not hold up the others.
                spectrum left = spectrum_above(state.through_scaled, args.stop);
                float most =
                    spectrum_max(left * (raymarch_has(RAYMARCH_KERNELS) ? m.scaled_extinction : m.extinction));
                bool dense = any && most * ds > RAYMARCH_DENSE, full = any && !dense;
                i++;
                state.steps++;
                state.shadow.known = any ? state.shadow.known : 0u;
                state.s += any ? 0.0 : ds;
                state.next = full ? state.next : dense ? RAYMARCH_SHORT / most : args.step;
                step.ds = full ? ds : 0.0;
                found = full;
            }
            if (found) {
                step = march_through(m, step.ds, true, line, near.span, state);
            }
            if (found && raymarch_num_suns + raymarch_num_lamps > 0u) {
                vec3 light =
                    march_beams(lamps, unit, m, origin, direction, step, state.shadow, state.single);
                state.radiance += light;
            }
        }
        uint room = TYN_ROOMS_ANY;
        if (raymarch_has(RAYMARCH_ROOMS) && waiting.walls > 0) {
            room = march_room(origin, direction, waiting.wall_at[0], start);
        }
        if (raymarch_has(RAYMARCH_WALLS)) {
            for (int i = 0; i < waiting.walls; i++) {
                vec3 J = march_tinted(march_field_between_walls(origin + waiting.wall_at[i] * direction, room));
                state.radiance += waiting.wall_weight[i] * J;
                state.before += i == waiting.last_wall ? vec3(0.0) : waiting.wall_weight[i] * J;
            }
        }
        if (raymarch_num_near > 0u) {
            vec3 last, light = march_near_light(near, lamps, unit, waiting.near_lamps, line.medium0, line.medium1,
                                                inside, state.single, last);
            state.radiance += light;
            state.before += waiting.last_near ? light - last : light;
        }
    }

    march_result result;
    result.radiance = state.radiance;
    spectrum through = state.through, through_scaled = state.through_scaled, hidden = state.hidden;
    float s = state.s;
    if (s < end && state.steps > 0u) {
        // Nearly opaque. What is behind may be a thousand times brighter, so its attenuation is followed
        // to the end; the light of the rest is as bright as a medium that goes on as in the last step.
        spectrum through_end = spectrum(0.0);
        if (raymarch_has(RAYMARCH_BEHIND)) {
            spectrum tau = spectrum(0.0), tau_scaled = spectrum(0.0);
            float step = 2.0 * args.step;
            while (s < end && spectrum_min(tau_scaled) < RAYMARCH_GONE) {
                s = march_skip(origin, direction, inverse, s, end);
                for (int i = 0; i < 8 && s < end; i++) {
                    float ds = min(step, end - s);
                    march_medium m = march_medium_at(unit, line.medium0 + (s + 0.5 * ds) * line.medium1);
                    tau += m.extinction * ds;
                    tau_scaled += m.scaled_extinction * ds;
                    hidden += m.hidden * ds;
                    s += ds;
                }
            }
            through *= exp(-tau);
            through_end = through_scaled * exp(-tau_scaled);
        }
        vec3 last = vec3(state.through_before - through_scaled), rest = vec3(through_scaled - through_end);
        result.radiance += (result.radiance - state.before) * min(rest / max(last, 1e-9), RAYMARCH_REST);
        through_scaled = through_end;
    }
    result.transmittance = vec3(through * exp(-hidden));
    result.scaled_transmittance = vec3(through_scaled);
    return result;
}
