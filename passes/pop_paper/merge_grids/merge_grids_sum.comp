// merge_grids_sum.comp -- see merge_grids.h; one thread a cell.
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/lattice/lattice.glsl"
#include "../common/propagate.glsl"
#include "../common/propagate_radial.glsl"
#include "merge_grids_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_UNIFORM(5, places, propagate_place places[TYN_ORDINATES_MAX]);
layout(set = 0, binding = 6) uniform sampler3D seen;
layout(set = 0, binding = 7) uniform sampler3D residuum;
layout(set = 0, binding = 8, rgba32f) uniform writeonly image3D merged_image;
TYN_READ(9, lamp_places, propagate_radial_place lamp_places[]);
layout(set = 0, binding = 10) uniform sampler3D lamp_seen;
TYN_READ(11, vpl_places, propagate_radial_place vpl_places[]);
layout(set = 0, binding = 12) uniform sampler3D vpl_seen;
TYN_ARGS(merge_grids_args args);

// Mean of sigma_s over a cell and the channels: a trilinear fetch is a mean over two voxels.
float guide(const lattice_box box, vec3 cell)
{
    float voxel = min(medium.voxel.x, min(medium.voxel.y, medium.voxel.z));
    int along = clamp(int(ceil(0.5 * box.dx / voxel - 1e-3)), 1, 16);
    vec3 sum = vec3(0.0);
    for (int k = 0; k < along; k++) {
        for (int j = 0; j < along; j++) {
            for (int i = 0; i < along; i++) {
                vec3 p = lattice_to_m(box, cell + (vec3(i, j, k) + 0.5) / float(along));
                sum += medium_sample(clamp(p, vec3(0.0), medium.extent)).sigma_s;
            }
        }
    }
    return dot(sum, vec3(1.0 / 3.0)) / float(along * along * along);
}

// Mean of 1 / r^2 over a cube of edge h with its middle at a distance r: that over the ball of equal volume, of
// radius R, 3 / (4 R^3) (2 R - (r - R^2 / r) ln |(r + R) / (r - R)|).
float inverse_square(float r, float h)
{
    float R = 0.62035049 * h;
    if (r > 4.0 * R) {
        return (1.0 + 0.2 * R * R / (r * r)) / (r * r);
    }
    r = max(r, 1e-3 * R);
    float apart = max(abs(r - R), 1e-6 * R);
    return 0.75 / (R * R * R) * (2.0 * R - (r - R * R / r) * log((r + R) / apart));
}

// Light of a local light at a point, per intensity and channel, times r^2.
vec3 seen_from(const propagate_radial_place place, const merge_grids_radial grids, sampler3D found_in, uint n,
               vec3 away, float r)
{
    float k = r * place.per_inner;
    vec2 e = octahedral_of(r > 0.0 ? vec3(dot(place.to_map[0], away), dot(place.to_map[1], away),
                                          dot(place.to_map[2], away))
                                   : vec3(0.0, 0.0, 1.0));
    float layer = clamp(k < 1.0 ? k : 1.0 + log(k) * place.per_layer, 0.5, float(place.layers) - 0.5);
    vec3 at = vec3(1.0 + (0.5 * e + 0.5) * float(grids.cells), layer);
    vec3 texel = 1.0 / vec3(textureSize(found_in, 0)), found = vec3(0.0);
    for (uint c = 0u; c < args.channels; c++) {
        uint stack = n * args.channels + c;
        uvec2 corner = uvec2(stack % grids.tiles, stack / grids.tiles) * (grids.cells + 2u);
        found[c] = textureLod(found_in, (vec3(corner, 0.0) + at) * texel, 0.0).r;
    }
    return args.channels == 1u ? found.rrr : found;
}

// Mean over a cell of edge dx: the cells of the radial grid are small next to the light.
vec3 radial_mean(const propagate_radial_place place, const merge_grids_radial grids, sampler3D found_in, uint n,
                 vec3 middle, float dx)
{
    float distant = length(middle - place.position);
    int along = place.layers == 0u ? 0 : distant < 2.0 * dx ? 8 : distant < 6.0 * dx ? 2 : 1;
    float h = dx / float(max(along, 1));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < along * along * along; i++) {
        vec3 part = (vec3(i % along, i / along % along, i / (along * along)) + 0.5) * h - 0.5 * dx;
        vec3 away = middle + part - place.position;
        float r = length(away);
        sum += inverse_square(r, h) * seen_from(place, grids, found_in, n, away, r);
    }
    return place.intensity * sum / float(max(along * along * along, 1));
}

void main()
{
    ivec3 cell = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(uvec3(cell), args.dims))) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, ivec3(args.dims));
    vec3 p = clamp(lattice_to_m(box, vec3(cell) + 0.5), vec3(0.0), medium.extent);
    vec3 texel = 1.0 / vec3(textureSize(seen, 0));
    uvec2 tile = uvec2(0u);
    vec3 light = vec3(0.0);
    for (uint n = 0u; n < args.num_grids; n++) {
        vec3 at = propagate_at(places[n], p);
        vec3 found = vec3(0.0);
        for (uint c = 0u; c < args.channels; c++) {
            vec3 corner = vec3(tile * args.grid_cells, 0.0);
            found[c] = textureLod(seen, (corner + at) * texel, 0.0).r;
            tile.x++;
            tile = tile.x == args.tiles ? uvec2(0u, tile.y + 1u) : tile;
        }
        light += places[n].irradiance * (args.channels == 1u ? found.rrr : found);
    }
    for (uint n = 0u; n < args.lamps.count; n++) {
        light += radial_mean(lamp_places[n], args.lamps, lamp_seen, n, p, box.dx);
    }
    for (uint n = 0u; n < args.vpls.count; n++) {
        light += radial_mean(vpl_places[n], args.vpls, vpl_seen, n, p, box.dx);
    }
    if (args.residuum != 0u) {
        lattice_box own = lattice_box_of(medium.extent, textureSize(residuum, 0));
        light += textureLod(residuum, lattice_from_m(own, p) / vec3(own.dims), 0.0).rgb;
    }
    imageStore(merged_image, cell, vec4(light, guide(box, vec3(cell))));
}
