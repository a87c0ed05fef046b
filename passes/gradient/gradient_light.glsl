// gradient_light.glsl -- radiance that all lights together send towards the eye at a point, per sigma_s: Eq 1, of any lights and
// phase functions.
//
// Include after medium.glsl, camera.glsl, light_list.glsl and, with surfaces, shadow.glsl.
#ifndef TYN_GRADIENT_LIGHT_GLSL
#define TYN_GRADIENT_LIGHT_GLSL

layout(constant_id = 1) const uint gradient_features = 0u;

const float GRADIENT_DARK = 20.0; // optical depth behind which a light is not followed: e^-20 = 2e-9
const int GRADIENT_AT_ONCE = 4;   // steps of a ray in a turn of its loop

bool gradient_has(uint feature)
{
    return (gradient_features & feature) != 0u;
}

// Density, or sigma_t of each channel, within the box.
vec3 matter_at(vec3 uvw)
{
    vec3 m = vec3(textureLod(density_tex, uvw, 0.0).r);
    if (medium_mode != TYN_MEDIUM_DENSITY) {
        m = textureLod(density_tex, uvw, 0.0).rgb + textureLod(sigma_a_tex, uvw, 0.0).rgb;
    }
    return m;
}

// Transmittance from p, at most `reach` metres along `way`.
vec3 transmittance_along(vec3 p, vec3 way, float reach)
{
    const vec2 span = ray_box(p, ray_inverse(way), vec3(0.0), medium.extent);
    const float from = max(span.x, 0.0), along = max(min(span.y, reach) - from, 0.0);
    const vec3 uvw = (p + from * way) / medium.extent, by = way / medium.extent;
    const vec3 unit = medium_mode == TYN_MEDIUM_DENSITY ? medium.sigma_s + medium.sigma_a : vec3(1.0);
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

// `nearest`: lamps count as at least so far away, m, as p stands for what is about it.
vec3 light_of(listed_light l, vec3 p, vec3 view, phase phases[3], float nearest)
{
    vec3 towards = -l.direction, color = l.color;
    float reach = 3.4e38;
    if (gradient_has(GRADIENT_LAMPS) && l.kind != TYN_LIGHT_KIND_DIRECTIONAL) {
        const vec3 way = l.position - p;
        const float r2 = dot(way, way);
        reach = sqrt(r2);
        towards = way / max(reach, 1e-20);
        color *= listed_light_lobe(l, -towards) / max(r2, nearest * nearest);
    }
    if (gradient_has(GRADIENT_SHADOWS) && l.shadow != TYN_LIGHT_NO_SHADOW) {
        color *= shadow_visibility(l.shadow, p);
    }
    // Light travels along -towards before and along -view after.
    const vec3 apart = towards - view;
    const float one_minus_mu = 0.5 * dot(apart, apart);
    vec3 scattered;
    [[unroll]] for (int c = 0; c < 3; c++) {
        scattered[c] = phase_near(phases[c], l.mean_cosine, one_minus_mu);
    }
    color *= scattered;
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
        phases = phase_of_mean_cosine(textureLod(g_tex, p / medium.extent, 0.0).rgb);
    }
    similarity_clamp(weight, phases);
    vec3 sum = vec3(0.0);
    const uint count = listed_lights();
    for (uint n = 0u; n < count; n++) {
        sum += light_of(listed_light_of(n), p, view, phases, nearest);
    }
    return weight * sum;
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

#endif
