// path_scene.h -- small scenes for the path tracer, given straight as the blocks that its shaders read, and
// runs of it. Positions are in M: the box's corner is the origin.
#pragma once
#include "gpu_test.h"
#include "shaders/common/counters.h"
#include "passes/path/path.h"
#include "passes/path_probe/path_probe.h"
#include "passes/path_balance/path_balance.h"
#include "passes/path_fluxes/path_fluxes.h"
#include "passes/path_distance/path_distance.h"
#include "shaders/path/path_args.h"
#include "shaders/common/scene_args.h"
#include <tyndall/context.h>

typedef struct path_scene {
    struct medium_block medium;
    struct shape_block shapes[4];
    struct light_block lights[8];
    struct camera_block camera;
    struct env_block environment;
    const float *grid; // of the atlas, NULL: homogeneous
    uint32_t grid_size[3];
    tyn_environment map; // data NULL: constant
    tyn_path_params params;
    uint32_t samples; // of a record
    bool may_cut;     // paths may meet the safety cap
} path_scene;

// A box [0, extent] of one medium, coefficients at density 1. `grid` (may be NULL) is kept by reference.
void path_scene_box(path_scene *s, const float extent[3], const float sigma_s[3],
                    const float sigma_a[3], const float g[3], const float *grid,
                    const uint32_t grid_size[3]);
// A unit cube, homogeneous or the same through a grid of ones, seen from the side: 16 x 16 pixels along +y.
void path_scene_cube(path_scene *s, float sigma_s, float sigma_a, float g, bool grid);
void path_scene_sun(path_scene *s, const float direction[3], const float irradiance[3]);
void path_scene_lamp(path_scene *s, const float position[3], const float intensity[3]);
void path_scene_sky(path_scene *s, float radiance); // constant
// Axes of the image as the reference images have them: columns along up x direction. `n` x `n` pixels.
void path_scene_orthographic(path_scene *s, const float centre[3], const float direction[3],
                             const float up[3], float half, uint32_t n);

// Uploads the scene into the bundle TYN_PATH_SCENE, which `refs` begin with.
void path_scene_declare(gpu_test *t, path_scene *s, tyn_ref *refs);

// Four floats a pixel, valid until the next run. error may be NULL.
void path_scene_render(gpu_test *t, path_scene *s, uint32_t samples, const float **radiance,
                       const float **error);
// Entering, emitted, absorbed, escaped (3 channels each), W, and their standard errors.
const struct path_balance_result *path_scene_balance(gpu_test *t, path_scene *s, uint32_t samples,
                                                     const tyn_balance **balance);
// A record's samples more, after `done`.
const tyn_probe_result *path_scene_probe_more(gpu_test *t, path_scene *s, const float (*points)[3],
                                              uint32_t num_points, uint32_t done);
const tyn_probe_result *path_scene_probe(gpu_test *t, path_scene *s, const float (*points)[3],
                                         uint32_t num_points, uint32_t samples);
// Where light of suns and surroundings goes; `samples` paths, a multiple of 4096.
const tyn_fluxes *path_scene_fluxes(gpu_test *t, path_scene *s, uint32_t samples);

// Prints a value, one standard error of it and what it should be; fails beyond 3.5 of these.
void path_scene_check(const char *what, double value, double error, double expected);
