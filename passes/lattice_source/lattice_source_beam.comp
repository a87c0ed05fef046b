// lattice_source_beam.comp -- T', the unscattered part of one sun, averaged over a cell.
//
// The mean is weighted with sigma_s', so that sigma_s' T' is the cell's true first scattering; with
// sigma_a where nothing scatters. Each sub-sample is the mean along the light over its own length:
// e^-tau sinh(x) / x with tau to its centre. Where one is dense that is not enough: light that comes in obliquely
// through a face is at the face everywhere in it, not where its own length ends. There the mean is that over the cube,
// e^-tau times sinh(a_i) / a_i for each axis, with tau as linear as the gradient says: along the light it is the
// extinction, across it, it is measured over the cell. Without it a face that the
// sun grazes was dark, and the one it is square to too bright.
// What surfaces keep from the cell is the fraction of that light that it does not see: kept apart, because
// the beam's energy is compared without surfaces.
#include "shaders/lattice/lattice_args.h"
#define MEDIUM_AT 0
#define BEAMS_AT 5
#include "shaders/medium/medium.glsl"
#include "shaders/beams/beam.glsl"
#include "shaders/lattice/lattice.glsl"
#define WALLS_AT 10
#define WALLS_STORAGE
#include "shaders/walls/lattice_walls.glsl"
#define SHADOWS_AT 12
#define SHADOWS_STORAGE
#include "shaders/light/shadow.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_source_args args);
// Suns stacked along z: T' per colour channel; a = the part of that light which no surface stops.
layout(binding = 9, rgba32f) uniform writeonly image3D sunlit;

layout(binding = 14) uniform sampler3D cells;

layout(constant_id = 1) const uint num_channels = 3;
layout(constant_id = 2) const uint walls = 0;
layout(constant_id = 3) const uint shadowed = 0;

const float DENSE = 0.25; // half depth of a sub-sample from which on its mean is taken over the cube

float sum3(vec3 v)
{
    return v.x + v.y + v.z;
}

// Gradient of the depth, summed over channels, across the light: from four corners of the middle half of what
// the cell has of the medium, 1/m.
vec3 depth_across(uint sun, const lattice_box box, ivec3 c, vec3 direction)
{
    vec3 lo = max(lattice_to_m(box, vec3(c)), vec3(0.0));
    vec3 hi = min(lattice_to_m(box, vec3(c + 1)), medium.extent);
    vec3 reach = 0.25 * max(hi - lo, vec3(1e-3 * box.dx)), sum = vec3(0.0);
    for (uint corner = 0; corner < 4; corner++) {
        vec3 way = vec3(corner < 2 ? 1.0 : -1.0, corner % 2 == 0 ? 1.0 : -1.0,
                        corner == 0 || corner == 3 ? 1.0 : -1.0);
        beam_tau tau = beam_depth(sun, 0.5 * (lo + hi) + way * reach);
        sum += way * sum3(tau.a + tau.p);
    }
    vec3 gradient = 0.25 * sum / reach;
    return gradient - dot(gradient, direction) * direction;
}

