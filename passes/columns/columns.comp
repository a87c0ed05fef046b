// columns.comp -- the medium integrated along the columns; x: column, z: ordinate of the batch. Built twice
// (medium_value.glsl).
#include "shaders/light/ordinate_args.h"
#include "shaders/beams/columns_args.h"
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/medium/medium_value.glsl"
#include "shaders/lattice/lattice.glsl"
#include "columns_grid.glsl"

layout(local_size_x = COLUMNS_GROUP) in;
TYN_ARGS(columns_args args);
TYN_UNIFORM(5, ordinates, ordinates_block ordinates);
TYN_WRITE(6, nodes, float nodes[]); // [ordinate][component of coefficients][slice][v][u]

#ifdef TYN_DENSITY
void columns_store(uint node, float value)
{
    nodes[node] = value;
}
#else
void columns_store(uint node, mat3 value)
{
    uint component = args.stride / COLUMNS_COMPONENTS;
    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 3; c++) {
            nodes[node + uint(3 * i + c) * component] = value[i][c];
        }
    }
}
#endif

// A column of an ordinate's grid: from slice to slice, since it entered the medium's box.
void columns_march(const columns_grid grid, ivec2 column, uint base)
{
    int samples = columns_samples(grid);
    vec2 origin = vec2(column) - 0.5; // place in slice 0
    ivec2 last = grid.count - 1 - column; // shift beyond which the column goes on at the near side
    uint node = base + uint(column.y * grid.count.x + column.x);
    uint layer = uint(grid.count.x * grid.count.y);
    vec3 uvw = columns_uvw(grid, origin, 0.0);
    float longest = -grid.front; // segment, slices; the first begins at the front face

    MEDIUM_VALUE sum = MEDIUM_VALUE(0.0);
    for (int slice = 0; slice < grid.size.z; slice++) {
        vec2 offset = grid.shear * float(slice);
        bvec2 around = greaterThan(ivec2(offset), last);
        if (any(around)) {
            vec2 moved = mix(vec2(0.0), vec2(grid.count), around);
            last += ivec2(moved);
            origin -= moved;
            uvw -= moved.x * grid.step_u + moved.y * grid.step_v;
            sum = MEDIUM_VALUE(0.0);
        }
        vec2 crossed = (origin + offset - grid.low) * grid.per_cell;
        float part = clamp(min(crossed.x, crossed.y), 0.0, longest);
        MEDIUM_VALUE mean = MEDIUM_VALUE(0.0);
        for (int i = 0; i < samples; i++) {
            float back = part * (1.0 - (float(i) + 0.5) / float(samples));
            mean += medium_value(uvw - back * grid.per_slice);
        }
        sum += mean * (part / float(samples));
        columns_store(node, sum * grid.spacing);
        node += layer;
        uvw += grid.per_slice;
        longest = 1.0;
    }
}

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
