// cell_places.glsl -- four places in a cell of the lattice that stand for all of it.
#ifndef CELL_PLACES_GLSL
#define CELL_PLACES_GLSL

// From its centre, in edges: corners of a tetrahedron.
vec3 place_in_cell(uint k)
{
    return 0.25 * (1.0 - 2.0 * vec3(k == 2u || k == 3u, k == 1u || k == 3u, k == 1u || k == 2u));
}

#endif