// Mean of e^-tau over a cube of edge `size` with depth `centre` in its middle.
float mean_over_cube(float centre, vec3 gradient, float size)
{
    vec3 a = max(0.5 * size * abs(gradient), vec3(1e-3));
    a *= min(centre / sum3(a), 1.0); // nowhere in it is a depth negative
    a = max(a, vec3(1e-3));
    vec3 means = (1.0 - exp(-2.0 * a)) / (2.0 * a); // each is e^-a sinh(a) / a
    return exp(-max(centre - sum3(a), 0.0)) * means.x * means.y * means.z;
}

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    uint sun = args.sun;
    if (any(greaterThanEqual(c, dims))) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, dims);
    vec3 direction = beams[sun].direction, d = abs(direction);
    vec3 weighted = vec3(0.0), weight = vec3(0.0);
    vec3 across = vec3(0.0);
    float depth = 0.0; // of a sub-sample, half, as the cell has it on average
    for (int ch = 0; ch < int(args.channels); ch++) {
        vec4 cell = texelFetch(cells, c + ivec3(0, 0, ch * dims.z), 0);
        depth = max(depth, 0.5 * box.dx / float(args.samples) * (cell.x + cell.y));
    }
    bool dense = depth > DENSE;
    if (dense) { // threads without it pass by
        across = depth_across(sun, box, c, direction);
    }
    walls_planes planes;
    if (walls == 1) {
        planes = walls_planes_of(lattice_index(box, c));
    }
    shadow_light shadow;
    if (shadowed == 1) {
        shadow = shadows[beams[sun].light];
    }
    vec2 seen = vec2(0.0); // of the light in all channels: by the cell, and all
    bool any_lit = false;  // for sure: all that is looked at is on one side of the cell's walls
    float step_length = box.dx / float(args.samples);
    float length_h = step_length / max(d.x, max(d.y, d.z)); // of a sub-sample along the light
    for (uint k = 0; k < args.samples; k++) {
        for (uint j = 0; j < args.samples; j++) {
            vec3 row = lattice_to_m(box, vec3(c) + (vec3(0, j, k) + 0.5) / float(args.samples));
            beam_ray ray = beam_ray_of(sun, row, vec3(1.0, 0.0, 0.0));
            for (uint i = 0; i < args.samples; i++) {
                float s = float(i) * step_length;
                if (walls == 1 && walls_behind(planes, row + vec3(s, 0.0, 0.0)) != 0u) {
                    continue;
                }
                medium_point m = medium_sample(row + vec3(s, 0.0, 0.0));
                m.sigma_a = medium_mode == TYN_MEDIUM_DENSITY ? m.sigma_a : vec3(0.0); // left out of unequal media
                vec3 scaled = delta_scaled(m.sigma_s, m.phase);
                vec3 w = scaled + 1e-6 * m.sigma_a;
                if (w.r + w.g + w.b <= 0.0) {
                    continue;
                }
                beam_tau tau = beam_depth_at(beam_ray_at(ray, s));
                vec3 x = 0.5 * length_h * (scaled + m.sigma_a), centre = tau.a + tau.p;
                vec3 t = vec3(mean_transmittance(centre.r, x.r));
                if (num_channels == 3) {
                    t.g = mean_transmittance(centre.g, x.g);
                    t.b = mean_transmittance(centre.b, x.b);
                }
                if (dense) {
                    vec3 extinction = scaled + m.sigma_a, ahead = direction;
                    vec3 sideways = across / max(sum3(extinction), 1e-30);
                    for (uint ch = 0; ch < num_channels; ch++) {
                        // At least that along the light: gradients of what is ragged split it up.
                        t[ch] = max(t[ch], mean_over_cube(centre[ch], extinction[ch] * (ahead + sideways),
                                                          step_length));
                    }
                    t = num_channels == 3 ? t : t.rrr;
                }
                weighted += w * t;
                weight += w;
                if (shadowed == 1) {
                    float light = dot(w * t, vec3(1.0));
                    uint by = shadow_sun_lights(shadow, row + vec3(s, 0.0, 0.0));
                    any_lit = any_lit || (by & SHADOW_LIT_BY_ALL) != 0u;
                    seen += light * vec2((by & SHADOW_LIT_BY_HALF) != 0u ? 1.0 : 0.0, 1.0);
                }
            }
        }
    }
    vec3 t = mix(vec3(0.0), weighted / max(weight, vec3(1e-30)), greaterThan(weight, vec3(0.0)));
    float visible = shadowed == 1 && seen.y > 0.0 ? (any_lit ? seen.x / seen.y : 0.0) : 1.0;
    imageStore(sunlit, c + ivec3(0, 0, int(sun) * dims.z), vec4(t, visible));
}
