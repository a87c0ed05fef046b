// raymarch_lamps.glsl -- light of lamps that is scattered towards the eye in a step of a view ray.
//
// Included by raymarch.glsl.
// Where a view ray is in relation to a lamp, and what is needed on all of it.

struct march_lamps {
    vec3 origin, direction;
    float start; // distance of the eye from the origin, m
    float pixel; // width of a pixel at the eye, and what it grows by per metre
    float spread;
};

// The picture shows means over pixels: a ray through the lamp itself has the mean of 1 / h over a disc as
// large as the pixel, which is 2 / its radius.
float march_least_h(const march_lamps ray, float s)
{
    return 0.282 * (ray.pixel + ray.spread * (ray.start + s)) + 1e-6 * medium.voxel.x;
}

// ... and one that passes the lamp at `x` pixels has more than its own 1 / h: over a square 1.20 of it at 0.5,
// 1.25 at 0.71, the corner, and 1 + 1 / (24 x^2) far away.
float march_pixel_mean(float x)
{
    float y = 1.0 / max(x * x, 0.08);
    return 1.0 + min(max(x - 0.282, 0.0), min(y * (1.0 / 24.0 + 0.02 * y * y), 0.25));
}

const float MARCH_LAMP_STEP = 0.15; // steps are no longer than this part of the distance from a lamp

// What a lamp shines on of a view ray. With e the direction from the lamp to the nearest place of the ray's line,
// points of that line are in the directions cos(t) e + sin(t) d, and a lamp's axis is at acos(peak cos(t - middle))
// from them: so its cones cut the line at t = middle +- inner and middle +- outer, exactly.
struct march_cone {
    float middle, peak;
    float inner, outer; // more than pi: all is lit
};

// `across`: from the lamp to the nearest place of the ray's line.
march_cone march_cone_of(const light_block light, vec3 across, vec3 direction)
{
    if (!raymarch_has(RAYMARCH_SPOTS)) {
        return march_cone(0.0, 1.0, 4.0, 4.0);
    }
    vec2 axis = vec2(dot(light.direction, across) / max(length(across), 1e-20), dot(light.direction, direction));
    float peak = max(length(axis), 1e-20);
    bool around = light.kind == TYN_LIGHT_KIND_POINT;
    // acos(c / peak), but an acos is not precise about 1.
    vec2 c = vec2(light.cos_inner, light.cos_outer);
    vec2 edges = around ? vec2(4.0) : atan(sqrt(max(peak * peak - c * c, 0.0)), c);
    return march_cone(around ? 0.0 : atan(axis.y, axis.x), peak, edges.x, edges.y);
}

// Integral of a lamp's lobe over what of the angles from a to b is between the cones, on the positive side, and
// that of the angle times it; by three points of Gauss, as a spot's is a quartic but for the curvature of a cosine.
vec2 march_falloff(const light_block light, const march_cone cone, float a, float b)
{
    float from = max(a, cone.inner), width = max(min(b, cone.outer) - from, 0.0);
    vec2 sum = vec2(0.0);
    for (int i = -1; i <= 1; i++) {
        float u = from + (0.5 + 0.3872983 * float(i)) * width;
        sum += light_lobe_times(light, cone.peak * cos(u), i == 0 ? 4.0 / 9.0 : 2.5 / 9.0) * vec2(1.0, u);
    }
    return sum * width;
}

// Mean share of a lamp's intensity over the angles from x to y at it; `middle`: the centroid of that light.
float march_share(const light_block light, const march_cone cone, float x, float y, out float middle)
{
    const float TURN = 6.28318531;
    float shift = cone.middle + TURN * round((0.5 * (x + y) - cone.middle) / TURN);
    float a = x - shift, b = max(y - shift, a + 1e-6); // more than what a float near pi is rounded by
    float from = max(a, -cone.inner), to = max(min(b, cone.inner), from);
    vec2 sum = (to - from) * vec2(1.0, 0.5 * (from + to)) + march_falloff(light, cone, a, b);
    sum += march_falloff(light, cone, -b, -a) * vec2(1.0, -1.0);
    middle = shift + sum.y / max(sum.x, 1e-20);
    return sum.x / (b - a);
}

// A lamp as a view ray sees it. The first ones are read once a ray.
struct march_lamp {
    radial_grid grid;
    march_map map;
    march_cone cone;
};
const uint MARCH_LAMPS_KEPT = 2u;
const uint march_lamps_kept = raymarch_num_lamps < MARCH_LAMPS_KEPT ? raymarch_num_lamps : MARCH_LAMPS_KEPT;

march_lamp march_lamp_of(uint n, const march_lamps ray)
{
    march_lamp lamp;
    lamp.grid = radials[n];
    lamp.map = march_map_of(lamp.grid.light.shadow, ray.origin, ray.direction);
    vec3 away = ray.origin - lamp.grid.light.position;
    lamp.cone = march_cone_of(lamp.grid.light, away - dot(away, ray.direction) * ray.direction, ray.direction);
    return lamp;
}

march_lamp ray_lamps[MARCH_LAMPS_KEPT]; // as the ray sees them; not an argument, as in raymarch.glsl

float march_lamp_step(const march_lamps ray, float s)
{
    float least = TYN_INFINITY;
    vec3 p = ray.origin + s * ray.direction;
    [[unroll]] for (uint n = 0u; n < march_lamps_kept; n++) {
        vec3 away = p - ray_lamps[n].grid.light.position;
        least = min(least, dot(away, away));
    }
    for (uint n = MARCH_LAMPS_KEPT; n < raymarch_num_lamps; n++) {
        vec3 away = p - radials[n].light.position;
        least = min(least, dot(away, away));
    }
    return MARCH_LAMP_STEP * max(sqrt(least), march_least_h(ray, s));
}

