// lattice_lamps.glsl -- which local lights make up a group, and how they light cells. Include after
// lattice_args.h and radial.glsl.
#include "lattice_lamps_disc.glsl"

// First and last light, less than which.
uvec2 lattice_lamps_of(uint group)
{
    if (group < args.num_fine) {
        return uvec2(group, group + 1u);
    }
    bool vpls = group > args.num_fine || args.num_fine == args.num_lamps;
    return vpls ? uvec2(args.num_lamps, radial_count) : uvec2(args.num_fine, args.num_lamps);
}

// Pieces along each side that a cell is cut into for a VPL so many cells away. VPLs are smooth: each stands for
// a piece of a surface.
uint lattice_lamps_vpl_pieces(float cells_away)
{
    return cells_away < 1.0 ? 3u : cells_away < 2.0 ? 2u : 1u;
}
