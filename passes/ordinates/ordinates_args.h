// ordinates_args.h -- push constants of ordinates. Included by C and GLSL.
#include "shaders/common/shared.h"

struct ordinates_args {
    tyn_vec4 rows[3];   // env_block.rows
    tyn_uint mapped;    // 1: there is a map; 0: the environment is constant
    tyn_uint regions;   // of the partition
    tyn_uint num_fixed; // in front of the list
    tyn_uint split;     // 1: what is above or below the mean of the sky; 0: all light
    tyn_uint weighted;  // 1: regions follow importance, too
    float spread;       // of the mean luminance, added where regions are placed
    tyn_uint fan; // so many regions in a row are a region of the partition for 1 / fan as many
};
TYN_ASSERT_SIZE(ordinates_args, 76);
