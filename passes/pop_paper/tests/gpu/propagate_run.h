// propagate_run.h -- the pass propagate_rect alone on the device: media and lights to run it on, what it leaves, and that
// against the twin.
#pragma once
#include "gpu_test.h"
#include "propagate_twin.h"
#include "passes/pop_paper/propagate_rect/propagate_rect.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/light/shadow_args.h"
#include "shaders/surfaces/surface_args.h"
#include "passes/pop_paper/propagate_rect/propagate_rect_args.h"
#include "shaders/common/scene_args.h"

enum { MAX_SUNS = 2, ATLAS = 64 };

typedef struct setup {
    struct medium_block medium;
    const float *density;     // or sigma_s, RGBA, with the two below
    const float *sigma_a, *g; // or NULL
    struct light_block suns[MAX_SUNS];
    struct camera_block camera;
    struct ordinates_block ordinates; // behind the suns
    const float *atlas;               // of a map of the first sun, ATLAS^2 depths, or NULL
    struct shadow_light map;
    uint32_t num_suns;
    tyn_propagate_rect_params params;
} setup;

typedef struct texel {
    float c[4];
} texel;

// Stacks of grids and channels: what of L leaves a cell ahead, to a side and behind, and its 1 - a; L_acc;
// scattering and absorption depths of a cell, g, cosine to the eye.
typedef struct outcome {
    const texel *state, *cells;
    const float *seen;
    const struct propagate_grid *grids;
    const float *lit; // per grid, not per stack
    const struct propagate_place *places;
} outcome;

enum { N = 12, CELLS = N * N * N }; // of `oblique`

outcome propagate_run(gpu_test *t, const setup *s);

// ---- what to run --------------------------------------------------------------------------------

void set_medium(setup *s, const float extent[3], const uint32_t size[3], const float *density);
// The unit cube of 16^3 voxels under a sun of unit irradiance along +z, seen from `to_eye`.
setup unit_cube(const float *density, float sigma_s, float g, const float to_eye[3]);
// Two coloured suns askew on a box of 12 x 16 x 10 random voxels, which `density` gets.
setup oblique(float *density);
// Directions spread evenly over the sphere, on a spiral; regions of unequal size.
void set_ordinates(setup *s, uint32_t count);

// ---- what it left -------------------------------------------------------------------------------

// What leaves a cell, all neighbours together; the same of n cells.
double sent(const outcome *o, int q);
double total(const outcome *o, int first, int n);
// L in the middle of the cell; the state is what has come to its faces. `stretch`: edge of the cell across the light over
// that along it.
double light_of(const outcome *o, int q, double stretch);
// What half a cell leaves of the mean cosine.
double kept_cosine(const outcome *o, int q, bool exact);
// M position of a point in cells of a grid.
void to_m(const struct propagate_grid *grid, const double cell[3], double p[3]);
// Largest relative difference (of values below 1e-6: absolute, in 1e-6) where `weight` > 1e-6 of its
// maximum.
double worst(const double *found, const double *expected, int n, const double *weight);
// One channel of one grid against the twin: the largest difference. The aligned grid is that of the device, whose cells the
// test `grids_span_the_medium` checks.
double compare_channel(const setup *s, const outcome *o, int index, int c);
