// columns_gather.comp -- from the columns to the cells; x: two cells, y, z: cells, the components and
// ordinates of the batch above each other along z.
//
// The ray to a cell's centre lies between four columns, all the way. It enters the box where they may
// be beside it still; there they run through the medium of the faces. That integral C has no kinks
// where neighbouring rays enter through different faces, as the depth itself has, so it may be
// interpolated between columns; the depth is C(cell) - C(entry).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_args.h"
#include "ordinate_args.h"
#include "columns_args.h"
#include "lattice.glsl"
#include "columns_grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform push
{
    columns_args args;
};
layout(binding = 0, scalar) uniform medium_uniform
{
    medium_block medium;
};
layout(binding = 1, scalar) uniform ordinates_uniform
{
    ordinates_block ordinates;
};
layout(binding = 2, scalar) readonly buffer node_buffer
{
    float nodes[]; // [ordinate][component][slice][v][u]
};
layout(binding = 3, scalar) writeonly buffer columns_buffer
{
    uint columns_words[]; // columns.glsl
};

layout(constant_id = 0) const uint num_components = 1;

// The four columns around a ray, at a slice.
struct corners {
    ivec2 lo, hi;    // columns along u and v
    vec2 t;          // weight of hi
    ivec2 place;     // of lo in the slice of the cell
    ivec2 shift;     // cells that columns have moved by there
};

float between(columns_grid grid, corners c, uint base, int slice, vec4 keep)
{
    float a = keep.x * nodes[base + columns_node(grid, slice, c.lo)];
    float b = keep.y * nodes[base + columns_node(grid, slice, ivec2(c.hi.x, c.lo.y))];
    float d = keep.z * nodes[base + columns_node(grid, slice, ivec2(c.lo.x, c.hi.y))];
    float e = keep.w * nodes[base + columns_node(grid, slice, c.hi)];
    return mix(mix(a, b, c.t.x), mix(d, e, c.t.x), c.t.y);
}

// 0 for columns that at an earlier slice were not yet in the grid: their integral begins after it.
vec4 present(columns_grid grid, corners c, int slice)
{
    ivec2 place = c.place + ivec2(floor(grid.shear * float(slice))) - c.shift;
    vec2 lo = mix(vec2(0.0), vec2(1.0), greaterThanEqual(place, ivec2(0)));
    vec2 hi = mix(vec2(0.0), vec2(1.0), greaterThanEqual(place, ivec2(-1)));
    return vec4(lo.x * lo.y, hi.x * lo.y, lo.x * hi.y, hi.x * hi.y);
}

float depth(columns_grid grid, ivec3 cell, uint base)
{
    ivec3 q = mix(cell, ivec3(args.dims) - 1 - cell, grid.reverse);
    q = ivec3(q[grid.u], q[grid.v], q[grid.w]);
    vec2 offset = grid.shear * float(q.z);
    corners c;
    c.shift = ivec2(floor(offset));
    c.place = q.xy + 1;
    c.lo = columns_wrap(c.place - c.shift, grid.count);
    c.hi = mix(c.lo + 1, ivec2(0), equal(c.lo + 1, grid.count));
    c.t = 1.0 - fract(offset);
    float sum = between(grid, c, base, q.z, vec4(1.0));

    // Slices back to where the ray comes in through a face at the side; at the front C is 0.
    vec2 aside = (vec2(q.xy) + 0.5 - grid.low.xy) / max(grid.shear, vec2(1e-12));
    float entry = float(q.z) - min(aside.x, aside.y);
    for (int side = 0; side < (entry > grid.front ? 1 : 0); side++) {
        int slice = min(int(floor(entry)), q.z - 1);
        float after = between(grid, c, base, slice + 1, present(grid, c, slice + 1));
        if (slice >= 0) {
            float before = between(grid, c, base, max(slice, 0), present(grid, c, slice));
            sum -= mix(before, after, entry - float(slice));
        } else {
            sum -= after * (entry - grid.front) / -grid.front;
        }
    }
    return max(sum, 0.0);
}

// Square roots, for the range of halves.
float encoded(float x)
{
    return x < 4e9 ? sqrt(x) : isnan(x) ? 0.0 : 65504.0;
}

void main()
{
    uint layer = gl_WorkGroupID.z / args.dims.z, component = layer % num_components;
    uint local = layer / num_components, n = args.first + local;
    if (n >= ordinates.count) {
        return;
    }
    ivec3 cell = ivec3(2 * gl_GlobalInvocationID.x, gl_GlobalInvocationID.y, gl_WorkGroupID.z % args.dims.z);
    if (any(greaterThanEqual(cell, ivec3(args.dims)))) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, ivec3(args.dims));
    columns_grid grid = columns_grid_of(ordinates.list[n].direction, box);
    uint base = local * args.stride + component * (args.stride / num_components);
    vec2 pair;
    pair.x = encoded(depth(grid, cell, base));
    pair.y = encoded(depth(grid, ivec3(min(cell.x + 1, int(args.dims.x) - 1), cell.yz), base));
    uint row = (args.dims.x + 1u) / 2u;
    uint plane = (n * num_components + component) * args.dims.z + uint(cell.z);
    columns_words[(plane * args.dims.y + uint(cell.y)) * row + gl_GlobalInvocationID.x] =
        packHalf2x16(pair);
}
