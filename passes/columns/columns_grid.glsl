// columns_grid.glsl -- the sheared grid of an ordinate. Include after medium.glsl, lattice.glsl and
// columns_args.h.
//
// Slices are the planes through the lattice's cell centres across the axis w most along the light;
// columns run along the light and are one cell apart in a slice. Coordinates are cells of the lattice,
// axes against the light being reversed, so that light moves up along all of them: a column moves
// by shear <= 1 from slice to slice, and by the same fraction of a cell everywhere in a slice. So the
// cells' centres lie between columns with the same weights in a whole slice.
//
// A column that has left the lattice at the far side goes on as the next that comes in at the near
// side: size + 1 of them along a side are enough for all slices. Column m is at place
// (m + floor(offset)) mod (size + 1) in a slice, at coordinate place - 1/2 + fract(offset).

struct columns_grid {
    int u, v, w;      // axes of M
    ivec3 size;       // cells along u, v; slices
    ivec2 count;      // columns
    vec2 shear;       // cells along u and v from slice to slice
    vec2 per_cell;    // slices in which a column moves by a cell
    vec2 low;         // where the medium's box begins, cells along u, v
    float front;      // slice coordinate of its front face: slice k is at k, -1/2 <= front < 0
    bvec3 reverse;    // axes of M against the light
    float spacing;    // from slice to slice along the light, m
    vec3 start;       // texture coordinate at 0, 0 of slice 0
    vec3 step_u;      // from cell to cell
    vec3 step_v;
    vec3 per_slice;   // from slice to slice along the light
};

// Texture coordinate of one cell along an axis, in the light's sense.
vec3 columns_step(vec3 direction, float dx, int axis)
{
    vec3 cell = mix(vec3(dx), vec3(-dx), lessThan(direction, vec3(0.0))) / medium.extent;
    return mix(vec3(0.0), cell, equal(ivec3(axis), ivec3(0, 1, 2)));
}

columns_grid columns_grid_of(vec3 direction, const lattice_box box)
{
    columns_grid grid;
    // A direction that is none (nothing comes along it) is as good as any, but it must be one.
    direction = dot(direction, direction) > 0.25 ? direction : vec3(0.0, 0.0, 1.0);
    vec3 d = abs(direction);
    grid.w = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
    grid.u = grid.w == 0 ? 2 : 0;
    grid.v = grid.w == 1 ? 2 : 1;
    grid.size = ivec3(box.dims[grid.u], box.dims[grid.v], box.dims[grid.w]);
    grid.count = grid.size.xy + 1;
    grid.shear = vec2(d[grid.u], d[grid.v]) / d[grid.w];
    grid.per_cell = 1.0 / max(grid.shear, vec2(1e-12));
    vec3 low = -box.origin / box.dx;
    grid.low = vec2(low[grid.u], low[grid.v]);
    grid.front = low[grid.w] - 0.5;
    grid.reverse = lessThan(direction, vec3(0.0));
    grid.spacing = box.dx / d[grid.w];
    grid.step_u = columns_step(direction, box.dx, grid.u);
    grid.step_v = columns_step(direction, box.dx, grid.v);
    vec3 step_w = columns_step(direction, box.dx, grid.w);
    grid.per_slice = grid.shear.x * grid.step_u + grid.shear.y * grid.step_v + step_w;
    grid.start = mix(vec3(0.0), vec3(1.0), grid.reverse) - grid.low.x * grid.step_u -
                 grid.low.y * grid.step_v - grid.front * step_w;
    return grid;
}

// Texture coordinate of a place.
vec3 columns_uvw(const columns_grid grid, vec2 at, float slice)
{
    return grid.start + (at.x - slice * grid.shear.x) * grid.step_u +
           (at.y - slice * grid.shear.y) * grid.step_v + slice * grid.per_slice;
}

// Trilinear samples from slice to slice: one for two voxels and a half.
int columns_samples(const columns_grid grid)
{
    vec3 voxels = abs(grid.per_slice) * vec3(textureSize(density_tex, 0));
    return int(clamp(ceil(0.4 * max(voxels.x, max(voxels.y, voxels.z)) - 0.01), 1.0, 64.0));
}

// Slices that the ray through a place has crossed since it entered the box; beyond the far side of
// the box it counts as inside.
vec2 columns_inside(const columns_grid grid, vec2 along_u, vec2 along_v, vec2 slice)
{
    return max(min(min(along_u, along_v), slice - grid.front), 0.0);
}
