// walls_args.h -- what surfaces are to the cells of the lattice. Included by C and GLSL; scalar layout.
//
// A link is the segment between the centres of a cell and of one of its 26 neighbours, also of those
// outside the lattice. Light passes along a link unless a triangle cuts it. Links 0..13 are the
// directions of lattice_step, links 14..25 those along the diagonals of faces (walls_step).
#ifndef TYN_WALLS_ARGS_H
#define TYN_WALLS_ARGS_H
#include "shaders/common/shared.h"

#define TYN_WALLS_LINKS 26
#define TYN_WALLS_PLANES 3
// Element of storage buffer "wall_links", one per cell, x fastest: bit i = link i is cut, and:
// A wall passes through the cell or cuts a link to a cell of the lattice: only then `planes` say
// anything, and light must not be blended freely.
#define TYN_WALLS_NEAR (1u << 26)

// A cell belongs to one side of its walls, that of its centre, which counts as moved by so many cell
// edges: walls that lie exactly in the plane of the centres are below them, on all axes. Powers of two
// less and more than each other, so that planes through several centres are not met either.
#define TYN_WALLS_SHIFT_X 0.00390625f
#define TYN_WALLS_SHIFT_Y 0.00463867188f
#define TYN_WALLS_SHIFT_Z 0.00341796875f

struct wall_cell { // element of storage buffer "wall_cells"
    // Of the walls in the cell, nearest first: dot(xyz, p) + w, p in M, is its distance in m, > 0
    // on the side of the centre; 0: none.
    tyn_vec4 planes[TYN_WALLS_PLANES];
    // Of what the cut links among 0..13 meet, by the power isotropic light brings along each.
    tyn_vec3 albedo;
    float area; // sum of w_j dx / L_j over those links: a quarter of the wall's area over dx^2
};
TYN_ASSERT_SIZE(wall_cell, 64);

#endif
