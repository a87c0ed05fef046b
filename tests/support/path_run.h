// path_run.h -- whole scenes through method `path`, for tests that compare with references.
#pragma once
#include "gpu_test.h"
#include "picture.h"

// Standard errors come with every figure. Scenes come from malloc'ed arrays as solids.h and picture.h make them.
typedef struct path_run {
    tyn_offline *off;
    tyn_device *dev;
    uint32_t seed;
    bool kept;     // results come from tests/references where they are there (references.h)
    gpu_test *gpu; // of the setups below; NULL otherwise
    // The last result that was read.
    tyn_probe_result *probes;
    tyn_balance balance;
    tyn_fluxes fluxes;
} path_run;

// References for other methods: kept.
void path_run_open(path_run *r, tyn_device *dev);
void path_run_close(path_run *r);
// cmocka group setup and teardown: *state is a path_run on the device of gpu_setup. The first is for tests of `path`
// itself, which always runs; the second for tests of other methods.
int path_run_setup(void **state);
int path_run_setup_kept(void **state);
int path_run_teardown(void **state);

// A kept reference by `path` with view->seed.
void path_reference(picture *p, tyn_device *dev, const tyn_scene *scene, const tyn_view *view,
                    uint32_t samples);
// Pictures of view->width x height; `samples` of each pixel. What was in `p` is freed.
void path_run_picture(path_run *r, picture *p, const tyn_scene *scene, const tyn_view *view,
                      uint32_t samples);
// An output of the same view, 4 floats a pixel, valid until the next run.
const float *path_run_layer(path_run *r, const tyn_scene *scene, const tyn_view *view,
                            tyn_output output, uint32_t samples);
// Valid until the next run.
const tyn_probe_result *path_run_probe(path_run *r, const tyn_scene *scene,
                                       const float (*points)[3], uint32_t num_points,
                                       bool scattered, uint32_t samples);
// Samples of some ten thousand paths.
const tyn_balance *path_run_balance(path_run *r, const tyn_scene *scene, uint32_t samples);
// Samples of 4096 paths.
const tyn_fluxes *path_run_fluxes(path_run *r, const tyn_scene *scene, uint32_t samples);

// A pinhole at `from`; `tangent` of half the vertical field of view.
void view_perspective(tyn_view *view, const float from[3], const float at[3], float tangent,
                      uint32_t n);
void scene_add_lamp(tyn_scene *scene, const float position[3], float intensity);

// How far apart two pictures are in units of their noise.
typedef struct picture_score {
    double bias, bias_se; // of the sum over all pixels, relative
    double rms;           // of z over blocks
    double largest;       // |z| of a block
} picture_score;
picture_score picture_z(const picture *a, const picture *reference, uint32_t block,
                        uint32_t channel);

uint32_t path_effort(uint32_t samples); // times TYN_LONG, if that is set
