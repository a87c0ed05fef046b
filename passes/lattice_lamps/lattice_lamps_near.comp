// lattice_lamps_near.comp -- unscattered light of virtual point lights (VPLs) in the cells next to them, added to
// that of all others.
#include "shaders/lattice/lattice_args.h"
#define MEDIUM_AT 0
#define RADIALS_AT 5
#define WALLS_AT 12
#define WALLS_STORAGE
#define VPL_DISTANCES 14
#define LATTICE_ROOMS 15
#include "shaders/medium/medium.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/lattice/lattice_sweep.glsl"
#include "shaders/walls/lattice_walls.glsl"
#include "shaders/walls/lattice_rooms.glsl"
#include "shaders/light/vpl_visibility.glsl"
#include "shaders/beams/radial.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_lamps_args args);
layout(binding = 9) uniform sampler3D cells;
layout(binding = 10, rgba32f) uniform image3D lit; // as in lattice_lamps_cells.comp
layout(binding = 11, r32f) uniform image3D unshadowed;

layout(constant_id = 1) const uint num_channels = 3;
layout(constant_id = 2) const uint shadowed = 0;
layout(constant_id = 3) const uint walls = 0;
layout(constant_id = 4) const uint rooms = 0;

walls_planes hiding; // the cell from VPLs
uint room = 0u;

float visibility(uint n, vec3 away)
{
    vpl_map map = vpl_map_of(n - args.num_lamps, radials[n].light.direction);
    bool closed = walls == 1u && walls_behind(hiding, radials[n].light.position) != 0u;
    float visible = vpl_map_visibility(map, away, length(away), closed);
    uint shines_in = rooms == 1u ? rooms_of_vpl(ivec3(args.dims), n - args.num_lamps) : 0u;
    return rooms_joined(shines_in, room) ? visible : 0.0;
}

#include "lattice_lamps.glsl"
#define LATTICE_LAMPS_VISIBILITY(n, p, away) visibility(n, away)
#include "lattice_lamps_pieces.glsl"

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    if (any(greaterThanEqual(c, dims))) {
        return;
    }
    vec4 sums[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
    lattice_box box = lattice_box_of(medium.extent, dims);
    vec3 all = vec3(0.0);
    float extinction = 0.0;
    for (uint ch = 0u; ch < num_channels; ch++) {
        vec4 cell = texelFetch(cells, c + ivec3(0, 0, int(ch) * dims.z), 0);
        extinction += cell.x + cell.y;
    }
    if (walls == 1) {
        hiding = walls_planes_hiding(lattice_index(box, c));
    }
    if (rooms == 1) {
        room = rooms_of_cell(dims, c);
    }
    vec3 centre = lattice_to_m(box, vec3(c) + 0.5);
    uint count = extinction > 0.0 ? radial_count : 0u;
    for (uint first = args.num_lamps; first < count; first += 32u) {
        // All threads look at the same VPL, and then each at those that are near to it.
        uint near = 0u;
        for (uint k = 0u; k < min(count - first, 32u); k++) {
            float away = distance(centre, radials[first + k].light.position);
            near |= lattice_lamps_vpl_pieces(away / box.dx) > 1u ? 1u << k : 0u;
        }
        for (; near != 0u; near &= near - 1u) {
            uint n = first + uint(findLSB(near));
            uint cut = lattice_lamps_vpl_pieces(distance(centre, radials[n].light.position) / box.dx);
            lattice_lamps_add_pieces(n, cut, box, c, sums, all);
        }
    }
    if (all.r + all.g + all.b > 0.0) {
        for (uint ch = 0u; ch < num_channels; ch++) {
            ivec3 at = c + ivec3(0, 0, int((args.num_groups - 1u) * num_channels + ch) * dims.z);
            imageStore(lit, at, imageLoad(lit, at) + sums[ch]);
            imageStore(unshadowed, at, imageLoad(unshadowed, at) + all[ch]);
        }
    }
}
