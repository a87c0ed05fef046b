// columns_grid.glsl -- the sheared grid of an ordinate. Include after lattice.glsl and columns_args.h.
//
// Slices are the planes through the lattice's cell centres across the axis w most along the light;
// columns run along the light and are one cell apart in a slice. Coordinates are cells of the lattice,
// axes against the light being reversed, so that light moves up along all of them: a column moves
// by shear <= 1 from slice to slice, and by the same fraction of a cell everywhere in a slice. So the
// cells' centres lie between columns with the same weights in a whole slice.
//
// A column that has left the lattice at the far side goes on as the next that comes in at the near
// side: size + 2 of them along a side are enough for all slices. Column m is at place
// (m + floor(offset)) mod (size + 2) in a slice, at coordinate place - 3/2 + fract(offset); place 0
// is that of columns which the next cells are going to need.
#ifndef TYN_COLUMNS_GRID_GLSL
#define TYN_COLUMNS_GRID_GLSL

struct columns_grid {
    int u, v, w;   // axes of M
    ivec3 size;    // cells along u, v; slices
    ivec2 count;   // columns
    vec2 shear;    // cells along u and v from slice to slice
    vec3 low;      // where the medium's box begins, cells along u, v, w; it ends at size - low
    float front;   // slice coordinate of its front face: slice k is at k, -1/2 <= front < 0
    bvec3 reverse; // axes of M against the light
    float spacing; // from slice to slice along the light, m
};

columns_grid columns_grid_of(vec3 direction, lattice_box box)
{
    columns_grid grid;
    vec3 d = abs(direction);
    grid.w = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
    grid.u = grid.w == 0 ? 1 : 0;
    grid.v = grid.w == 2 ? 1 : 2;
    grid.size = ivec3(box.dims[grid.u], box.dims[grid.v], box.dims[grid.w]);
    grid.count = grid.size.xy + 2;
    grid.shear = vec2(d[grid.u], d[grid.v]) / d[grid.w];
    grid.low = -vec3(box.origin[grid.u], box.origin[grid.v], box.origin[grid.w]) / box.dx;
    grid.front = grid.low.z - 0.5;
    grid.reverse = lessThan(direction, vec3(0.0));
    grid.spacing = box.dx / d[grid.w];
    return grid;
}

// x mod n for whole numbers -8192 < x < 8192.
ivec2 columns_wrap(ivec2 x, ivec2 n)
{
    return x - n * ivec2(floor((vec2(x) + 0.5) / vec2(n)));
}

uint columns_node(columns_grid grid, int slice, ivec2 column)
{
    return uint((slice * grid.count.y + column.y) * grid.count.x + column.x);
}

#endif
