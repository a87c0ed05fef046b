// lattice_levels.glsl -- where the levels of the diffusion grid lie in their images. No bindings.
//
// Level l + 1 has half the cells of level l, rounded up. Level 0 fills [0, dims); the others stand to
// the right of it, one below the other, like the mips of an atlas. Channels are stacked along z with
// the depth of level 0.
#ifndef TYN_LATTICE_LEVELS_GLSL
#define TYN_LATTICE_LEVELS_GLSL

struct lattice_level {
    ivec3 offset; // of channel 0
    ivec3 size;
};

lattice_level lattice_level_of(ivec3 dims, uint level)
{
    lattice_level l = lattice_level(ivec3(0), dims);
    for (uint i = 0; i < level; i++) {
        l.offset = i == 0 ? ivec3(dims.x, 0, 0) : l.offset + ivec3(0, l.size.y, 0);
        l.size = (l.size + 1) / 2;
    }
    return l;
}

#endif
