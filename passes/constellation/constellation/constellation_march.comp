// constellation_march.comp -- slices back to front, a thread a pixel. Built for mode DENSITY and for the others.
//
//   L <- e^-x L + W sigma_s (sum over lights of E T p) (1 - e^-x) / sigma_t,  x = sigma_t times the slice's thickness
//
// (Eqs 4 and 5 with the slice's own integral; CONSTELLATION_PRINTED: e^-x times the thickness, as printed). W is the share
// of the pixel that no surface before the slice hides. A dispatch lights `rounds` slices of each ray, or one by some of the
// lights, and hands the rays on in the images `state_*`; neighbouring rays look for their next slice together and light it
// together.
#include "constellation_args.h"
#include "shaders/common/camera.glsl"
#include "shaders/common/counters.h"

layout(constant_id = 1) const uint constellation_features = 0u;
layout(constant_id = 2) const uint constellation_lighting = CONSTELLATION_SHADOWED;

// A macro: its value is a specialization constant, and engine/gpu/specialize.c drops what is off.
#define constellation_has(feature) ((constellation_features & (feature)) != 0u)

layout(local_size_x = 8, local_size_y = 8) in;
TYN_ARGS(constellation_args args);
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
layout(binding = 5) uniform sampler3D voxels_tex;
layout(binding = 6) uniform usamplerBuffer light_list_texels;
#include "passes/light_list/common/light_list.glsl"
#define SHADOWS_AT 7
#include "shaders/light/shadow.glsl"
TYN_UNIFORM(9, camera, camera_block camera);
TYN_UNIFORM(10, environment, env_block environment);
layout(binding = 11) uniform sampler2D env_map_wrapped;
layout(binding = 12) uniform sampler2D host_depth_tex;
layout(binding = 13) uniform sampler2D mask_tex;
#define SURFACE_RADIANCE 14
#define GBUFFER_AT 15
#include "shaders/march/background.glsl"
#include "shaders/march/host_depth.glsl"
#include "shaders/march/surface_samples.glsl"
layout(binding = 16, rgba32f) uniform image2D state_light;
layout(binding = 17, rgba32f) uniform image2D state_through;
layout(binding = 18, rgba32f) uniform image2D state_uncovered;
layout(binding = 19, rgba32f) uniform writeonly image2D radiance_image;
layout(binding = 20, rgba32f) uniform writeonly image2D transmittance_image;
layout(binding = 21, rgba32f) uniform writeonly image2D depth_image;
TYN_UPDATE(22, counters, counters_block counters);
#include "../common/slices.glsl"
#include "constellation_medium.glsl"
#include "constellation_lighting.glsl"
#include "constellation_behind.glsl"

// A ray on its way from behind.
struct ray_state {
    vec3 light;       // towards the eye, W/(m^2 sr)
    vec3 through;     // of a radiance of 1 behind everything, how much is left
    vec3 uncovered;   // ... behind all but the scene's surfaces that are seen
    float at;         // m from the eye: all that is farther away is in
    int next;         // slice; < 0: none is left
};

ray_state ray_state_load(ivec2 pixel)
{
    const vec4 a = imageLoad(state_light, pixel), b = imageLoad(state_through, pixel);
    return ray_state(a.rgb, b.rgb, imageLoad(state_uncovered, pixel).rgb, b.a, int(a.a));
}

void ray_state_store(ivec2 pixel, const ray_state r)
{
    imageStore(state_light, pixel, vec4(r.light, float(r.next)));
    imageStore(state_through, pixel, vec4(r.through, r.at));
    imageStore(state_uncovered, pixel, vec4(r.uncovered, 0.0));
}

// Adds `share` of the surface, attenuated by `left`.
void add_surface(inout ray_state r, vec3 radiance, float share, vec3 left)
{
    const bool seen = constellation_has(CONSTELLATION_SURFACE_SEEN);
    r.light += seen ? share * left * radiance : vec3(0.0);
    r.through += share * left;
    r.uncovered += seen ? vec3(0.0) : share * left;
}

