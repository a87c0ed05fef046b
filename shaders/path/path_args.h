// path_args.h -- push constants and results of the path tracer's kernels. Included by C and GLSL.
#ifndef TYN_PATH_ARGS_H
#define TYN_PATH_ARGS_H
#include "shaders/common/shared.h"

// Specialisation constants: what a scene has, so that what it has not costs nothing.
#define TYN_PATH_SPEC_SHAPES 0      // exactly so many shapes; 0: more than TYN_PATH_SHAPES_MAX
#define TYN_PATH_SPEC_HOMOGENEOUS 1 // that shape has no density grid
#define TYN_PATH_SPEC_GREY 2        // coefficients are equal in all channels
#define TYN_PATH_SPEC_LIGHTS 3      // 0, 1, or 2 = several
#define TYN_PATH_SPEC_ENVIRONMENT 4 // TYN_PATH_ENV_*
#define TYN_PATH_SPEC_FLAGS 5       // TYN_PATH_* bits
#define TYN_PATH_SPEC_FEW 6         // triangles, if they are at most TYN_SURFACE_FEW; else 0
#define TYN_PATH_NUM_SPEC 7

#define TYN_PATH_SHAPES_MAX 4 // shapes that are kept in registers

#define TYN_PATH_ENV_NONE 0
#define TYN_PATH_ENV_CONSTANT 1
#define TYN_PATH_ENV_MAP 2

#define TYN_PATH_REPEAT 1u       // some axis is periodic
#define TYN_PATH_EMISSIVE 2u     // some medium emits
#define TYN_PATH_GUIDED 4u       // directions are drawn by where light comes from as well
#define TYN_PATH_EQUIANGULAR 8u  // lamps in or near the media: equi-angular distance sampling
#define TYN_PATH_LAYERS 16u      // first-order light and transmittance are kept as well
#define TYN_PATH_SPHERE 128u     // the only shape is a sphere
#define TYN_PATH_LAMPS 64u       // some light is a point or spot light
#define TYN_PATH_SCATTERED 32u   // probes leave out light that comes straight from its source
#define TYN_PATH_SURFACES 256u   // there are triangles
#define TYN_PATH_EMITTERS 512u   // ... and a table by which emissive ones are drawn
#define TYN_PATH_TEXTURES 4096u  // some materials have textures
#define TYN_PATH_KEEP_FEW 16384u // few triangles are kept in registers
#define TYN_PATH_QUEUE 8192u     // images: threads take pieces of work one after another
#define TYN_PATH_THIN 2048u      // first flights are stretched: args.stretch
#define TYN_PATH_GLOW 32768u     // some medium emits by a grid
#define TYN_PATH_ALBEDO 65536u   // some medium has an albedo by a grid
#define TYN_PATH_TABLED 131072u  // some phase functions are tables
#define TYN_PATH_ENDED 262144u   // images: paths end in a field that is given
#define TYN_PATH_FIELD 524288u   // images: a field says where light comes from; else a light does
#define TYN_PATH_SHORT_LOOPS 2097152u // tyn_capacity.short_loops
#define TYN_PATH_ONE_PHASE 1048576u   // the phase functions of all channels are equal
// Balance: the first flights of light are followed from suns and lamps.
#define TYN_PATH_FROM_LIGHTS 1024u

struct path_args {
    tyn_uint first;                     // pixel or point of the first thread; balance: block
    tyn_uint num;                       // pixels or points of this dispatch
    tyn_uint slots;                     // threads a pixel
    tyn_uint first_sample, num_samples; // of this dispatch, for every pixel
    tyn_uint seed;
    tyn_uint num_lights;
    tyn_uint max_depth; // longest path, scatterings
    tyn_uint rr_depth;  // Russian roulette from this many scatterings on
    tyn_uint max_steps; // safety cap: tentative collisions and brick crossings of one path
    float sigma_guess;  // typical extinction, 1/m: weighs equi-angular against free-flight sampling
    float stretch;     // thin media: first flights are drawn for an extinction so many times larger
    tyn_vec3 world[3]; // probes: the world's axes in M
    tyn_vec3 box_lo, box_hi; // balance of surfaces: the box that light enters and leaves, M
};
TYN_ASSERT_SIZE(path_args, 108);

// What one thread found: mean and sum of squared deviations of its samples.
struct path_partial {
    tyn_vec3 mean, deviation; // radiance
    float alpha;              // mean of 1 - transmittance
    tyn_uint count;
};
TYN_ASSERT_SIZE(path_partial, 32);

