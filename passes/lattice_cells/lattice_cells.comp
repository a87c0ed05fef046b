// lattice_cells.comp -- delta-scaled coefficients averaged over a cell.
//
// Averages are over the whole cell, the part outside the medium counting as 0: the optical depth of
// every line of sight is kept in the mean, and so is the power that beams lose.
#include "shaders/lattice/lattice_args.h"
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/lattice/lattice.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_cells_args args);
layout(binding = 5, rgba32f) uniform writeonly image3D cells;

// Optical depth of a cell's edge beyond which nothing changes any more, but sigma' times a
// difference of fluences loses all digits.
const float MAX_TAU = 4096.0;

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID);
    ivec3 dims = ivec3(args.dims);
    if (any(greaterThanEqual(c, dims))) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, dims);
    vec3 sigma_s = vec3(0.0), sigma_a = vec3(0.0), first = vec3(0.0), emission = vec3(0.0);
    for (uint k = 0; k < args.samples.z; k++) {
        for (uint j = 0; j < args.samples.y; j++) {
            for (uint i = 0; i < args.samples.x; i++) {
                vec3 at = (vec3(i, j, k) + 0.5) / vec3(args.samples);
                medium_point m = medium_sample(lattice_to_m(box, vec3(c) + at));
                similarity_clamp(m.sigma_s, m.phase);
                vec3 scaled = (1.0 - delta_fraction(m.phase)) * m.sigma_s;
                sigma_s += scaled;
                sigma_a += m.sigma_a;
                first += delta_cosine(m.phase) * scaled;
                emission += m.emission;
            }
        }
    }
    float norm = 1.0 / float(args.samples.x * args.samples.y * args.samples.z);
    vec3 g = mix(vec3(0.0), first / sigma_s, greaterThan(sigma_s, vec3(0.0)));
    vec3 bound = min(vec3(1.0), MAX_TAU / max((sigma_s + sigma_a) * (norm * box.dx), vec3(1e-20)));
    sigma_s *= norm * bound;
    sigma_a *= norm * bound;
    emission *= norm * bound;
    if (args.channels == 1) {
        float j = dot(emission, args.tint) / dot(args.tint, args.tint);
        imageStore(cells, c, vec4(sigma_s.r, sigma_a.r, g.r, j));
    } else {
        for (int ch = 0; ch < 3; ch++) {
            imageStore(cells, c + ivec3(0, 0, ch * dims.z),
                       vec4(sigma_s[ch], sigma_a[ch], g[ch], emission[ch]));
        }
    }
}