// Surfaces between `to` and where the ray is.
void add_surfaces_behind(inout ray_state r, const behind b, float to)
{
    if (constellation_has(CONSTELLATION_SURFACE)) {
        [[unroll]] for (uint i = 0u; i < BEHIND_MAX; i++) {
            if (b.away[i] > to && b.away[i] <= r.at && b.away[i] < TYN_INFINITY) {
                add_surface(r, b.radiance[i], b.share[i], vec3(1.0));
            }
        }
        r.at = min(r.at, to);
    }
}

ray_state ray_state_begin(ivec2 pixel, vec3 direction, const behind b, const slices s)
{
    ray_state r;
    r.light = vec3(0.0);
    r.through = r.uncovered = vec3(b.open);
    r.at = 3.0e38;
    if (constellation_has(CONSTELLATION_BACKGROUND) && b.open > 0.0 && b.host == TYN_INFINITY) {
        r.light = b.open * background_radiance(environment, env_map_wrapped, camera, direction, vec2(pixel) + 0.5, 1.0);
    }
    r.next = s.count - 1;
    if (constellation_has(CONSTELLATION_MASK)) {
        r.next = min(r.next, int(texelFetch(mask_tex, pixel, 0).a));
    }
    return r;
}

// What slice i brings, `s.extinction` etc. its medium at p.
void add_slice(inout ray_state r, const behind b, const slices cut, int i, vec3 p, vec3 view, const sample_point s)
{
    const vec2 span = slice_span(args.slices, cut, i);
    const float ds = max(span.y - span.x, 0.0);
    const vec3 x = s.extinction * ds, e = exp(-x);
    vec3 weight;
    if (constellation_has(CONSTELLATION_PRINTED)) {
        weight = ds * e;
    } else { // (1 - e^-x) / x; the series where the difference would lose digits
        const vec3 series = 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0)));
        weight = ds * mix(series, (1.0 - e) / max(x, 1e-30), greaterThan(x, vec3(0.03)));
    }
    vec3 source = s.scattering * scattered_light(p, view, s);
    const vec2 away = cut.start + span;
    const bool first = args.light_begin == 0u;
    if (first) {
        if (constellation_has(CONSTELLATION_EMISSION)) {
            source += s.emission;
        }
        add_surfaces_behind(r, b, away.y);
        r.light *= e;
        r.through *= e;
        r.uncovered *= e;
    }
    float share = b.open;
    if (constellation_has(CONSTELLATION_SURFACE)) {
        [[unroll]] for (uint k = 0u; k < BEHIND_MAX; k++) {
            const bool is = b.away[k] < TYN_INFINITY;
            const float part = is ? clamp((b.away[k] - away.x) / max(ds, 1e-30), 0.0, 1.0) : 0.0;
            share += part * b.share[k];
            if (first && is && b.away[k] > away.x && b.away[k] <= away.y) {
                add_surface(r, b.radiance[k], b.share[k], exp(-part * x));
            }
        }
        r.at = min(r.at, away.x);
    }
    r.light += share * weight * source;
}

// Where the mean transmittance falls to 1/2, m from the eye, or infinity: the same slices from the front.
float half_distance(vec3 uvw, vec3 along, const slices cut)
{
    float found = TYN_INFINITY;
    vec3 depth = vec3(0.0);
    for (int i = 0; i < cut.count && found == TYN_INFINITY; i++) {
        const vec2 span = slice_span(args.slices, cut, i);
        const float ds = max(span.y - span.x, 0.0);
        const vec4 v = textureLod(voxels_tex, uvw + slice_at(args.slices, cut, i) * along, 0.0);
        const vec3 x = extinction_of(matter_of(v)) * ds;
        const float t0 = dot(exp(-depth), vec3(1.0 / 3.0)), t1 = dot(exp(-depth - x), vec3(1.0 / 3.0));
        depth += x;
        found = t1 <= 0.5 ? cut.start + span.x + ds * log(2.0 * t0) / max(log(t0 / t1), 1e-30) : found;
    }
    return found;
}

