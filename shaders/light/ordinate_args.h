// ordinate_args.h -- principal ordinates: the directions from which a map lights the medium.
// Included by C and GLSL; scalar layout.
//
// The ordinates partition the sphere into regions. Each stands for all the light of its region, as if
// it came evenly from a cone of the region's solid angle around one direction.
#ifndef TYN_ORDINATE_ARGS_H
#define TYN_ORDINATE_ARGS_H
#include "shaders/common/shared.h"

#define TYN_ORDINATES_MAX 256
#define TYN_ORDINATES_MAX_FIXED 68 // suns: ready-made ordinates that come first

struct ordinate {
    // W/m^2 across the direction: integral of the radiance over the region. Where the mean of the
    // sky was split off it may be negative.
    tyn_vec3 irradiance;
    // Of the region about its own mean direction: 1 - solid_angle / (4 pi), 1 = a point.
    float mean_cosine;
    // Of travel, M, unit: the opposite of the region's energy-weighted mean direction.
    tyn_vec3 direction;
    float solid_angle; // of its cone, sr: its region's
    // What an even radiance of 1 from its region gives: 4 pi and 0 over all ordinates; of suns 0.
    float even;
    tyn_vec3 even_flux; // M
};
TYN_ASSERT_SIZE(ordinate, 48);

struct ordinates_block { // uniform or storage buffer "ordinates"; the tail beyond `count` is zero
    tyn_uint count;      // in use, 0 to TYN_ORDINATES_MAX
    tyn_uint num_fixed;  // the first ones: suns that have no aligned grid of full resolution
    tyn_uvec2 pad;
    TYN_STRUCT(ordinate) list[TYN_ORDINATES_MAX];
};
TYN_ASSERT_SIZE(ordinates_block, 12304);

#endif
