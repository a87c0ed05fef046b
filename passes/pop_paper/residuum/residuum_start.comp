// residuum_start.comp -- the light of all aligned grids, by power, in the medium's own grid.
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/lattice/lattice.glsl"
#include "../common/propagate.glsl"
#include "residuum_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_UNIFORM(5, places, propagate_place places[TYN_ORDINATES_MAX]);
layout(set = 0, binding = 6) uniform sampler3D light;
TYN_WRITE(7, state, vec4 out_state[]);
TYN_WRITE(8, kept, vec4 out_kept[]);
TYN_WRITE(9, sum, vec4 out_sum[]);
TYN_ARGS(residuum_args args);

// Power per volume of all grids at a point, W/m^3: a cell of length c along the light holds L A in its volume A c.
vec3 power_at(vec3 p)
{
    vec3 texel = 1.0 / vec3(textureSize(light, 0)), sum = vec3(0.0);
    uvec2 tile = uvec2(0u);
    for (uint n = 0u; n < args.num_grids; n++) {
        vec3 at = propagate_at(places[n], p), found = vec3(0.0);
        for (uint c = 0u; c < args.channels; c++) {
            vec3 corner = vec3(tile * args.grid_cells, 0.0);
            found[c] = textureLod(light, (corner + at) * texel, 0.0).r;
            tile.x++;
            tile = tile.x == args.tiles ? uvec2(0u, tile.y + 1u) : tile;
        }
        vec4 row = args.grid_along == 0u ? places[n].rows[0] : places[n].rows[2]; // of cubes, any
        sum += length(row.xyz) * places[n].irradiance *                           // 1 / c
               (args.channels == 1u ? found.rrr : found);
    }
    return sum;
}

void main()
{
    ivec3 cell = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(uvec3(cell), args.dims))) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, ivec3(args.dims));
    // Samples along an edge: one to half a cell of the finest that an aligned grid may have, and one to
    // two voxels of the medium.
    float longest = max(medium.extent.x, max(medium.extent.y, medium.extent.z));
    float voxel = min(medium.voxel.x, min(medium.voxel.y, medium.voxel.z));
    int fine = clamp(int(ceil(box.dx * float(max(args.grid_cells, args.grid_along)) / longest - 1e-3)), 1, 4);
    int along = clamp(int(ceil(0.5 * box.dx / voxel - 1e-3)), 1, 16);
    vec3 power = vec3(0.0), sigma_a = vec3(0.0);
    for (int n = 0; n < fine * fine * fine; n++) {
        vec3 part = (vec3(n % fine, n / fine % fine, n / (fine * fine)) + 0.5) / float(fine);
        vec3 p = lattice_to_m(box, vec3(cell) + part);
        bool inside = all(greaterThanEqual(p, vec3(0.0))) && all(lessThanEqual(p, medium.extent));
        power += inside ? power_at(p) : vec3(0.0); // what is outside has left the medium
    }
    for (int n = 0; n < along * along * along; n++) {
        vec3 part = (vec3(n % along, n / along % along, n / (along * along)) + 0.5) / float(along);
        sigma_a += medium_sample(lattice_to_m(box, vec3(cell) + part)).sigma_a;
    }
    vec3 kept = exp(-0.5 * box.dx / float(along * along * along) * sigma_a);
    uint q = (uint(cell.z) * args.dims.y + uint(cell.y)) * args.dims.x + uint(cell.x);
    out_state[q] = vec4(kept * power * box.dx / float(fine * fine * fine), 0.0);
    out_kept[q] = vec4(kept, 0.0);
    out_sum[q] = vec4(0.0);
}
