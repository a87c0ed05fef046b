// gradient_light.glsl -- radiance that all lights together send towards the eye at a point, per sigma_s: Eq 1, of any lights and
// phase functions.
//
// With what the lattice has of light that has scattered before, all is delta scaled (raymarch.glsl): what is scattered forward
// counts as passing, and first scattering has the whole phase function over 1 - f (Nakajima and Tanaka 1988).
//
// Include after gradient_bindings.glsl's other files.

layout(constant_id = 1) const uint gradient_features = 0u;

const float GRADIENT_DARK = 20.0; // optical depth behind which a light is not followed: e^-20 = 2e-9
const int GRADIENT_AT_ONCE = 4;   // steps of a ray in a turn of its loop

// A macro: its value is a specialization constant, and engine/gpu/specialize.c drops what is off.
#define gradient_has(feature) ((gradient_features & (feature)) != 0u)

// Density, or sigma_t of each channel, within the box.
vec3 matter_at(vec3 uvw)
{
    vec3 m = vec3(textureLod(density_tex, uvw, 0.0).r);
    if (medium_mode != TYN_MEDIUM_DENSITY) {
        vec3 sigma_s = textureLod(density_tex, uvw, 0.0).rgb;
        if (gradient_has(GRADIENT_MULTIPLE)) {
            sigma_s = delta_scaled(sigma_s, medium_phase(uvw));
        }
        m = sigma_s + textureLod(sigma_a_tex, uvw, 0.0).rgb;
    }
    return m;
}

// What `matter_at` is to be multiplied with, 1/m.
vec3 matter_unit()
{
    const vec3 sigma_s =
        gradient_has(GRADIENT_MULTIPLE) ? delta_scaled(medium.sigma_s, medium.phase) : medium.sigma_s;
    return medium_mode == TYN_MEDIUM_DENSITY ? sigma_s + medium.sigma_a : vec3(1.0);
}

// Transmittance from p, at most `reach` metres along `way`.
vec3 transmittance_along(vec3 p, vec3 way, float reach)
{
    const vec2 span = ray_box(p, ray_inverse(way), vec3(0.0), medium.extent);
    const float from = max(span.x, 0.0), along = max(min(span.y, reach) - from, 0.0);
    const vec3 uvw = (p + from * way) / medium.extent, by = way / medium.extent;
    const vec3 unit = matter_unit();
    const int count = int(ceil(along / args.step));
    vec3 sum = vec3(0.0);
    float least = 0.0;
    for (int j = 0; j < count && least < GRADIENT_DARK; j += GRADIENT_AT_ONCE) {
        [[unroll]] for (int k = 0; k < GRADIENT_AT_ONCE; k++) {
            const float at = float(j + k) * args.step, ds = clamp(along - at, 0.0, args.step);
            sum += ds * matter_at(uvw + (at + 0.5 * ds) * by);
        }
        const vec3 depth = unit * sum;
        least = min(min(depth.r, depth.g), depth.b);
    }
    return exp(-unit * sum);
}

// The place of the box nearest to p: beside it light has not gone through the medium.
vec3 within_box(vec3 p)
{
    return clamp(p, 1e-6 * medium.extent, (1.0 - 1e-6) * medium.extent);
}

// From the eye towards p, unit.
vec3 view_at(vec3 p)
{
    const vec3 v = p - camera.origin;
    return camera_select(camera, camera.forward, v / max(length(v), 1e-20));
}

float distance_to_eye(vec3 p)
{
    return camera_select(camera, 3.4e38, length(p - camera.origin));
}

// Phase functions of the channels for light that travels along `along`, spread as `mean_cosine` says.
vec3 phases_of(phase phases[3], vec3 along, float mean_cosine, vec3 view)
{
    // Light travels along -view after.
    const vec3 apart = along + view;
    const float one_minus_mu = 0.5 * dot(apart, apart);
    vec3 scattered = vec3(phase_near(phases[0], mean_cosine, one_minus_mu));
    if (phases[1] != phases[0] || phases[2] != phases[0]) {
        scattered.g = phase_near(phases[1], mean_cosine, one_minus_mu);
        scattered.b = phase_near(phases[2], mean_cosine, one_minus_mu);
    }
    return scattered;
}

