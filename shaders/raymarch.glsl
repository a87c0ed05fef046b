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
#ifndef TYN_RAYMARCH_GLSL
#define TYN_RAYMARCH_GLSL

#ifdef RAYMARCH_GREY
#define spectrum float
#define spectrum_of(v) (v).r
float spectrum_above(float x, float least) // 1 or 0
{
    return step(least, x);
}
float spectrum_max(float x)
{
    return x;
}
float spectrum_min(float x)
{
    return x;
}
float spectrum_mean(float x)
{
    return x;
}
#else
#define spectrum vec3
#define spectrum_of(v) (v)
vec3 spectrum_above(vec3 x, float least)
{
    return step(least, x);
}
float spectrum_max(vec3 x)
{
    return max(max(x.r, x.g), x.b);
}
float spectrum_min(vec3 x)
{
    return min(min(x.r, x.g), x.b);
}
float spectrum_mean(vec3 x)
{
    return (x.r + x.g + x.b) * (1.0 / 3.0);
}
#endif

const int RAYMARCH_CHUNK = 32; // steps between two looks at the distance map: empty ones are cheap
const int RAYMARCH_LATER = 8; // steps near walls that are dealt with together
const float RAYMARCH_SHADOWS_ACROSS = 128.0; // looks at a shadow map along the box's longest side, and
const float RAYMARCH_SHADOW_HALVES = 8.0; // parts of which where it has an edge in between
const float RAYMARCH_CELLS_MOST = 8.0; // places of a step for which light_cells is asked
// Optical depth of a step (scaled, where that counts) above which it is shortened, and to what: light from outside
// fades within it as much as the view does.
const float RAYMARCH_DENSE = 1.0, RAYMARCH_SHORT = 0.5;
const float RAYMARCH_GONE = 9.0; // scaled depth behind args.stop, in every channel, of what hides all

bool raymarch_has(uint feature)
{
    return (raymarch_features & feature) != 0u;
}

// (1 - e^-x) / x with e = e^-x, x >= 0; the series where the difference would lose digits.
float mean_attenuation(float x, float e)
{
    return x > 0.03 ? (1.0 - e) / x : 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0)));
}

vec3 mean_attenuation(vec3 x, vec3 e)
{
    return vec3(mean_attenuation(x.r, e.r), mean_attenuation(x.g, e.g), mean_attenuation(x.b, e.b));
}

// Centroid of e^-x over a step, in steps: 1/x - 1/(e^x - 1) = 1/2 - x/12 + ..., within 0.002 up to x = 3.
float step_centroid(float x)
{
    x = min(x, 3.0);
    return 0.5 - x * (1.0 / 12.0 - x * x * (1.0 / 900.0));
}

// The medium at one point, delta scaled.
struct march_medium {
    spectrum scattering;        // sigma_s
    spectrum extinction;        // sigma_t
    spectrum scaled_scattering; // sigma_s' = (1 - f) sigma_s
    spectrum scaled_extinction; // sigma_t' = sigma_t - f sigma_s
    spectrum absorption;
    spectrum hidden; // scattering into lobes too narrow to resolve: only what is behind loses it
    spectrum g;
    vec3 emission;
};

march_medium march_medium_of(medium_point point)
{
    vec3 sigma_s = point.sigma_s, g = point.g;
    bool scaled = !raymarch_has(RAYMARCH_UNSCALED);
    if (scaled) {
        similarity_clamp(sigma_s, g);
    }
    march_medium m;
    m.g = spectrum_of(g);
    m.scattering = spectrum_of(sigma_s);
    m.absorption = spectrum_of(point.sigma_a);
    m.hidden = spectrum_of(point.sigma_s) - m.scattering;
    m.extinction = m.scattering + m.absorption;
    m.scaled_scattering = m.scattering;
    if (scaled) {
        m.scaled_scattering *= 1.0 - delta_fraction(m.g);
    }
    m.scaled_extinction = m.scaled_scattering + m.absorption;
    m.emission = point.emission;
    return m;
}