void store(ivec2 pixel, ray_state r, float nearest, float half_away)
{
    if (any(isnan(r.light)) || any(isinf(r.light)) || any(isnan(r.through)) || any(isinf(r.through))) {
        atomicAdd(counters.non_finite, 1u);
        r.light = vec3(0.0);
        r.through = r.uncovered = vec3(1.0);
    }
    const float cover = constellation_has(CONSTELLATION_BACKGROUND) ? 1.0 : 1.0 - dot(r.uncovered, vec3(1.0 / 3.0));
    imageStore(radiance_image, pixel, vec4(r.light, cover));
    if (constellation_has(CONSTELLATION_TRANSMITTANCE)) {
        imageStore(transmittance_image, pixel, vec4(r.through, 1.0));
    }
    if (constellation_has(CONSTELLATION_DEPTH)) {
        imageStore(depth_image, pixel, vec4(nearest, half_away, 0.0, 0.0));
    }
}

void main()
{
    // Any 8 threads in a row are a block of 4x2 pixels, whose rays are alike.
    const uint i = gl_LocalInvocationIndex;
    const uvec2 at_8 = uvec2((i & 3u) | (i >> 1 & 4u), (i >> 2 & 1u) | (i >> 3 & 6u));
    const ivec2 pixel = ivec2(8u * gl_WorkGroupID.xy + at_8);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) {
        return;
    }
    const camera_ray ray = camera_ray_through(camera, vec2(pixel) + 0.5);
    const behind b = behind_pixel(pixel, ray.direction);
    vec2 span = ray_box(ray.origin, ray_inverse(ray.direction), vec3(0.0), medium.extent);
    span.x = max(span.x, 0.0);
    const slices cut = slices_of(args.slices, vec2(span.x, min(span.y, behind_end(b))));
    const vec3 origin = ray.origin + cut.start * ray.direction;
    const vec3 uvw = origin / medium.extent, along = ray.direction / medium.extent;

    ray_state r;
    if (args.first != 0u) {
        r = ray_state_begin(pixel, ray.direction, b, cut);
    } else {
        r = ray_state_load(pixel);
    }
    uint lit = 0u;
    for (uint round = 0u; round < args.rounds && r.next >= 0; round++) {
        bool found = false;
        MATTER m = MATTER(0.0);
        vec3 at = uvw;
        while (!found && r.next >= 0) {
            at = uvw + slice_at(args.slices, cut, r.next) * along;
            const vec4 v = textureLod(voxels_tex, at, 0.0);
            m = matter_of(v);
            // Without the distance map every slice is lit, as in Program 1.
            found = !constellation_has(CONSTELLATION_DISTANCE) || !is_empty(m, at);
            r.next -= found ? 0 : 1 + slices_skipped(args.slices, away_of(v));
        }
        if (found) {
            add_slice(r, b, cut, r.next, at * medium.extent, ray.direction, sample_point_of(m, at));
            r.next -= args.light_end == ~0u ? 1 : 0;
            lit += args.light_begin == 0u ? 1u : 0u;
        }
    }
    if (lit > 0u) {
        atomicAdd(counters.steps, lit);
    }
    if (args.last == 0u) {
        ray_state_store(pixel, r);
        return;
    }
    add_surfaces_behind(r, b, 0.0);
    if (cut.count > 0) {
        atomicAdd(counters.pixels, 1u);
    }
    float half_away = TYN_INFINITY;
    if (constellation_has(CONSTELLATION_DEPTH)) {
        half_away = half_distance(uvw, along, cut);
    }
    store(pixel, r, b.nearest, half_away);
}
