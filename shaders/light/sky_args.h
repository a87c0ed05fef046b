// sky_args.h -- an environment map without its suns, as a pyramid and as sums. Included by C and GLSL.
#ifndef TYN_SKY_ARGS_H
#define TYN_SKY_ARGS_H
#include "shaders/common/shared.h"

// Latitude-longitude texels of the map's own frame (environment.glsl: environment_uv).
#define SKY_WIDTH 512
#define SKY_HEIGHT 256
#define SKY_MIPS 10

// Sums over the rectangles from texel (0, 0) to texel (x, y) exclusive, of a coarser image: entry
// y * (SKY_SUMS_WIDTH + 1) + x. The sum over any rectangle is four entries away.
#define SKY_SUMS_WIDTH 128
#define SKY_SUMS_HEIGHT 64

#define SKY_SUNS_MAX 4

struct sky_sun {        // of the map, taken out of it: within its disc a texel is at most `around`
    tyn_vec3 direction; // towards it, map frame
    float cos_radius;
    tyn_vec3 around;
};
TYN_ASSERT_SIZE(sky_sun, 28);

struct sky_sum {
    tyn_vec3 power;  // integral of the radiance, map units
    float luminance; // of it
    tyn_vec3 moment; // integral of luminance times direction (map frame)
    float pad;
};
TYN_ASSERT_SIZE(sky_sum, 32);

#endif