struct path_partial_layers { // means
    tyn_vec3 single, multiple, transmittance;
};
TYN_ASSERT_SIZE(path_partial_layers, 36);

struct path_resolve_args {
    tyn_uint first, num; // pixels or points, as in path_args
    tyn_uint slots;
    tyn_uint width;          // of the image, pixels
    tyn_uint samples_before; // in the running statistics; 0: start anew. Balance: bits of a float
    tyn_uint layers;         // 1: single, multiple, transmittance as well
    tyn_uint opaque;         // 1: a background is seen, alpha is 1
    tyn_uint resumed;        // images: 1: they are those that are gone on from
    tyn_vec3 lamps;          // balance: power of the lamps inside, W
};
TYN_ASSERT_SIZE(path_resolve_args, 44);

// A probe's values: fluence (3 channels), then net flux (3 axes of M x 3 channels).
#define TYN_PATH_PROBE_VALUES 12

struct path_probe_partial { // of a thread's samples, or of all so far
    float mean[TYN_PATH_PROBE_VALUES], deviation[TYN_PATH_PROBE_VALUES];
    tyn_uint count;
};
TYN_ASSERT_SIZE(path_probe_partial, 100);

struct path_probe_state { // running statistics of a point
    float mean[TYN_PATH_PROBE_VALUES], low[TYN_PATH_PROBE_VALUES], deviation[TYN_PATH_PROBE_VALUES];
};
TYN_ASSERT_SIZE(path_probe_state, 144);

struct path_probe_result { // as tyn_probe_result
    float value[TYN_PATH_PROBE_VALUES], error[TYN_PATH_PROBE_VALUES];
};
TYN_ASSERT_SIZE(path_probe_result, 96);

// A balance's values, 3 channels each: entering, emitted, absorbed by media, escaped, absorbed by surfaces; W. Then
// what is given less what is taken of the same samples, for its standard error.
#define TYN_PATH_BALANCE_VALUES 18
// Paths of a balance are numbered in blocks, as more than 2^32 are drawn in minutes: a multiple of all numbers of kinds of points.
#define TYN_PATH_BALANCE_BLOCK 3221225472u

struct path_balance_partial { // likewise
    float mean[TYN_PATH_BALANCE_VALUES], deviation[TYN_PATH_BALANCE_VALUES];
    tyn_uint count;
};
TYN_ASSERT_SIZE(path_balance_partial, 148);

struct path_balance_state {
    float mean[TYN_PATH_BALANCE_VALUES], low[TYN_PATH_BALANCE_VALUES],
        deviation[TYN_PATH_BALANCE_VALUES];
};
TYN_ASSERT_SIZE(path_balance_state, 216);

struct path_balance_result {
    float value[TYN_PATH_BALANCE_VALUES], error[TYN_PATH_BALANCE_VALUES];
};
TYN_ASSERT_SIZE(path_balance_result, 144);

// The fluxes' values, 3 channels each, W: as tyn_flux_values.
#define TYN_PATH_FLUX_INCIDENT 0
#define TYN_PATH_FLUX_LEAVING 1 // six faces
#define TYN_PATH_FLUX_DIRECT 7
#define TYN_PATH_FLUX_REFLECTED 8
#define TYN_PATH_FLUX_TRANSMITTED 9
#define TYN_PATH_FLUX_ABSORBED_MEDIA 10
#define TYN_PATH_FLUX_ABSORBED_SURFACES 11
#define TYN_PATH_FLUX_ARRIVING_SURFACES 12
#define TYN_PATH_FLUX_MISSING 13
#define TYN_PATH_FLUX_VALUES 42
#define TYN_PATH_FLUX_LANES 64 // of a workgroup that sums

struct path_fluxes_state { // running statistics
    float mean[TYN_PATH_FLUX_VALUES], low[TYN_PATH_FLUX_VALUES], deviation[TYN_PATH_FLUX_VALUES];
    float threads[TYN_PATH_FLUX_VALUES]; // so far
};
TYN_ASSERT_SIZE(path_fluxes_state, 672);

struct path_fluxes_result { // as tyn_fluxes
    float value[TYN_PATH_FLUX_VALUES], error[TYN_PATH_FLUX_VALUES];
};
TYN_ASSERT_SIZE(path_fluxes_result, 336);

struct path_fluxes_sum_args {
    tyn_uint threads;      // of this dispatch, a multiple of TYN_PATH_FLUX_LANES
    tyn_uint paths;        // of each
    tyn_uint paths_before; // of each, in the running statistics; 0: start anew
};
TYN_ASSERT_SIZE(path_fluxes_sum_args, 12);

#endif