march_medium march_scale(march_medium unit, float density)
{
    return march_medium(unit.scattering * density, unit.extinction * density,
                        unit.scaled_scattering * density, unit.scaled_extinction * density,
                        unit.absorption * density, unit.hidden * density, unit.g,
                        unit.emission * density);
}

// At a texture coordinate; `unit` is the medium at texture value 1 (mode DENSITY).
march_medium march_medium_at(march_medium unit, vec3 uvw)
{
    if (raymarch_has(RAYMARCH_REPEAT)) {
        uvw -= vec3(medium.repeat) * floor(uvw);
    }
#ifndef RAYMARCH_GREY
    if (medium_mode == TYN_MEDIUM_COEFFICIENTS) {
        vec3 emission = vec3(0.0);
        if (raymarch_has(RAYMARCH_EMISSION)) {
            emission = textureLod(medium_emission_tex, uvw, 0.0).rgb;
        }
        return march_medium_of(medium_point(textureLod(medium_density_tex, uvw, 0.0).rgb,
                                            textureLod(medium_sigma_a_tex, uvw, 0.0).rgb,
                                            textureLod(medium_g_tex, uvw, 0.0).rgb, emission));
    }
#endif
    return march_scale(unit, max(textureLod(medium_density_tex, uvw, 0.0).r, 0.0));
}

// Is there anything that absorbs, scatters or emits?
bool march_any(march_medium m)
{
    float most = spectrum_max(m.extinction) + spectrum_max(m.hidden);
    if (raymarch_has(RAYMARCH_EMISSION)) {
        most += m.emission.r + m.emission.g + m.emission.b;
    }
    return most > 0.0;
}

// What stands before a light, as a view ray sees it. Read once a ray, as some devices read buffers slowly.
struct march_map {
    shadow_light map;
    vec3 from, along; // the ray in the light's frame: what moves along it moves evenly there
};

march_map march_map_of(uint light, vec3 origin, vec3 direction)
{
    march_map m;
    if (raymarch_has(RAYMARCH_SHADOWS)) {
        m.map = shadows[light];
        m.from = shadow_frame(m.map, origin);
        m.along = shadow_frame_direction(m.map, direction);
    }
    return m;
}

// A sun as one view ray sees it: its grid's coordinates are linear along the ray.
struct march_sun {
    beam_ray beam;
    march_map map;
    uint grid; // number of its grid
    vec3 irradiance; // W/m^2
    float mean_cosine;
#ifdef RAYMARCH_GREY
    scatter_angle angle;
    float phase; // of one scattering; mode DENSITY, as `angle`
#else
    scatter_angle angle[3];
    vec3 phase;
    uint light;
    float one_minus_mu;
#endif
};

struct march_result {
    vec3 radiance; // of the medium alone
    vec3 transmittance;
    vec3 scaled_transmittance; // e^-tau'
};

// tau - tau'
vec3 march_forward_depth(march_result r)
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

march_sun march_sun_of(uint n, march_medium unit, vec3 origin, vec3 direction)
{
    light_block light = lights[beams[n].light];
    vec3 turn = direction + light.direction;
    float one_minus_mu = 0.5 * dot(turn, turn);
    march_sun sun;
    sun.grid = n;
    sun.beam = beam_ray_of(n, origin, direction);
    // Said at compile time, as some devices run both sides of a branch.
    sun.beam.edges = sun.beam.edges && !raymarch_has(RAYMARCH_CLOSED);
    sun.map = march_map_of(beams[n].light, origin, direction);
    sun.irradiance = light.color;
    sun.mean_cosine = light.mean_cosine;
#ifdef RAYMARCH_GREY
    sun.phase = hg_near(unit.g * light.mean_cosine, one_minus_mu);
    if (raymarch_has(RAYMARCH_KERNELS)) {
        sun.angle = scatter_angle_of(beams[n].light, 0u, one_minus_mu);
        vec2 once = scatter_kernels(sun.angle, 0.0);
        sun.phase = once.x + once.y;
    }
#else
    sun.light = beams[n].light;
    sun.one_minus_mu = one_minus_mu;
    for (uint c = 0u; c < 3u && medium_mode == TYN_MEDIUM_DENSITY; c++) {
        sun.phase[c] = hg_near(unit.g[c] * light.mean_cosine, one_minus_mu);
        if (raymarch_has(RAYMARCH_KERNELS)) {
            sun.angle[c] = scatter_angle_of(beams[n].light, c, one_minus_mu);
            vec2 once = scatter_kernels(sun.angle[c], 0.0);
            sun.phase[c] = once.x + once.y;
        }
    }
#endif
    return sun;
}

