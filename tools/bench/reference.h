// reference.h -- converged pictures with their standard errors: by `path`, stored with the suite or kept in the cache,
// or a file of the user's.
#pragma once
#include "ceilings.h"
#include "machine.h"
#include "metrics.h"
#include "paces.h"
#include "suite.h"
#include <tyndall/io.h>
#include <tyndall/offline.h>

// Errors over blocks of suite->block and per pixel; a third measure is FLIP. Seeds of references begin at the last.
enum { BENCH_BLOCKS = 2, BENCH_MEASURES = 3, BENCH_REFERENCE_SEED = 1000003 };

// What is measured on.
typedef struct bench_machine {
    tyn_device *device;
    const char *name, *driver, *type; // as in <tyndall/device.h>
    uint64_t library;                 // library_hash
    ceilings ceilings;
    paces paces; // 0: no fronts are written
} bench_machine;

extern const char *const bench_reference_channels[6];

typedef struct bench_reference {
    tyn_image_file file;
    metrics_image image; // borrows from file
    char key[17];        // hash of its content
    char file_key
        [17]; // hash of the file that it was taken from, the suite's or the user's; "": from none
    uint32_t blocks[BENCH_BLOCKS];
    uint32_t spp;               // of `path`; 0: it is a file
    double seconds, spent;      // what rendering it took in all, and in this call
    bool stored, cached;        // it was there, with the suite or in the cache
    bool known_noise;           // it carries standard errors
    double noise[BENCH_BLOCKS]; // metrics.n of the reference alone; 0 where it is not known
    double flip_noise;          // FLIP of the reference with noise of its size added
    double bias_se;             // standard error of its sum, relative to the sum
} bench_reference;

// A hash of all that is rendered, whatever it is called and wherever it lies: media, grids, surfaces, lights,
// environment, camera, size.
uint64_t bench_scene_hash(const tyn_scene *scene, const tyn_view *view);

// A stored reference is taken as it is, unless `make`: then its rendering goes on until the scene's goal, and it is
// stored anew. `on` may be NULL where the reference is a file. Gives the exit code; bench_reference_finish is due in any
// case.
int bench_reference_get(app *a, const bench_machine *on, const bench_suite *suite,
                        const bench_scene *spec, const tyn_scene *scene, const tyn_view *view,
                        bool make, bench_reference *r);
void bench_reference_finish(bench_reference *r);

// Noise and bias_se, from the standard errors.
void bench_reference_measure(bench_reference *r);

// Planar R, G, B (and errors, or NULL) of the last frame, in `planes` of 6 w h floats.
void bench_planes(tyn_offline *offline, const tyn_view *view, float *planes, metrics_image *image);

// R, G, B (and with `errors` their standard errors) as an EXR file. Gives the exit code.
int bench_picture_write(app *a, const metrics_image *image, bool errors, const char *path);
