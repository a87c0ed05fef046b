// merge_grids_sum.comp -- see merge_grids.h; one thread a cell.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_BLOCK 0
#define MEDIUM_DENSITY 1
#include "medium.glsl"
#include "lattice.glsl"
#include "propagate.glsl"
#include "merge_grids_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 2, scalar) uniform places_uniform
{
    propagate_place places[TYN_ORDINATES_MAX];
};
layout(set = 0, binding = 3) uniform sampler3D seen;
layout(set = 0, binding = 4) uniform sampler3D residuum;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image3D out_merged;
layout(push_constant, scalar) uniform push { merge_grids_args args; };

// Mean of sigma_s over a cell and the channels: a trilinear fetch is a mean over two voxels.
float guide(lattice_box box, vec3 cell)
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
    if (args.residuum != 0u) {
        lattice_box own = lattice_box_of(medium.extent, textureSize(residuum, 0));
        light += textureLod(residuum, lattice_from_m(own, p) / vec3(own.dims), 0.0).rgb;
    }
    imageStore(out_merged, cell, vec4(light, guide(box, vec3(cell))));
}