// Light of one sun that is scattered towards the eye at distance s of the ray. `weight` and
// `weight_scaled`: integrals of e^-tau and e^-tau' over the step, m. `first`: the part that has
// scattered once, W/(m^2 sr), as the result.
vec3 march_sunlight(march_sun sun, march_medium unit, march_medium m, vec3 p, float s,
                    spectrum weight, spectrum weight_scaled, inout vec3 first)
{
    beam_place place;
    if (raymarch_has(RAYMARCH_REPEAT)) {
        place = beam_place_of(sun.grid, p);
    } else {
        place = beam_ray_at(sun.beam, s);
    }
    spectrum tau_s, tau_a, phase = sun.phase, k_tms, k_lobe;
#ifdef RAYMARCH_GREY
    float column = beam_fetch(beam_column_tex, place).r;
    tau_s = unit.scattering * column;
    tau_a = unit.absorption * column;
    if (raymarch_has(RAYMARCH_KERNELS)) {
        vec2 k = scatter_kernels(sun.angle, tau_s);
        k_tms = k.x;
        k_lobe = k.y;
    }
#else
    if (medium_mode == TYN_MEDIUM_DENSITY) {
        float column = beam_fetch(beam_column_tex, place).r;
        tau_s = unit.scattering * column;
        tau_a = unit.absorption * column;
        if (raymarch_has(RAYMARCH_KERNELS)) {
            for (int c = 0; c < 3; c++) {
                vec2 k = scatter_kernels(sun.angle[c], tau_s[c]);
                k_tms[c] = k.x;
                k_lobe[c] = k.y;
            }
        }
    } else {
        tau_s = beam_fetch(beam_column_tex, place);
        tau_a = beam_fetch(beam_tau_a_tex, place);
        for (int c = 0; c < 3; c++) {
            phase[c] = hg_near(m.g[c] * sun.mean_cosine, sun.one_minus_mu);
        }
        if (raymarch_has(RAYMARCH_KERNELS)) {
            vec3 tau_p = beam_fetch(beam_tau_p_tex, place);
            for (int c = 0; c < 3; c++) {
                vec2 k = scatter_kernels_mixed(lut.sun_set[sun.light], sun.mean_cosine, sun.one_minus_mu, m.g[c],
                                               tau_s[c], tau_p[c]);
                k_tms[c] = k.x;
                k_lobe[c] = k.y;
            }
        }
    }
#endif
    vec3 light = m.scattering * exp(-tau_a) * sun.irradiance;
    vec3 once = light * (phase * exp(-tau_s) * weight);
    if (raymarch_has(RAYMARCH_SINGLE | RAYMARCH_MULTIPLE)) {
        first += once;
    }
    if (!raymarch_has(RAYMARCH_KERNELS)) {
        return once;
    }
    return light * (k_tms * weight_scaled + k_lobe * weight);
}

// What lights see from where a ray has been marched to: bits 0 to 3 of suns, 4 to 31 of lamps.
struct march_shadows {
    uint known, lit;
    float inside; // where to look at the farthest
    uint cells;   // what is known of all of the step (light_cells_args.h)
};

float march_shadow_piece()
{
    return max(max(medium.extent.x, medium.extent.y), medium.extent.z) / RAYMARCH_SHADOWS_ACROSS;
}

bool march_sees(bool sun, march_map m, float s)
{
    vec3 q = m.from + s * m.along;
    return (sun ? shadow_all_lit(shadow_place_sun(m.map, q)) : shadow_visibility_lamp_at(m.map, q)) > 0.0;
}

