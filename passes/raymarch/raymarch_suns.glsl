// raymarch_suns.glsl -- what lights see of a view ray, and the light of suns that a step of it scatters to the eye.
//
// Included by raymarch.glsl.

const float RAYMARCH_SHADOWS_ACROSS = 128.0; // looks at a shadow map along the box's longest side, and
const float RAYMARCH_SHADOW_HALVES = 8.0; // parts of which where it has an edge in between

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
    float once; // phase function of one scattering; mode DENSITY, as `angle`
#else
    scatter_angle angle[3];
    vec3 once;
    uint light;
    float one_minus_mu;
#endif
};

march_sun march_sun_of(uint n, const march_medium unit, vec3 origin, vec3 direction)
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
    sun.once = phase_near(unit.phase[0], light.mean_cosine, one_minus_mu);
    if (raymarch_has(RAYMARCH_KERNELS)) {
        sun.angle = scatter_angle_of(beams[n].light, 0u, one_minus_mu);
        vec2 once = scatter_kernels(sun.angle, 0.0);
        sun.once = once.x + once.y;
    }
#else
    sun.light = beams[n].light;
    sun.one_minus_mu = one_minus_mu;
    for (uint c = 0u; c < 3u && medium_mode != TYN_MEDIUM_COEFFICIENTS; c++) {
        sun.once[c] = phase_near(unit.phase[c], light.mean_cosine, one_minus_mu);
        if (raymarch_has(RAYMARCH_KERNELS)) {
            sun.angle[c] = scatter_angle_of(beams[n].light, c, one_minus_mu);
            vec2 once = scatter_kernels(sun.angle[c], 0.0);
            sun.once[c] = once.x + once.y;
        }
    }
#endif
    return sun;
}

// Light of one sun that is scattered towards the eye at distance s of the ray. `weight` and
// `weight_scaled`: integrals of e^-tau and e^-tau' over the step, m. `first`: the part that has
// scattered once, W/(m^2 sr), as the result.
vec3 march_sunlight(const march_sun sun, const march_medium unit, const march_medium m, vec3 p, float s,
                    spectrum weight, spectrum weight_scaled, inout vec3 first)
{
    beam_place place;
    if (raymarch_has(RAYMARCH_REPEAT)) {
        place = beam_place_of(sun.grid, p);
    } else {
        place = beam_ray_at(sun.beam, s);
    }
    spectrum tau_s, tau_a, k_once = sun.once, k_tms, k_lobe;
#ifdef RAYMARCH_GREY
    float column = beam_fetch(column_tex, place).r;
    tau_s = unit.scattering * column;
    tau_a = unit.absorption * column;
    if (raymarch_has(RAYMARCH_KERNELS)) {
        vec2 k = scatter_kernels(sun.angle, tau_s);
        k_tms = k.x;
        k_lobe = k.y;
    }
#else
    if (medium_mode == TYN_MEDIUM_DENSITY) {
        float column = beam_fetch(column_tex, place).r;
        tau_s = unit.scattering * column;
        tau_a = unit.absorption * column;
    } else {
        tau_s = beam_fetch(column_tex, place);
        tau_a = beam_fetch(tau_a_tex, place);
    }
    if (medium_mode != TYN_MEDIUM_COEFFICIENTS) {
        if (raymarch_has(RAYMARCH_KERNELS)) {
            for (int c = 0; c < 3; c++) {
                vec2 k = scatter_kernels(sun.angle[c], tau_s[c]);
                k_tms[c] = k.x;
                k_lobe[c] = k.y;
            }
        }
    } else {
        for (int c = 0; c < 3; c++) {
            k_once[c] = phase_near(m.phase[c], sun.mean_cosine, sun.one_minus_mu);
        }
        if (raymarch_has(RAYMARCH_KERNELS)) {
            vec3 tau_p = beam_fetch(tau_p_tex, place);
            for (int c = 0; c < 3; c++) {
                vec2 k = scatter_kernels_mixed(lut.sun_set[sun.light], sun.mean_cosine, sun.one_minus_mu, m.phase[c],
                                               tau_s[c], tau_p[c]);
                k_tms[c] = k.x;
                k_lobe[c] = k.y;
            }
        }
    }
#endif
    vec3 light = m.scattering * exp(-tau_a) * sun.irradiance;
    vec3 once = light * (k_once * exp(-tau_s) * weight);
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
    uint edges; // of shadows that the ray has crossed
    uint looks, beside; // looks beside the ray, and those that find light where the ray finds none, or none where it finds some
    float inside; // where to look at the farthest
    vec2 across;  // of a pixel: at the eye, and more with each metre from it
};