// What is scattered towards the eye of the directions that a light of the list stands for, by their shares, past surfaces. Where no
// direction is lit for sure (shadow_look.glsl) it is dark, so that closed rooms are.
vec3 sky_scattered(uvec2 range, vec3 p, vec3 view, phase phases[3])
{
    vec3 sum = vec3(0.0);
    bool sure = !gradient_has(GRADIENT_MAPS) || range.y < 2u;
    for (uint k = 0u; k < range.y; k++) {
        const int row = int(TYN_LIGHT_LIST_MAX + 2u * (range.x + k));
        const uvec2 shade = texelFetch(light_shades_texels, row).xy;
        const vec4 from = uintBitsToFloat(texelFetch(light_shades_texels, row + 1));
        uint by = SHADOW_LIT_BY_HALF;
        if (gradient_has(GRADIENT_MAPS)) {
            by = sky_map_lights(sky_map_of(shade.x), p);
            sure = sure || (by & SHADOW_LIT_BY_ALL) != 0u;
        }
        if ((by & SHADOW_LIT_BY_HALF) != 0u) {
            sum += uintBitsToFloat(shade.y) * phases_of(phases, from.xyz, from.w, view);
        }
    }
    return sure ? sum : vec3(0.0);
}

// Of a light with a shadow map; with soft edges the mean over a cube about p.
float map_visibility(uint shadow, vec3 p)
{
    if (!gradient_has(GRADIENT_SOFT)) {
        return shadow_visibility(shadow, p);
    }
    float lit = 0.0;
    for (int k = 0; k < 8; k++) {
        lit += 0.125 * shadow_visibility(shadow, p + args.soft * (0.5 * vec3(k & 1, k >> 1 & 1, k >> 2) - 0.25));
    }
    return lit;
}

// Light at p that has scattered before, scattered towards the eye.
vec3 scattered_at(vec3 p)
{
    const ivec3 size = textureSize(scattered_tex, 0);
    vec3 found = textureLod(scattered_tex, lattice_inscatter_uvw(medium.extent, size, p), 0.0).rgb;
    if (gradient_has(GRADIENT_WALLS)) {
        const lattice_box box = lattice_box_of(medium.extent, size - 2);
        const walls_place at = walls_place_of(box, p);
        if (walls_near(at)) {
            found = walls_fetch(scattered_tex, box, walls_blend_of(box, at, p), ivec3(1)).rgb;
        }
    }
    return gradient_has(GRADIENT_ONE_CHANNEL) ? found.r * args.tint : found;
}

// `nearest`: lamps count as at least so far away, m, as p stands for what is about it.
vec3 light_of(uint n, vec3 p, vec3 view, phase phases[3], float nearest)
{
    const listed_light l = listed_light_of(n);
    vec3 towards = -l.direction, color = l.color;
    float reach = 3.4e38;
    if (gradient_has(GRADIENT_LAMPS) && l.kind != TYN_LIGHT_KIND_DIRECTIONAL) {
        const vec3 way = l.position - p;
        const float r2 = dot(way, way);
        reach = sqrt(r2);
        towards = way / max(reach, 1e-20);
        color *= listed_light_lobe(l, -towards) / max(r2, nearest * nearest);
    }
    const uvec2 range = gradient_has(GRADIENT_SKY) ? texelFetch(light_shades_texels, int(n)).xy : uvec2(0u);
    if (range.y > 0u) {
        color *= sky_scattered(range, p, view, phases);
    } else {
        if (gradient_has(GRADIENT_SHADOWS) && l.shadow != TYN_LIGHT_NO_SHADOW) {
            color *= map_visibility(l.shadow, p);
        }
        color *= phases_of(phases, -towards, l.mean_cosine, view);
    }
    // Nothing is followed to a light that does not shine here.
    const bool lit = max(max(color.r, color.g), color.b) > 0.0;
    return color * transmittance_along(p, towards, lit ? reach : 0.0);
}

// p within the box.
vec3 light_at(vec3 p, float nearest)
{
    const vec3 view = view_at(p);
    vec3 weight = vec3(1.0);
    phase phases[3] = medium.phase;
    if (medium_mode != TYN_MEDIUM_DENSITY) {
        phases = medium_phase(p / medium.extent);
    }
    similarity_clamp(weight, phases);
    if (gradient_has(GRADIENT_MULTIPLE)) {
        weight = 1.0 / (1.0 - delta_fraction(phases)); // the march scales what it reads
    }
    vec3 sum = vec3(0.0);
    const uint count = listed_lights();
    for (uint n = 0u; n < count; n++) {
        sum += light_of(n, p, view, phases, nearest);
    }
    sum *= weight;
    if (gradient_has(GRADIENT_MULTIPLE)) {
        sum += scattered_at(p);
    }
    return sum;
}

// `light`, or 0 where it is not finite, counted.
vec3 finite_light(vec3 light)
{
    if (any(isnan(light)) || any(isinf(light))) {
        atomicAdd(counters.non_finite, 1u);
        light = vec3(0.0);
    }
    return light;
}
