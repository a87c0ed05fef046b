// lattice.glsl -- where the cells of the light lattice are. No bindings.
//
// The lattice is a box of cubic cells around the medium's box: dx = longest side / longest
// dimension, and what the last cells reach beyond the medium is split evenly between both ends. All
// of it follows from the medium's extent and the number of cells, so nothing else is passed around.
//
// Channels that are solved are stacked along z: texel (i, j, c * dims.z + k) is cell (i, j, k) of
// channel c.
#ifndef TYN_LATTICE_GLSL
#define TYN_LATTICE_GLSL

struct lattice_box {
    vec3 origin; // corner of cell (0, 0, 0) in M, m (<= 0)
    float dx;    // edge of a cell, m
    ivec3 dims;  // cells
};

lattice_box lattice_box_of(vec3 extent, ivec3 dims)
{
    lattice_box box;
    int longest = max(dims.x, max(dims.y, dims.z));
    box.dx = max(extent.x, max(extent.y, extent.z)) / float(longest);
    box.origin = 0.5 * (extent - vec3(dims) * box.dx);
    box.dims = dims;
    return box;
}

// M -> cell units: cell i spans [i, i + 1], its centre is i + 0.5.
vec3 lattice_from_m(const lattice_box box, vec3 p)
{
    return (p - box.origin) / box.dx;
}

vec3 lattice_to_m(const lattice_box box, vec3 cell)
{
    return box.origin + cell * box.dx;
}

// Of a cell in buffers: x is fastest.
uint lattice_index(const lattice_box box, ivec3 cell)
{
    return uint((cell.z * box.dims.y + cell.y) * box.dims.x + cell.x);
}

// Texture coordinate in `inscatter`, which has one ghost cell around the lattice: trilinear
// sampling there extrapolates linearly over the outer half cell. `size` = textureSize(inscatter,
// 0).
vec3 lattice_inscatter_uvw(vec3 extent, ivec3 size, vec3 p)
{
    lattice_box box = lattice_box_of(extent, size - 2);
    return (lattice_from_m(box, p) + 1.0) / vec3(size);
}

#endif
