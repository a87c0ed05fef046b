// lattice_lamps_vpls.comp -- unscattered light of virtual point lights (VPLs) in a block of 2 x 2 x 2 cells.
//
// What of a VPL changes little across a block is read once: its grid, and the mean of the medium on the way to
// the block, which is then taken times each cell's own way. Cells that are next to a VPL are left to
// lattice_lamps_near.comp. A workgroup has 2 x 2 x 2 blocks; VPLs are dealt out to LATTICE_VPL_SLICES threads of each, as
// blocks alone are too few threads for a card. Their sums are added in a fixed order.
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lattice/lattice_args.h"
#define MEDIUM_BLOCK 0
#define RADIALS_AT 1
#define VPL_DISTANCES 8
#define WALLS_AT 9
#define LATTICE_ROOMS 11
#include "shaders/medium/medium.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/lattice/lattice_sweep.glsl"
#include "shaders/light/vpl_visibility.glsl"
#include "shaders/walls/lattice_walls.glsl"
#include "shaders/walls/lattice_rooms.glsl"
#include "shaders/beams/radial.glsl"

layout(local_size_x = 8, local_size_y = LATTICE_VPL_SLICES) in;
TYN_ARGS(lattice_lamps_args args);
layout(binding = 5) uniform sampler3D cells;
layout(binding = 6, rgba32f) uniform writeonly image3D lit; // as in lattice_lamps_cells.comp
layout(binding = 7, r32f) uniform writeonly image3D unshadowed;

layout(constant_id = 1) const uint num_channels = 3;
layout(constant_id = 2) const uint shadowed = 0;
layout(constant_id = 3) const uint walls = 0;
layout(constant_id = 4) const uint rooms = 0;

#include "lattice_lamps.glsl"

const uint BLOCK = 8u, SUMS = 15u; // cells; of a cell: moments and fluence of three channels
shared float parts[LATTICE_VPL_SLICES * SUMS * BLOCK];

uint part_of(uint slice, uint of_cell, uint block)
{
    return (slice * SUMS + of_cell) * BLOCK + block;
}

float total_of(uint of_cell, uint block)
{
    float total = 0.0;
    for (uint slice = 0u; slice < LATTICE_VPL_SLICES; slice++) {
        total += parts[part_of(slice, of_cell, block)];
    }
    return total;
}

ivec3 corner_of(uint k)
{
    return ivec3(k & 1u, k >> 1 & 1u, k >> 2);
}

// For each cell of a block a bit for each of the VPLs that this thread has: is there a wall between them, in the cell?
void find_closed(ivec3 c, uint first, uint count, uint slice, inout uint closed[BLOCK])
{
    ivec3 dims = ivec3(args.dims);
    lattice_box box = lattice_box_of(medium.extent, dims);
    walls_planes hiding[BLOCK]; // the cells from VPLs
    [[unroll]] for (uint k = 0u; k < BLOCK; k++) {
        hiding[k] = walls_planes_hiding(lattice_index(box, min(c + corner_of(k), dims - 1)));
    }
    for (uint v = slice; v < count; v += LATTICE_VPL_SLICES) {
        // Not walls_behind: it rounds otherwise, and VPLs lie in the planes of walls.
        vec4 at = vec4(radials[first + v].light.position, 1.0);
        [[unroll]] for (uint k = 0u; k < BLOCK; k++) {
            float least = min(dot(hiding[k].plane[0], at), dot(hiding[k].plane[1], at));
            closed[k] |= min(least, dot(hiding[k].plane[2], at)) < 0.0 ? 1u << v / LATTICE_VPL_SLICES : 0u;
        }
    }
}

