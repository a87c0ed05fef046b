// lattice_source_beam.comp -- T', the unscattered part of one sun, averaged over a cell.
//
// The mean is weighted with sigma_s', so that sigma_s' T' is the cell's true first scattering; with
// sigma_a where nothing scatters. Each sub-sample is the mean along the light over its own length:
// e^-tau sinh(x) / x with tau to its centre. What surfaces keep from the cell is the fraction of that light
// that it does not see: kept apart, because the beam's energy is compared without surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lattice_args.h"
#define MEDIUM_BLOCK 0
#define MEDIUM_DENSITY 1
#define MEDIUM_G 2
#define BEAM_BLOCKS 3
#define BEAM_COLUMN 4
#define BEAM_TAU_A 5
#define BEAM_TAU_P 6
#include "medium.glsl"
#include "beam.glsl"
#include "lattice.glsl"
#define WALLS_LINKS 8
#define WALLS_CELLS 9
#include "lattice_walls.glsl"
#define SHADOW_ATLAS 10
#define SHADOW_LIGHTS 11
#include "shadow.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(push_constant, scalar) uniform push
{
    lattice_source_args args;
};
// Suns stacked along z: T' per colour channel; a = the part of that light which no surface stops.
layout(binding = 7, rgba32f) uniform writeonly image3D sunlit;

layout(constant_id = 1) const uint num_channels = 3;
layout(constant_id = 2) const uint walls = 0;
layout(constant_id = 3) const uint shadowed = 0;

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    ivec3 c = ivec3(texel.xy, texel.z % dims.z);
    uint sun = uint(texel.z / dims.z);
    if (any(greaterThanEqual(c, dims)) || sun >= args.num_suns) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, dims);
    vec3 d = abs(beams[sun].direction);
    vec3 weighted = vec3(0.0), weight = vec3(0.0);
    vec2 seen = vec2(0.0); // of the light in all channels: by the cell, and all
    float step_length = box.dx / float(args.samples);
    float length_h = step_length / max(d.x, max(d.y, d.z)); // of a sub-sample along the light
    for (uint k = 0; k < args.samples; k++) {
        for (uint j = 0; j < args.samples; j++) {
            vec3 row = lattice_to_m(box, vec3(c) + (vec3(0, j, k) + 0.5) / float(args.samples));
            beam_ray ray = beam_ray_of(sun, row, vec3(1.0, 0.0, 0.0));
            for (uint i = 0; i < args.samples; i++) {
                float s = float(i) * step_length;
                if (walls == 1 && !walls_same_side(box, c, row + vec3(s, 0.0, 0.0))) {
                    continue;
                }
                medium_point m = medium_sample(row + vec3(s, 0.0, 0.0));
                similarity_clamp(m.sigma_s, m.g);
                vec3 scaled = (1.0 - delta_fraction(m.g)) * m.sigma_s;
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
                weighted += w * t;
                weight += w;
                if (shadowed == 1) {
                    float light = dot(w * t, vec3(1.0));
                    seen += light * vec2(shadow_visibility_sun(beams[sun].light,
                                                               row + vec3(s, 0.0, 0.0)),
                                         1.0);
                }
            }
        }
    }
    vec3 t = mix(vec3(0.0), weighted / max(weight, vec3(1e-30)), greaterThan(weight, vec3(0.0)));
    float visible = shadowed == 1 && seen.y > 0.0 ? seen.x / seen.y : 1.0;
    imageStore(sunlit, texel, vec4(t, visible));
}
