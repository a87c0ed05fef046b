// raymarch_near.glsl -- light of the lamps that view rays follow nearby only (radial_reach): their halos and beams.
//
// Included by raymarch.glsl. Few steps are near such a lamp, and few lamps near a step. So a ray knows the set of
// lamps whose reach it crosses, its steps there wait until a chunk of them is done, and each lamp is read once a
// chunk.

const int MARCH_NEAR_STEPS = raymarch_num_near > 0u ? 8 : 1; // that wait
const float MARCH_NEAR_ANGLE = 0.35; // steps are cut so that a lamp sees the pieces under no more than this

struct march_near {
    uvec2 lamps; // the set
    vec2 span;   // of the ray, in which there are any
};

// Steps that wait: where they are, and the integrals of e^-tau and e^-tau' over them.
struct march_near_steps {
    float at[MARCH_NEAR_STEPS], ds[MARCH_NEAR_STEPS];
    spectrum weight[MARCH_NEAR_STEPS], weight_scaled[MARCH_NEAR_STEPS];
    int count;
};

// Where the ray is within reach of near lamp n.
vec2 march_near_span(uint n, const march_lamps ray)
{
    light_block light = radials[raymarch_num_lamps + n].light;
    vec3 away = ray.origin - light.position;
    float along = dot(away, ray.direction), reach = radial_reach(light, args.reach);
    vec3 across = away - along * ray.direction;
    float half_2 = reach * reach - dot(across, across);
    vec2 span = half_2 > 0.0 ? sqrt(half_2) * vec2(-1.0, 1.0) : vec2(TYN_INFINITY, -TYN_INFINITY);
    march_cone cone = march_cone_of(light, across, ray.direction);
    if (raymarch_has(RAYMARCH_SPOTS) && cone.outer < 1.57) {
        float h = length(across);
        vec2 edges = clamp(cone.middle + cone.outer * vec2(-1.0, 1.0), -1.57, 1.57);
        span.x = edges.x > -1.57 ? max(span.x, h * tan(edges.x)) : span.x;
        span.y = edges.y < 1.57 ? min(span.y, h * tan(edges.y)) : span.y;
        span.y = edges.x < edges.y ? span.y : -TYN_INFINITY;
    }
    return span - along;
}

march_near march_near_of(const march_lamps ray, float end)
{
    march_near near = march_near(uvec2(0u), vec2(TYN_INFINITY, -TYN_INFINITY));
    for (uint n = 0u; n < raymarch_num_near; n++) {
        vec2 span = march_near_span(n, ray);
        if (max(span.x, 0.0) < min(span.y, end)) {
            near.lamps[n / 32u] |= 1u << (n & 31u);
            near.span = vec2(min(near.span.x, span.x), max(near.span.y, span.y));
        }
    }
    return near;
}

// The next lamp of a set, which loses it; the set must not be empty.
uint march_near_next(inout uvec2 lamps)
{
    bool low = lamps.x != 0u;
    uint bits = low ? lamps.x : lamps.y;
    uint n = uint(findLSB(bits));
    bits &= bits - 1u;
    lamps = low ? uvec2(bits, lamps.y) : uvec2(0u, bits);
    return low ? n : n + 32u;
}

// Light of a lamp in the piece from a to b of a step through m; `at` is the centroid of the step's weights, which are
// per metre.
vec3 march_near_piece(const march_lamp lamp, const march_lamps ray, const march_medium unit, const march_medium m, vec2 piece, float at,
                      spectrum weight, spectrum weight_scaled, float inside, inout vec3 first)
{
    vec3 away = ray.origin - lamp.grid.light.position;
    float closest = -dot(away, ray.direction), least = march_least_h(ray, 0.5 * (piece.x + piece.y));
    vec3 across = away + closest * ray.direction;
    float h2 = max(dot(across, across), least * least), h = sqrt(h2);
    float a = piece.x - closest, b = piece.y - closest, angle = 0.5 * (atan(a, h) + atan(b, h)), share = 1.0;
    if (raymarch_has(RAYMARCH_SPOTS)) {
        share = march_share(lamp.grid.light, lamp.cone, atan(a, h), atan(b, h), angle);
    }
    float all = march_inverse_square(h2, a, b) * march_pixel_mean(length(across) * (0.282 / least));
    float light = share * radial_near(all, h2, a, b, radial_reach(lamp.grid.light, args.reach));
    float middle = clamp(h * tan(clamp(angle, -1.5707, 1.5707)), a, b);
    if (raymarch_has(RAYMARCH_SHADOWS) && !march_sees(false, lamp.map, min(closest + middle, inside), vec3(0.0), SHADOW_LIT_BY_ALL)) {
        light = 0.0;
    }
    if (light <= 0.0) {
        return vec3(0.0);
    }
    float nearer = at - closest - middle;
    weight *= exp(m.extinction * nearer);
    weight_scaled *= exp(m.scaled_extinction * nearer);
    away = across + middle * ray.direction;
    return march_lamplight_seen(lamp, ray, unit, m, away, length(away), light, weight, weight_scaled, first);
}

// Light of all near lamps in the steps that wait. `last`: that in the last of them.
vec3 march_near_light(const march_near near, const march_lamps ray, const march_medium unit, const march_near_steps steps, vec3 medium0,
                      vec3 medium1, float inside, inout vec3 first, out vec3 last)
{
    vec3 sum = vec3(0.0);
    last = vec3(0.0);
    uvec2 left = steps.count > 0 ? near.lamps : uvec2(0u);
    float begin = steps.at[0], end = steps.at[max(steps.count - 1, 0)] + steps.ds[max(steps.count - 1, 0)];
    while ((left.x | left.y) != 0u) {
        uint n = 0u;
        vec2 span = vec2(0.0);
        bool found = false;
        while (!found && (left.x | left.y) != 0u) {
            n = march_near_next(left);
            span = march_near_span(n, ray);
            found = max(span.x, begin) < min(span.y, end);
        }
        if (found) {
            march_lamp lamp = march_lamp_of(raymarch_num_lamps + n, ray);
            vec3 away = ray.origin - lamp.grid.light.position;
            float closest = -dot(away, ray.direction), h = length(away + closest * ray.direction);
            float s = span.x;
            int k = 0;
            while (k < steps.count && steps.at[k] + steps.ds[k] <= s) {
                k++;
            }
            while (k < steps.count && max(s, steps.at[k]) < span.y) {
                float from = max(s, steps.at[k]), to = min(steps.at[k] + steps.ds[k], span.y);
                float angle = atan(from - closest, h) + MARCH_NEAR_ANGLE;
                s = min(angle < 1.57 ? closest + h * tan(angle) : to, to);
                s = s > from ? s : to;
                march_medium m = march_medium_at(unit, medium0 + (steps.at[k] + 0.5 * steps.ds[k]) * medium1);
                float at = steps.at[k] + steps.ds[k] * march_centroid(m, steps.ds[k]);
                float part = 1.0 / steps.ds[k];
                vec3 light = march_near_piece(lamp, ray, unit, m, vec2(from, s), at, part * steps.weight[k],
                                              part * steps.weight_scaled[k], inside, first);
                sum += light;
                last += k + 1 == steps.count ? light : vec3(0.0);
                k += s >= to ? 1 : 0;
            }
        }
    }
    return sum;
}