float march_shadow_piece()
{
    return max(max(medium.extent.x, medium.extent.y), medium.extent.z) / RAYMARCH_SHADOWS_ACROSS;
}

// Where a node's ray looks beside itself, in the light's frame: all over its cells, up to two pixels and a half away.
vec3 march_beside(const march_map m, float s, const march_shadows shadow)
{
    vec2 at = 5.0 * (fract(vec2(0.6180340, 0.4142136) * float(shadow.looks)) - 0.5);
    vec3 moved = (shadow.across.x + s * shadow.across.y) * (at.x * camera.right + at.y * camera.up);
    return shadow_frame_direction(m.map, moved);
}

// `by`: SHADOW_LIT_BY_*; `moved` in the light's frame.
bool march_sees(bool sun, const march_map m, float s, vec3 moved, uint by)
{
    vec3 q = m.from + s * m.along + moved;
    return ((sun ? shadow_lit_by(shadow_atlas, shadow_place_sun(m.map, q)) : shadow_lamp_lights_at(m.map, q)) & by) != 0u;
}

// What a light sees of the step from s to s + ds: how much of it, and where the middle of that is. Steps follow the
// medium, shadows do not: so a step looks at several places, and halves what is between two that differ.
struct march_lit {
    float metres, middle;
};

// `bit`: of the light in `shadow`.
march_lit march_lit_of(bool sun, const march_map map, uint bit, float s, float ds, inout march_shadows shadow)
{
    float part = ds / max(ceil(ds / march_shadow_piece() - 1e-3), 1.0), finest = part / RAYMARCH_SHADOW_HALVES;
    float sum = 0.0, moment = 0.0;
    uint mask = bit < 32u ? 1u << bit : 0u; // lights beyond are looked at afresh
    bool known = (shadow.known & mask) != 0u, lit = (shadow.lit & mask) != 0u;
    // Up to `lo` it is known what the light sees; at `hi`, if > 0, it is the opposite. One look an iteration, as
    // these are what costs time.
    float lo = 0.0, hi = 0.0;
    bool asked = false, aside = false; // the look before was beside the ray, and what it found
    while (lo < ds) {
        float next = hi > 0.0 ? 0.5 * (lo + hi) : lo + 1.01 * part > ds ? ds : lo + part;
        next = known ? next : 0.0;
        // Light is found where it is for sure, and goes on from there as far as half of the texels see it: no wall is
        // within the ray.
        uint by = lit || hi > 0.0 ? SHADOW_LIT_BY_HALF : SHADOW_LIT_BY_ALL;
        float at = min(s + next, shadow.inside);
        // Between rays of the first grid thin shafts may go unseen: these look beside each place first.
        bool beside = false;
        vec3 moved = vec3(0.0);
        if (raymarch_has(RAYMARCH_SPARSE_NODES)) {
            beside = !asked && args.rays == RAYMARCH_ALL_NODES && hi <= 0.0;
            moved = beside ? march_beside(map, at, shadow) : moved;
        }
        bool sees = march_sees(sun, map, at, moved, by);
        if (raymarch_has(RAYMARCH_SPARSE_NODES)) {
            shadow.looks += beside ? 1u : 0u;
            shadow.beside += asked && aside != sees ? 1u : 0u;
            asked = beside;
            aside = sees;
            if (beside) {
                continue;
            }
        }
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
            shadow.edges++;
        }
    }
    shadow.known |= mask;
    shadow.lit = lit ? shadow.lit | mask : shadow.lit & ~mask;
    return march_lit(sum, s + 0.5 * moment / max(sum, 1e-30));
}
