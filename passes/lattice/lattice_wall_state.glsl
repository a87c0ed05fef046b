// lattice_wall_state.glsl -- the radiance that the walls of a cell send out, as part of the solve's state.
//
// The state's vectors are the moments of all cells of all channels; then, where there are walls, their
// radiance, four cells of a channel to a vector. Include after lattice_args.h, with the push constants args.
// Define LATTICE_WALL_LINKS, LATTICE_WALL_CELLS: bindings of the pass walls' buffers.
#include "shaders/walls/walls_args.h"

#ifdef LATTICE_WALL_LINKS
layout(binding = LATTICE_WALL_LINKS) uniform usamplerBuffer wall_links_words;

uint lattice_wall_links(uint cell)
{
    return texelFetch(wall_links_words, int(cell)).x;
}
#endif
#ifdef LATTICE_WALL_CELLS
layout(binding = LATTICE_WALL_CELLS) uniform samplerBuffer wall_cells_texels; // four to a struct wall_cell

// Albedo; a = area.
vec4 lattice_wall_surface(uint cell)
{
    return texelFetch(wall_cells_texels, int(4u * cell + 3u));
}
#endif

uint lattice_all_cells()
{
    return args.dims.x * args.dims.y * args.dims.z;
}

// Vector that holds the wall radiance of a cell, its component being cell % 4.
uint lattice_wall_vector(uint ch, uint cell)
{
    uint n = lattice_all_cells();
    return args.channels * n + ch * ((n + 3u) / 4u) + cell / 4u;
}
