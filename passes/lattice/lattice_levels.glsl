// lattice_levels.glsl -- where the levels of the diffusion grid lie in their buffers. No bindings.
//
// Level l + 1 has half the cells of level l along each axis, rounded up. The levels of a channel
// follow each other, finest first; within a level x is fastest.

struct lattice_level {
    ivec3 size;
    uint first; // its first cell, from the first cell of the channel
};

uint lattice_num_cells(ivec3 size)
{
    return uint(size.x * size.y * size.z);
}

lattice_level lattice_next_level(const lattice_level l)
{
    return lattice_level((l.size + 1) / 2, l.first + lattice_num_cells(l.size));
}

lattice_level lattice_level_of(ivec3 dims, uint level)
{
    lattice_level l = lattice_level(dims, 0);
    for (uint i = 0; i < level; i++) {
        l = lattice_next_level(l);
    }
    return l;
}

uint lattice_index(const lattice_level l, ivec3 c)
{
    return l.first + uint((c.z * l.size.y + c.y) * l.size.x + c.x);
}