// Light of a lamp that is scattered towards the eye `away` from it, r = length(away). `per_intensity`: what
// a W/sr sends there as if nothing stood before it, 1/m^2.
vec3 march_lamplight_seen(const march_lamp lamp, const march_lamps ray, const march_medium unit, const march_medium m, vec3 away, float r,
                          float per_intensity, spectrum weight, spectrum weight_scaled, inout vec3 first)
{
    vec3 irradiance = lamp.grid.light.color * per_intensity;
    vec3 turn = ray.direction + away / max(r, 1e-20);
    float one_minus_mu = 0.5 * dot(turn, turn);
    radial_place place = radial_place_in(lamp.grid, away, r);
    spectrum tau_s, tau_a, k_once, k_tms, k_lobe;
#ifdef RAYMARCH_GREY
    float column = radial_column(place);
    tau_s = unit.scattering * column;
    tau_a = unit.absorption * column;
    k_once = phase_near(unit.phase[0], 1.0, one_minus_mu);
    if (raymarch_has(RAYMARCH_KERNELS)) {
        vec2 k = scatter_kernels(scatter_angle_of_point(0u, one_minus_mu), tau_s);
        k_tms = k.x;
        k_lobe = k.y;
    }
#else
    beam_tau tau = radial_tau(place);
    tau_s = tau.s;
    tau_a = tau.a;
    scatter_angle angle;
    for (uint c = 0u; c < 3u; c++) {
        k_once[c] = phase_near(m.phase[c], 1.0, one_minus_mu);
        if (raymarch_has(RAYMARCH_KERNELS)) {
            vec2 k;
            if (medium_mode != TYN_MEDIUM_COEFFICIENTS) {
                if (c == 0u || lut.channel_row[c] != lut.channel_row[0]) {
                    angle = scatter_angle_of_point(c, one_minus_mu);
                }
                k = scatter_kernels(angle, tau_s[c]);
            } else {
                k = scatter_kernels_mixed(0u, 1.0, one_minus_mu, m.phase[c], tau.s[c], tau.p[c]);
            }
            k_tms[c] = k.x;
            k_lobe[c] = k.y;
        }
    }
#endif
    vec3 light = m.scattering * exp(-tau_a) * irradiance;
    vec3 once = light * (k_once * exp(-tau_s) * weight);
    if (raymarch_has(RAYMARCH_SINGLE | RAYMARCH_MULTIPLE)) {
        first += once;
    }
    return raymarch_has(RAYMARCH_KERNELS) ? light * (k_tms * weight_scaled + k_lobe * weight) : once;
}

// Integral of 1 / (h2 + x^2) from a to b.
float march_inverse_square(float h2, float a, float b)
{
    float q = h2 + a * b, h = sqrt(h2), z = h * (b - a);
    return q > 4.0 * z ? (b - a) * (1.0 - z * z / (3.0 * q * q)) / q : atan(z, q) / h;
}

// As march_sunlight, of a lamp in the step from s to s + ds, of which `at` is the middle: of what the lamp sees of it
// and shines on. 1 / r^2 changes most: its integral is exact, (angle under which the lamp sees that part) / h, h the
// ray's distance from it.
vec3 march_lamplight(const march_lamp lamp, uint bit, const march_lamps ray, const march_medium unit, const march_medium m, float s, float ds,
                     float at, spectrum weight, spectrum weight_scaled, inout march_shadows shadow,
                     inout vec3 first)
{
    vec3 away = ray.origin + at * ray.direction - lamp.grid.light.position;
    float along = dot(away, ray.direction), least = march_least_h(ray, at);
    vec3 across = away - along * ray.direction;
    float h2 = max(dot(across, across), least * least), h = sqrt(h2);
    float a = along + (s - at), b = a + ds;
    float angle, share = 1.0;
    if (raymarch_has(RAYMARCH_SPOTS)) {
        share = march_share(lamp.grid.light, lamp.cone, atan(a, h), atan(b, h), angle);
    }
    if (raymarch_has(RAYMARCH_SHADOWS) && share > 0.0) {
        march_lit lit = march_lit_of(false, lamp.map, bit, s, ds, shadow);
        if (lit.metres < ds) {
            float middle = along + (lit.middle - at);
            a = middle - 0.5 * lit.metres;
            b = middle + 0.5 * lit.metres;
            if (raymarch_has(RAYMARCH_SPOTS)) {
                share = march_share(lamp.grid.light, lamp.cone, atan(a, h), atan(b, h), angle);
            }
            share = lit.metres > 0.0 ? share : 0.0;
        }
    }
    if (share <= 0.0) {
        return vec3(0.0);
    }
    float mean = march_inverse_square(h2, a, b) / max(ds, 1e-30) * march_pixel_mean(length(across) * (0.282 / least));
    // Where the angle from the lamp is in the middle: half of the light is on either side.
    float middle;
    if (raymarch_has(RAYMARCH_SPOTS)) {
        middle = h * tan(clamp(angle, -1.5707, 1.5707));
    } else {
        float ra = sqrt(h2 + a * a), rb = sqrt(h2 + b * b);
        middle = (a * rb + b * ra) / (ra + rb) + (at - s - 0.5 * ds);
    }
    middle = clamp(middle, a, b);
    if (raymarch_has(RAYMARCH_SPOTS)) {
        // What is lit need not be where the step's weight has its centroid.
        float nearer = along - middle;
        weight *= exp(m.extinction * nearer);
        weight_scaled *= exp(m.scaled_extinction * nearer);
    }
    away += (middle - along) * ray.direction;
    return march_lamplight_seen(lamp, ray, unit, m, away, length(away), share * mean, weight, weight_scaled, first);
}
