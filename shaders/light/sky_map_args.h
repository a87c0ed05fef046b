// sky_map_args.h -- depth maps of the directions of the sky. Included by C and GLSL.
//
// A principal ordinate stands for a region of the sky. Its directions, a fan, are those of a finer partition: each has the light
// of its part of the region, and a depth map; a second and coarser one where surfaces stand far beyond the box that pictures are
// of. The list of directions is a struct ordinates_block as well, which begins with the same fixed ones.
#ifndef TYN_SKY_MAP_ARGS_H
#define TYN_SKY_MAP_ARGS_H
#include "shadow_args.h"

#define TYN_SKY_FAN 4 // directions of an ordinate, at most

// The ordinate of direction i.
TYN_FUNCTION tyn_uint tyn_sky_ordinate(tyn_uint i, tyn_uint num_fixed, tyn_uint fan)
{
    return i < num_fixed ? i : num_fixed + (i - num_fixed) / fan;
}

struct sky_frames_args {
    tyn_uint across; // maps in a row of the atlas
    float texels;    // a side of a map
    float reach; // of the first maps beyond the box, in its longest sides; 0: wherever surfaces are
    tyn_uint count;            // of directions; maps after so many are the second ones
    tyn_vec3 near_lo, near_hi; // M: the box
};
TYN_ASSERT_SIZE(sky_frames_args, 40);

struct sky_corners_args {
    tyn_uint num_triangles;
};
TYN_ASSERT_SIZE(sky_corners_args, 4);

struct sky_draw_args {
    tyn_uint map;
};
TYN_ASSERT_SIZE(sky_draw_args, 4);

#endif
