// columns_density.comp -- density integrated along the columns; x: column, z: ordinate of the batch.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/light/ordinate_args.h"
#include "shaders/beams/columns_args.h"
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/lattice/lattice.glsl"
#include "columns_grid.glsl"

layout(local_size_x = COLUMNS_GROUP) in;
layout(push_constant, scalar) uniform push
{
    columns_args args;
};
layout(binding = 5, scalar) uniform ordinates_uniform
{
    ordinates_block ordinates;
};
layout(binding = 6, scalar) writeonly buffer node_buffer
{
    float nodes[]; // [ordinate][slice][v][u]
};

#define COLUMNS_VALUE float

float columns_value(vec3 uvw)
{
    return textureLod(medium_density_tex, uvw, 0.0).r;
}

void columns_store(uint node, float value)
{
    nodes[node] = value;
}
#include "columns_march.glsl"

void main()
{
    uint n = args.first + gl_WorkGroupID.z;
    if (n >= ordinates.count) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, ivec3(args.dims));
    columns_grid grid = columns_grid_of(ordinates.list[n].direction, box);
    int i = int(gl_GlobalInvocationID.x);
    ivec2 column = ivec2(i % grid.count.x, i / grid.count.x);
    if (column.y < grid.count.y) {
        columns_march(grid, column, gl_WorkGroupID.z * args.stride);
    }
}
