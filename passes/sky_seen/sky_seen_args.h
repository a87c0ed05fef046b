// sky_seen_args.h -- push constants of sky_seen. Included by C and GLSL.
#include "shaders/common/shared.h"

struct sky_seen_args {
    tyn_vec3 extent; // of the medium, m
    tyn_uvec3 dims;  // cells
    tyn_uint count;  // ordinates at most
    tyn_uint fan;    // directions of each
    tyn_vec3 tint;   // of the sky's radiance: its share of the map's colours, the most is 1
};
TYN_ASSERT_SIZE(sky_seen_args, 44);
