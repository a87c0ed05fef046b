// median_cut_args.h -- the light constellation of an environment. Included by C and GLSL; scalar layout.
#include "../common/constellation_args.h"

struct median_cut_args {
    tyn_uint lights; // wanted: 1 .. TYN_CONSTELLATION_MAX
    tyn_uint map;    // 1: of the map's sums; 0: of a radiance that is 1 in all directions
};
TYN_ASSERT_SIZE(median_cut_args, 8);