// What is known of lights for all of the step from s to s + ds.
uint march_light_cells(vec3 origin, vec3 direction, float s, float ds)
{
    if (!raymarch_has(RAYMARCH_LIGHT_CELLS)) {
        return 0u;
    }
    ivec3 dims = textureSize(light_cells_tex, 0);
    float per_edge = float(max(max(dims.x, dims.y), dims.z)) / max(max(medium.extent.x, medium.extent.y), medium.extent.z);
    // Each place tells of what is within reach of it; what not all of them say is mixed.
    float places = clamp(ceil(ds * (per_edge / (2.0 * TYN_LIGHT_CELLS_REACH))), 1.0, RAYMARCH_CELLS_MOST), part = ds / places;
    uint cells = part * per_edge <= 2.001 * TYN_LIGHT_CELLS_REACH ? ~0u : 0u;
    for (float i = 0.5; i < places && cells != 0u; i += 1.0) {
        vec3 p = origin + (s + i * part) * direction;
        cells &= uint(texelFetch(light_cells_tex, clamp(ivec3(p * per_edge), ivec3(0), dims - 1), 0).r);
    }
    return cells;
}

uint march_light_cell(march_shadows shadow, uint light)
{
    return light < TYN_LIGHT_CELLS ? shadow.cells >> (2u * light) & 3u : TYN_LIGHT_CELLS_MIXED;
}

// What a light sees of the step from s to s + ds: how much of it, and where the middle of that is. Steps follow the
// medium, shadows do not: so a step looks at several places, and halves what is between two that differ.
struct march_lit {
    float metres, middle;
};

