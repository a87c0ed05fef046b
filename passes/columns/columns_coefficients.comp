// columns_coefficients.comp -- coefficients integrated along the columns; x: column, z: ordinate of the
// batch.
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
    float nodes[]; // [ordinate][component][slice][v][u]
};

#define COLUMNS_VALUE mat3 // sigma_s, sigma_a, (1 - f) sigma_s

mat3 columns_value(vec3 uvw)
{
    vec3 sigma_s = textureLod(medium_density_tex, uvw, 0.0).rgb;
    vec3 sigma_a = textureLod(medium_sigma_a_tex, uvw, 0.0).rgb;
    vec3 g = textureLod(medium_g_tex, uvw, 0.0).rgb;
    similarity_clamp(sigma_s, g);
    return mat3(sigma_s, sigma_a, sigma_s * (1.0 - delta_fraction(g)));
}

void columns_store(uint node, mat3 value)
{
    uint component = args.stride / COLUMNS_COMPONENTS;
    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 3; c++) {
            nodes[node + uint(3 * i + c) * component] = value[i][c];
        }
    }
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
