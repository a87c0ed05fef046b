// lattice_lamps_cells.comp -- unscattered light of lamps in a cell; z: cells of each group.
//
// Fluence is the mean of I e^-tau' / r^2 over what scatters in the cell. Cells near a light are cut into up to
// 8^3 pieces; of each the mean of 1 / r^2 is taken, which is finite at the light itself.
#include "shaders/lattice/lattice_args.h"
#define MEDIUM_AT 0
#define RADIALS_AT 5
#define RADIALS_STORAGE
#define WALLS_AT 12
#define WALLS_STORAGE
#define SHADOWS_AT 14
#define SHADOWS_STORAGE
#define RADIAL_SHADOWS
#include "shaders/medium/medium.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/lattice/lattice_sweep.glsl"
#include "shaders/walls/lattice_walls.glsl"
#include "shaders/light/shadow.glsl"
#include "shaders/beams/radial.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_lamps_args args);
layout(binding = 9) uniform sampler3D cells;
// [group][channel][z][y][x]
layout(binding = 10, rgba32f) uniform writeonly image3D lit;

// The fluence alone, as if nothing stood before the lights: what their power is balanced by.
layout(binding = 11, r32f) uniform writeonly image3D unshadowed;

layout(constant_id = 1) const uint num_channels = 3;
layout(constant_id = 2) const uint walls = 0;
layout(constant_id = 3) const uint shadowed = 0;
#include "lattice_lamps.glsl"
#define LATTICE_LAMPS_VISIBILITY(n, p, away) radial_visibility(n, p)
#include "lattice_lamps_pieces.glsl"

uint pieces(uint n, float cells_away)
{
    uint base = max(args.samples - (n < args.num_fine ? 0u : 1u), 1u);
    return max(base, cells_away < 1.0 ? 8u : cells_away < 2.0 ? 4u : cells_away < 5.0 ? 2u : 1u);
}

// Of a light that is far away: the cell as a whole. `extinction`: sigma_t' of its channels.
void add_far_light(uint n, const lattice_box box, vec3 p, vec3 extinction, inout vec4 sums[3], inout vec3 all)
{
    vec3 away = p - radials[n].light.position;
    disc_light light = lattice_lamps_light(radials[n].light, away, box.dx);
    if (light.fluence <= 0.0) {
        return;
    }
    float r = length(away);
    vec3 a = abs(away / max(r, 1e-20));
    beam_tau tau = radial_tau(radial_place_of(n, away, r));
    float half_way = 0.5 * box.dx / max(max(a.x, max(a.y, a.z)), 0.57);
    float visible = shadowed == 1 ? radial_visibility(n, p) : 1.0;
    vec4 moments = visible * vec4(1.0, light.mean);
    for (uint ch = 0u; ch < num_channels; ch++) {
        float t = mean_transmittance(tau.a[ch] + tau.p[ch], half_way * extinction[ch]);
        float e = lattice_channel(radials[n].light.color, num_channels, ch, args.tint);
        sums[ch] += e * t * light.fluence * moments;
        all[ch] += e * t * light.fluence;
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
    vec3 all = vec3(0.0), extinction = vec3(0.0);
    for (uint ch = 0u; ch < num_channels; ch++) {
        vec4 cell = texelFetch(cells, c + ivec3(0, 0, int(ch) * dims.z), 0);
        extinction[ch] = cell.x + cell.y;
    }
    if (extinction.r + extinction.g + extinction.b > 0.0) { // where there is no medium light does nothing
        lattice_box box = lattice_box_of(medium.extent, dims);
        uvec2 range = lattice_lamps_of(group);
        vec3 middle = lattice_to_m(box, vec3(c) + 0.5);
        for (uint n = range.x; n < range.y; n++) {
            // Few lights are near. Some devices run what these need for all, if it is in the same loop.
            uint count = 1u;
            for (; n < range.y; n++) {
                count = pieces(n, distance(middle, radials[n].light.position) / box.dx);
                if (count > 1u) {
                    break;
                }
                add_far_light(n, box, middle, extinction, sums, all);
            }
            if (count > 1u) {
                lattice_lamps_add_pieces(n, count, box, c, sums, all);
            }
        }
    }
    for (uint ch = 0u; ch < num_channels; ch++) {
        ivec3 at = c + ivec3(0, 0, int(group * num_channels + ch) * dims.z);
        imageStore(lit, at, sums[ch]);
        imageStore(unshadowed, at, vec4(all[ch]));
    }
}
