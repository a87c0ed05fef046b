// reference.h -- converged pictures with their standard errors: by `path`, cached by what they depend on, or a
// file of the user's.
#pragma once
#include "machine.h"
#include "metrics.h"
#include "suite.h"
#include <tyndall/io.h>
#include <tyndall/offline.h>

// Errors over blocks of suite->block, and per pixel.
enum { BENCH_BLOCKS = 2, BENCH_REFERENCE_SEED = 1000003 };

typedef struct bench_reference {
    tyn_image_file file;
    metrics_image image; // borrows from file
    char key[17];        // of what it depends on; of a file its content's hash
    double seconds;      // what rendering it took; 0: it was there
    bool cached;
    bool known_noise;           // it carries standard errors
    double noise[BENCH_BLOCKS]; // metrics.n of the reference alone; 0 where it is not known
    double bias_se;             // standard error of its sum, relative to the sum
} bench_reference;

// A hash of all that is rendered, whatever it is called and wherever it lies: media, grids, surfaces, lights,
// environment, camera, size.
uint64_t bench_scene_hash(const tyn_scene *scene, const tyn_view *view);

// Gives the exit code; bench_reference_finish is due in any case. `label` names the scene in messages.
int bench_reference_get(app *a, tyn_device *device, const bench_scene *spec, const tyn_scene *scene,
                        const tyn_view *view, const uint32_t blocks[BENCH_BLOCKS],
                        bench_reference *r);
void bench_reference_finish(bench_reference *r);

// Planar R, G, B (and errors, or NULL) of the last frame, in `planes` of 6 w h floats.
void bench_planes(tyn_offline *offline, const tyn_view *view, float *planes, metrics_image *image);

// R, G, B (and with `errors` their standard errors) as an EXR file. Gives the exit code.
int bench_picture_write(app *a, const metrics_image *image, bool errors, const char *path);
