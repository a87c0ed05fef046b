// lattice_lamps.glsl -- which local lights make up a group. Include after lattice_args.h and radial.glsl.
#ifndef TYN_LATTICE_LAMPS_GLSL
#define TYN_LATTICE_LAMPS_GLSL

// First and last light, less than which.
uvec2 lattice_lamps_of(uint group)
{
    if (group < args.num_fine) {
        return uvec2(group, group + 1u);
    }
    bool vpls = group > args.num_fine || args.num_fine == args.num_lamps;
    return vpls ? uvec2(args.num_lamps, radial_count) : uvec2(args.num_fine, args.num_lamps);
}

#endif
