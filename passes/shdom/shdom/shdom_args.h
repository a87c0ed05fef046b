// shdom_args.h -- push constants of the spherical-harmonics discrete-ordinates solver. Included by C and GLSL.
//
// Coefficients of real spherical harmonics are numbered l^2 + l + m. Tables and buffers of them have room for whole groups
// of SHDOM_GROUP, as a thread does that many.
#include "shaders/common/shared.h"

#define SHDOM_MAX_BANDS 10
#define SHDOM_LEAST_ZENITHS                                                                        \
    4 // of the quadrature: two directions, as one band would do with, are none
#define SHDOM_MAX_ORDINATES (2 * SHDOM_MAX_BANDS * SHDOM_MAX_BANDS)
#define SHDOM_GROUP 16

struct shdom_args {
    tyn_uvec3 dims; // cells
    tyn_uint channels;
    tyn_vec3 tint;
    tyn_uint ch; // the channel that is solved
    float dx;    // m
    tyn_uint bands;
    tyn_uint coefficients;  // with those that fill the last group
    tyn_uint ordinates;     // of the quadrature, likewise
    tyn_uint first, count;  // ordinates of this batch
    tyn_uint num_ordinates; // of the quadrature
    tyn_uint sky;           // principal ordinates at most
    tyn_uint lamps;
};
TYN_ASSERT_SIZE(shdom_args, 68);