// `bit`: of the light in `shadow`.
march_lit march_lit_of(bool sun, march_map map, uint light, uint bit, float s, float ds, inout march_shadows shadow)
{
    float part = ds / max(ceil(ds / march_shadow_piece()), 1.0), finest = part / RAYMARCH_SHADOW_HALVES;
    float sum = 0.0, moment = 0.0;
    uint mask = bit < 32u ? 1u << bit : 0u; // lights beyond are looked at afresh
    bool known = (shadow.known & mask) != 0u, lit = (shadow.lit & mask) != 0u;
    // Up to `lo` it is known what the light sees; at `hi`, if > 0, it is the opposite. One look an iteration, as
    // these are what costs time.
    float lo = 0.0, hi = 0.0;
    uint cell = march_light_cell(shadow, light);
    if (cell != TYN_LIGHT_CELLS_MIXED) {
        lit = cell == TYN_LIGHT_CELLS_LIT;
        lo = ds;
        sum = lit ? ds : 0.0;
        moment = ds * sum;
    }
    while (lo < ds) {
        float next = hi > 0.0 ? 0.5 * (lo + hi) : lo + 1.01 * part > ds ? ds : lo + part;
        next = known ? next : 0.0;
        bool sees = march_sees(sun, map, min(s + next, shadow.inside));
        lit = known ? lit : sees;
        known = true;
        float more = lit && sees ? next - lo : 0.0;
        sum += more;
        moment += more * (lo + next);
        hi = lit == sees ? hi : next;
        lo = lit == sees ? next : lo;
        if (hi - lo > 0.0 && hi - lo <= finest) { // the edge is in the middle
            more = 0.5 * (hi - lo);
            sum += more;
            moment += more * (hi + lo);
            lo = hi;
            hi = 0.0;
            lit = !lit;
        }
    }
    shadow.known |= mask;
    shadow.lit = lit ? shadow.lit | mask : shadow.lit & ~mask;
    return march_lit(sum, s + 0.5 * moment / max(sum, 1e-30));
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
float march_next_step(march_medium m)
{
    if (!raymarch_has(RAYMARCH_WALLS | RAYMARCH_SHADOWS)) {
        return args.step;
    }
    float by_depth = args.step_depth / max(spectrum_max(m.extinction), 1e-30);
    return march_any(m) ? clamp(by_depth, args.step, args.longest) : args.step;
}

// Light of the lattice at a point, as texture inscatter has it.
vec3 march_field_between_walls(vec3 p)
{
    if (raymarch_has(RAYMARCH_REPEAT)) {
        p = medium_wrap(p);
    }
    lattice_box box = lattice_box_of(medium.extent, textureSize(inscatter_tex, 0) - 2);
    return walls_fetch(inscatter_tex, box, walls_blend_of(box, walls_place_of(box, p), p), ivec3(1)).rgb;
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
float march_centroid(march_medium m, float ds)
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
        float away = texelFetch(distance_tex, brick, 0).r;
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
    state.shadow = march_shadows(0u, 0u, 0.0, 0u);
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

// Not an argument, as some compilers copy arrays that are.
march_waiting waiting;

bool march_has_room()
{
    return waiting.walls < RAYMARCH_LATER && waiting.near_lamps.count < MARCH_NEAR_STEPS;
}

// A step, and the integrals of e^-tau and e^-tau' over it, m.
struct march_step {
    float s, ds, at; // beginning, length and centroid, m
    spectrum weight, weight_scaled;
};

// Is there a sun or a lamp that may shine on the step?
bool march_any_light(march_shadows shadow, march_lamp kept[MARCH_LAMPS_KEPT])
{
    bool any = false;
    for (uint n = 0u; n < raymarch_num_suns; n++) {
        any = any || march_light_cell(shadow, n) != TYN_LIGHT_CELLS_DARK;
    }
    [[unroll]] for (uint n = 0u; n < march_lamps_kept; n++) {
        any = any || march_light_cell(shadow, kept[n].grid.light.light) != TYN_LIGHT_CELLS_DARK;
    }
    return any || raymarch_num_lamps > MARCH_LAMPS_KEPT;
}

// Light of suns and lamps that the step scatters towards the eye.
vec3 march_beams(march_sun suns[TYN_BEAM_MAX_SUNS], march_lamp kept[MARCH_LAMPS_KEPT], march_lamps lamps,
                 march_medium unit, march_medium m, vec3 origin, vec3 direction, march_step b,
                 inout march_shadows shadow, inout vec3 single)
{
    vec3 light = vec3(0.0);
    for (uint n = 0u; n < raymarch_num_suns; n++) {
        float lit = 1.0;
        if (raymarch_has(RAYMARCH_SHADOWS)) {
            lit = march_lit_of(true, suns[n].map, n, n, b.s, b.ds, shadow).metres / max(b.ds, 1e-30);
        }
        light += march_sunlight(suns[n], unit, m, origin + b.at * direction, b.at, lit * b.weight,
                                lit * b.weight_scaled, single);
    }
    [[unroll]] for (uint n = 0u; n < march_lamps_kept; n++) {
        light += march_lamplight(kept[n], 4u + n, lamps, unit, m, b.s, b.ds, b.at, b.weight, b.weight_scaled,
                                 shadow, single);
    }
    for (uint n = MARCH_LAMPS_KEPT; n < raymarch_num_lamps; n++) {
        light += march_lamplight(march_lamp_of(n, lamps), 4u + n, lamps, unit, m, b.s, b.ds, b.at, b.weight,
                                 b.weight_scaled, shadow, single);
    }
    return light;
}

// Goes through the step of the length ds through m; `is`: false if there is none, and then ds is 0. All its light but
// that of suns and lamps.
march_step march_through(march_medium m, float ds, bool is, march_line line, vec2 near_lamps, inout march_state state)
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
        vec3 J = march_tinted(march_field(p, line.field0 + there * line.field1));
        spectrum per_metre = m.scaled_scattering;
        if (raymarch_has(RAYMARCH_SOURCE)) {
            per_metre = spectrum(spectrum_max(m.extinction) > 0.0 ? 1.0 : 0.0);
        }
        vec3 light = (per_metre * step.weight_scaled) * J;
        if (raymarch_has(RAYMARCH_WALLS)) {
            bool near = is && march_near_walls(p);
            waiting.last_wall = near ? waiting.walls : is ? -1 : waiting.last_wall;
            if (near) {
                waiting.wall_at[waiting.walls] = there;
                waiting.wall_weight[waiting.walls] = per_metre * step.weight_scaled;
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
    march_sun suns[TYN_BEAM_MAX_SUNS];
    for (uint n = 0u; n < raymarch_num_suns; n++) {
        suns[n] = march_sun_of(n, unit, origin, direction);
    }
    float pixel = 2.0 * camera.half_width / float(camera.size.x);
    bool orthographic = camera.orthographic != 0u;
    march_lamps lamps = march_lamps(origin, direction, start, orthographic ? pixel : 0.0,
                                    orthographic ? 0.0 : pixel);
    march_lamp kept[MARCH_LAMPS_KEPT];
    [[unroll]] for (uint n = 0u; n < march_lamps_kept; n++) {
        kept[n] = march_lamp_of(n, lamps);
    }
    march_near near = march_near_of(lamps, end);
    vec3 inverse = ray_inverse(direction);
    float inside = raymarch_has(RAYMARCH_WALLS | RAYMARCH_SHADOWS) ? max(end - 5e-4 * (start + end), 0.0) : end;
    march_line line = march_line_of(origin, direction, inside);
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
            // Neighbouring rays look for their next step that is not empty together; where it is known what lights see,
            // for their next one that is not in the dark, and go through the others on the way. A turn must change
            // nothing for a ray that has found its step: some devices use what the last turn gives for all.
            march_medium m;
            march_step step = march_step(0.0, 0.0, 0.0, spectrum(0.0), spectrum(0.0));
            bool found = false;
            do {
                float ds = min(state.next, end - state.s);
                if (raymarch_num_lamps > 0u) {
                    ds = min(ds, march_lamp_step(lamps, kept, state.s));
                }
                m = march_medium_at(unit, line.medium0 + (state.s + 0.5 * ds) * line.medium1);
                bool any = march_any(m);
                // Of the channels that are not gone: a dense one must not hold up the others.
                spectrum left = spectrum_above(state.through_scaled, args.stop);
                float most =
                    spectrum_max(left * (raymarch_has(RAYMARCH_KERNELS) ? m.scaled_extinction : m.extinction));
                bool dense = any && most * ds > RAYMARCH_DENSE, full = any && !dense && !found;
                i += found ? 0 : 1;
                state.steps += found ? 0u : 1u;
                state.shadow.known = any || found ? state.shadow.known : 0u;
                state.s += any || found ? 0.0 : ds;
                state.next = full || found ? state.next : dense ? RAYMARCH_SHORT / most : args.step;
                if (raymarch_has(RAYMARCH_LIGHT_CELLS)) {
                    state.shadow.cells = full ? march_light_cells(origin, direction, state.s, ds) : state.shadow.cells;
                    bool lit = full && march_any_light(state.shadow, kept);
                    // Where all is dark nothing need be looked for at the next step's beginning.
                    state.shadow.lit = full && !lit ? 0u : state.shadow.lit;
                    state.shadow.known = full && !lit ? ~0u : state.shadow.known;
                    march_step here =
                        march_through(m, full ? ds : 0.0, full, line, near.span, state);
                    if (lit) {
                        step = here;
                    }
                    found = found || lit;
                } else {
                    step.ds = full ? ds : step.ds;
                    found = found || full;
                }
            } while (!found && i < RAYMARCH_CHUNK && state.s < end &&
                     spectrum_max(state.through_scaled) > args.stop && march_has_room());
            if (raymarch_has(RAYMARCH_LIGHT_CELLS)) {
                m = march_medium_at(unit, line.medium0 + (step.s + 0.5 * step.ds) * line.medium1);
            } else if (found) {
                step = march_through(m, step.ds, true, line, near.span, state);
            }
            if (raymarch_num_suns + raymarch_num_lamps > 0u) {
                vec3 light =
                    march_beams(suns, kept, lamps, unit, m, origin, direction, step, state.shadow, state.single);
                state.radiance += light;
            }
        }
        for (int i = 0; raymarch_has(RAYMARCH_WALLS) && i < waiting.walls; i++) {
            vec3 J = march_tinted(march_field_between_walls(origin + waiting.wall_at[i] * direction));
            state.radiance += waiting.wall_weight[i] * J;
            state.before += i == waiting.last_wall ? vec3(0.0) : waiting.wall_weight[i] * J;
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
        result.radiance += (result.radiance - state.before) * min(rest / max(last, 1e-9), 99.0);
        through_scaled = through_end;
    }
    result.transmittance = vec3(through * exp(-hidden));
    result.scaled_transmittance = vec3(through_scaled);
    return result;
}

#endif
