// lpv_scatter.comp -- a thread a ray of a light: at random places of its lit part, light that scatters there.
#include "lpv_scatter_args.h"
#include "shaders/common/counters.h"
#include "shaders/random/rng.glsl"
#define MEDIUM_AT 0
#define BEAMS_AT 6
#define RADIALS_AT 10
#define RADIALS_TEXELS
#define SHADOWS_AT 14
#define SHADOWS_TEXELS
#define WALLS_AT 16
#include "shaders/medium/medium.glsl"
#include "shaders/beams/beam.glsl"
#include "shaders/beams/radial.glsl"
#include "../common/lamp_depth.glsl"
#include "shaders/light/shadow.glsl"
#include "../common/deposit.glsl"
#include "shaders/common/camera.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/lattice/lattice_sweep.glsl"
#include "shaders/walls/lattice_walls.glsl"

layout(local_size_x = LPV_SCATTER_SIDE, local_size_y = LPV_SCATTER_SIDE) in;
TYN_ARGS(lpv_scatter_args args);
TYN_READ(5, lights, light_block lights[]);
TYN_READ(18, rays, lpv_scatter_bundle rays[]);
TYN_UPDATE(19, scattered, float scattered_unit; uint scattered_pad[3]; int scattered[]);
TYN_UPDATE(20, counters, counters_block counters);
layout(constant_id = 1) const uint shadowed = 0;
layout(constant_id = 2) const uint walls = 0;

// How far along a ray its light gets, past the surfaces of the map: of the four texels around the ray the nearest counts, so
// that nothing leaks around edges into closed rooms.
float lit_until(uint light, vec3 o, vec3 d)
{
    shadow_light l = shadow_light_of(light);
    vec3 q = shadow_frame(l, o), way = shadow_frame_direction(l, d);
    bool sun = l.kind == TYN_SHADOW_SUN;
    uint face = l.kind == TYN_SHADOW_CUBE ? shadow_face(way) : 0u;
    way = l.kind == TYN_SHADOW_CUBE ? shadow_on_face(face, way) : way;
    shadow_place place;
    if (sun) {
        place = shadow_place_sun(l, q);
    } else { // the ray leaves the lamp
        place = shadow_place_lamp(l, face, way * (2.0 * l.near / max(way.z, 1e-20)));
    }
    if (l.kind == TYN_SHADOW_NONE || !place.inside) {
        return 1e30;
    }
    vec2 first;
    vec4 around = shadow_gather(shadow_atlas, place, first);
    float stored = max(max(around.x, around.y), max(around.z, around.w));
    if (stored <= 0.0) {
        return 1e30;
    }
    return sun ? (q.z - stored) / max(-way.z, 1e-30) : l.near / (stored * max(way.z, 1e-20));
}

void main()
{
    lpv_scatter_bundle bundle = rays[args.first + gl_WorkGroupID.z];
    uint grid = lamp_grid_of(bundle.light);
    if (gl_GlobalInvocationID == uvec3(0)) {
        scattered_unit = args.unit;
    }
    uvec2 ray = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(ray, uvec2(bundle.texels)))) {
        return;
    }
    vec2 at = (vec2(ray) + 0.5) / float(bundle.texels);
    vec3 o = bundle.origin + at.x * bundle.origin_u + at.y * bundle.origin_v;
    vec3 d = bundle.direction + at.x * bundle.direction_u + at.y * bundle.direction_v;
    float far = length(d), measure = bundle.measure / float(bundle.texels * bundle.texels);
    d /= far;
    vec3 power;
    if (bundle.light < TYN_SHADOW_SUNS) {
        power = measure * lights[bundle.light].color;
    } else {
        light_block lamp = radial_grid_of(grid).light;
        // Of a texel of the plane at 1: its solid angle.
        power = measure / (far * far * far) * light_lobe(lamp, dot(d, lamp.direction)) * lamp.color;
    }
    lattice_box box = lattice_box_of(medium.extent, ivec3(args.dims));
    vec2 span = ray_box(o, ray_inverse(d), vec3(0.0), medium.extent);
    span.x = max(span.x, 0.0);
    if (shadowed == 1u) {
        span.y = min(span.y, lit_until(bundle.light, o, d));
    }
    if (!(span.y > span.x) || power.r + power.g + power.b <= 0.0) {
        return;
    }
    float ds = (span.y - span.x) / float(args.samples);
    float most = min(args.majorant * ds, 1.0);
    uvec4 bits = uvec4(0u), dither = uvec4(0u);
    for (uint k = 0u; k < args.samples; k++) {
        if (k % 4u == 0u) {
            bits = rng_pcg4d(uvec4(ray, args.first + gl_WorkGroupID.z, k));
            dither = rng_pcg4d(bits);
        }
        vec3 p = o + (span.x + (float(k) + rng_float(bits[k % 4u])) * ds) * d;
        ivec3 c = clamp(ivec3(floor(lattice_from_m(box, p))), ivec3(0), box.dims - 1);
        uint cell = lattice_index(box, c);
        if (walls == 1u && walls_behind(walls_planes_of(cell), p) != 0u) {
            continue; // the cell belongs to the other side
        }
        medium_point m = medium_sample(p);
        similarity_clamp(m.sigma_s, m.phase);
        vec3 g = delta_cosine(m.phase);
        vec3 share = (1.0 - delta_fraction(m.phase)) * m.sigma_s * ds * lamp_transmittance(bundle.light, grid, p);
        if (any(isnan(share)) || any(isinf(share))) {
            atomicAdd(counters.non_finite, 1u);
            continue;
        }
        if (any(greaterThan(share, vec3(1.0)))) {
            atomicAdd(counters.clamped, 1u);
        }
        vec3 light = power * min(share, vec3(most)) / args.unit;
        for (uint ch = 0u; ch < args.channels; ch++) {
            uint at_cell = 4u * (ch * args.dims.x * args.dims.y * args.dims.z + cell);
            vec4 lobe = lattice_channel(light, args.channels, ch, args.tint) * vec4(1.0, g[ch] * d);
            DEPOSIT_ADD(scattered, at_cell, lobe, rng_float(dither[k % 4u]))
        }
    }
}
