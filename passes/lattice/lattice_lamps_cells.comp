// lattice_lamps_cells.comp -- unscattered light of local lights in a cell; z: cells of each group.
//
// Fluence is the mean of I e^-tau' / r^2 over what scatters in the cell. Cells near a light are cut into up to
// 8^3 pieces; of each the mean of 1 / r^2 is taken, which is finite at the light itself:
//   1 / r^2 (1 + d^2 / (12 r^2)) far away, 7.67 / d^2 where the light is in the middle of a cube of edge d.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lattice_args.h"
#define MEDIUM_BLOCK 0
#define MEDIUM_DENSITY 1
#define MEDIUM_G 2
#define RADIAL_BLOCK 3
#define RADIAL_COLUMN 4
#define RADIAL_TAU_A 5
#define RADIAL_TAU_P 6
#include "medium.glsl"
#include "radial.glsl"
#include "lattice.glsl"
#include "lattice_sweep.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(push_constant, scalar) uniform push
{
    lattice_lamps_args args;
};
layout(binding = 7) uniform sampler3D cells;
// [group][channel][z][y][x]
layout(binding = 8, rgba32f) uniform writeonly image3D lit;

layout(constant_id = 1) const uint num_channels = 3;
#include "lattice_lamps.glsl"

float mean_inverse_square(float r2, float d2)
{
    return r2 < d2 ? 1.0 / (0.1304 * d2 + 0.79 * r2) : (1.0 + d2 / (12.0 * r2)) / r2;
}

uint pieces(uint n, float cells_away)
{
    uint base = max(args.samples - (n < args.num_fine ? 0u : 1u), 1u);
    return max(base, cells_away < 1.0 ? 8u : cells_away < 2.0 ? 4u : cells_away < 5.0 ? 2u : 1u);
}

// Adds light n to the moments of the channels.
void add_light(uint n, vec3 corner, float dx, inout vec4 sums[3])
{
    vec3 position = radials[n].light.position;
    uint count = pieces(n, length(corner + 0.5 * dx - position) / dx);
    float d = dx / float(count), radius = radials[n].light.radius;
    vec4 weighted[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
    vec3 weight = vec3(0.0);
    for (uint i = 0u; i < count * count * count; i++) {
        vec3 p = corner + (vec3(i % count, i / count % count, i / (count * count)) + 0.5) * d;
        medium_point m = medium_sample(p);
        similarity_clamp(m.sigma_s, m.g);
        vec3 scaled = (1.0 - delta_fraction(m.g)) * m.sigma_s;
        vec3 w = scaled + 1e-6 * m.sigma_a;
        weight += w;
        if (w.r + w.g + w.b <= 0.0) {
            continue;
        }
        vec3 away = p - position;
        float r = length(away), share = radial_share(n, away, r);
        if (share <= 0.0) {
            continue;
        }
        beam_tau tau = radial_tau(radial_place_of(n, away, r));
        vec3 unit = away / max(r, 1e-20), a = abs(unit);
        // Half the depth of a piece along the light.
        float half_way = 0.5 * d / max(max(a.x, max(a.y, a.z)), 0.57);
        float fluence = share * mean_inverse_square(r * r, d * d);
        // Seen under an angle, a disc does not shine along one direction.
        float cosine = 1.0 - 0.25 * radius * radius / max(r * r, radius * radius + 1e-20);
        for (uint ch = 0u; ch < num_channels; ch++) {
            float t = mean_transmittance(tau.a[ch] + tau.p[ch], half_way * (scaled[ch] + m.sigma_a[ch]));
            weighted[ch] += (w[ch] * t * fluence) * vec4(1.0, cosine * unit);
        }
    }
    for (uint ch = 0u; ch < num_channels; ch++) {
        float e = lattice_channel(radials[n].light.intensity, num_channels, ch, args.tint);
        sums[ch] += weight[ch] > 0.0 ? weighted[ch] * (e / weight[ch]) : vec4(0.0);
    }
}

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    uint group = uint(texel.z / dims.z);
    ivec3 c = ivec3(texel.xy, texel.z % dims.z);
    if (any(greaterThanEqual(c, dims)) || group >= args.num_groups) {
        return;
    }
    vec4 sums[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
    float extinction = 0.0;
    for (uint ch = 0u; ch < num_channels; ch++) {
        vec4 cell = texelFetch(cells, c + ivec3(0, 0, int(ch) * dims.z), 0);
        extinction += cell.x + cell.y;
    }
    if (extinction > 0.0) { // where there is no medium light does nothing
        lattice_box box = lattice_box_of(medium.extent, dims);
        uvec2 range = lattice_lamps_of(group);
        for (uint n = range.x; n < range.y; n++) {
            add_light(n, lattice_to_m(box, vec3(c)), box.dx, sums);
        }
    }
    for (uint ch = 0u; ch < num_channels; ch++) {
        ivec3 at = c + ivec3(0, 0, int(group * num_channels + ch) * dims.z);
        imageStore(lit, at, sums[ch]);
    }
}
