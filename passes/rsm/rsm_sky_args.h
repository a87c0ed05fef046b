// rsm_sky_args.h -- places that stand for all surfaces under the sky. Included by C and GLSL; scalar layout.
//
// A triangle counts by its area times how near it is to a box (rsm_sky_places.glsl). Triangles are in blocks of
// RSM_SKY_BLOCK; "areas" has what a triangle and those before it in its block count for, "area_blocks" what all blocks before
// one do, and as one more element the whole.
#include "shaders/common/shared.h"

#define RSM_SKY_BLOCK 256

struct rsm_sky_args {
    tyn_vec3 extent;  // of the box of the media, m; 0 without media
    tyn_uint texels;  // of each side of a map of places, a power of two
    tyn_uvec2 offset; // of the fronts' map in the atlas; that of the backs is to the right of it
    tyn_uvec3 cells;  // of the lattice that has columns along ordinates; 0: nothing dims the sky
    tyn_uint fan;     // directions of an ordinate
    tyn_uint triangles;
    tyn_vec3 near_lo, near_hi; // M: most places are near this box
};
TYN_ASSERT_SIZE(rsm_sky_args, 68);