void main()
{
    // Threads of a row are corners of a cube: some devices run them together, and what one of them leaves out most of
    // the others do then, too.
    uint me = gl_LocalInvocationID.x, slice = gl_LocalInvocationID.y;
    ivec3 dims = ivec3(args.dims), c = 2 * (2 * ivec3(gl_WorkGroupID) + corner_of(me));
    uint group = args.num_groups - 1u;
    lattice_box box = lattice_box_of(medium.extent, dims);
    float dx = box.dx, thickest = 0.0;
    vec3 middle = lattice_to_m(box, vec3(c) + 1.0);
    vec4 sums[BLOCK][3];
    vec3 open[BLOCK], extinction[BLOCK];
    uint room[BLOCK], closed[BLOCK];
    [[unroll]] for (uint k = 0u; k < BLOCK; k++) {
        ivec3 at = min(c + corner_of(k), dims - 1);
        open[k] = vec3(0.0);
        room[k] = rooms == 1u ? rooms_of_cell(dims, at) : 0u;
        closed[k] = 0u;
        extinction[k] = vec3(0.0);
        [[unroll]] for (uint ch = 0u; ch < 3u; ch++) {
            sums[k][ch] = vec4(0.0);
            if (ch < num_channels) {
                vec4 cell = texelFetch(cells, at + ivec3(0, 0, int(ch) * dims.z), 0);
                extinction[k][ch] = cell.x + cell.y;
                thickest = max(thickest, extinction[k][ch]);
            }
        }
    }
    // Where there is no medium light does nothing.
    uint first = args.num_lamps, count = thickest > 0.0 && all(lessThan(c, dims)) ? min(radial_count - first, TYN_RADIAL_VPLS_MAX) : 0u;
    if (walls == 1u) {
        find_closed(c, first, count, slice, closed);
    }
    for (uint v = slice; v < count; v += LATTICE_VPL_SLICES) {
        light_block light = radials[first + v].light;
        vec3 from = middle - light.position;
        float way = length(from);
        if (dot(from, light.direction) > -0.87 * dx) {
            // The mean of the medium on the way to the block, and the share of that way within the box.
            radial_place place = radial_place_of(first + v, from, way);
            beam_tau mean = radial_tau(place);
            vec3 per_way = (mean.a + mean.p) / max(way, 1e-20);
            vpl_map map = vpl_map_of(v, light.direction);
            // Of the block: how obliquely the light crosses a cell.
            vec3 oblique = abs(from) / max(way, 1e-20);
            float half_way = 0.5 * dx / max(max(oblique.x, max(oblique.y, oblique.z)), 0.57);
            vec3 intensity = light.color;
            uint shines_in = rooms == 1u ? rooms_of_vpl(dims, v) : 0u;
            if (num_channels == 1u) {
                intensity = vec3(lattice_channel(intensity, 1u, 0u, args.tint));
            }
            [[unroll]] for (uint k = 0u; k < BLOCK; k++) {
                vec3 away = from + (vec3(corner_of(k)) - 0.5) * dx;
                float r = length(away);
                disc_light arriving = lattice_lamps_light(light, away, dx);
                float fluence = lattice_lamps_vpl_pieces(r / dx) == 1u ? arriving.fluence : 0.0;
                bool is_closed = (closed[k] >> v / LATTICE_VPL_SLICES & 1u) != 0u;
                float visible = shadowed == 1 ? vpl_map_visibility(map, away, r, is_closed) : 1.0;
                visible = rooms_joined(shines_in, room[k]) ? visible : 0.0;
                vec4 moments = visible * vec4(1.0, arriving.mean);
                [[unroll]] for (uint ch = 0u; ch < 3u; ch++) {
                    if (ch < num_channels) {
                        float t = mean_transmittance(r * per_way[ch], half_way * extinction[k][ch]);
                        float lighted = intensity[ch] * t * fluence;
                        sums[k][ch] += lighted * moments;
                        open[k][ch] += lighted;
                    }
                }
            }
        }
    }
    [[unroll]] for (uint k = 0u; k < BLOCK; k++) {
        [[unroll]] for (uint ch = 0u; ch < 3u; ch++) {
            if (ch < num_channels) {
                [[unroll]] for (uint i = 0u; i < 4u; i++) {
                    parts[part_of(slice, 4u * ch + i, me)] = sums[k][ch][i];
                }
                parts[part_of(slice, 12u + ch, me)] = open[k][ch];
            }
        }
        barrier();
        ivec3 cell = c + corner_of(k);
        bool lights = extinction[k].r + extinction[k].g + extinction[k].b > 0.0;
        if (slice < num_channels && all(lessThan(cell, dims))) {
            vec4 moments;
            [[unroll]] for (uint i = 0u; i < 4u; i++) {
                moments[i] = total_of(4u * slice + i, me);
            }
            float fluence = total_of(12u + slice, me);
            ivec3 at = cell + ivec3(0, 0, int(group * num_channels + slice) * dims.z);
            imageStore(lit, at, lights ? moments : vec4(0.0));
            imageStore(unshadowed, at, vec4(lights ? fluence : 0.0));
        }
        barrier();
    }
}
