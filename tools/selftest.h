// selftest.h -- what the checks of `tyndall selftest` share.
#pragma once
#include "renderer.h"
#include "selftest_scenes.h"
#include <cjson/cJSON.h>

typedef struct selftest {
    app *a;
    bool json;
    tyn_device *device;
    cJSON *checks;
    uint32_t num_checks, num_failed, num_skipped;
} selftest;

// One check: |value - expected| <= tolerance. `source`: where the expected value is from.
void selftest_check(selftest *t, const char *name, double value, double expected, double tolerance,
                    const char *source);
void selftest_skip(selftest *t, const char *name, const char *why); // neither passed nor failed

// Goes through the methods in turn: the next one and what it promises, from *index on (0 at first). False: there are no
// more.
bool selftest_next(uint32_t *index, tyn_method_info *info, const tyn_promise **promise);

// Renders with a method ("pop", NULL settings = defaults); `r` is open afterwards if the exit code is
// EXIT_DONE, and closed if it is not.
int selftest_render(selftest *t, const char *method, tyn_scene *scene, const tyn_view *view,
                    renderer *r);

// The cube with g 0.5 under its sun: what every method can do.
int selftest_render_cube(selftest *t, const char *name, uint32_t samples, renderer *r);

enum { SELFTEST_SIZE = 32, SELFTEST_SAMPLES = 64 }; // pixels along a side; samples a pixel
tyn_view selftest_picture(uint32_t outputs);        // without a camera

// Mean over pixels and channels of such a picture, and its standard error where `errors` is not NULL.
double selftest_mean(const float *pixels, const float *errors, double *se);

// The groups of checks; each gives an exit code.
int selftest_furnace(selftest *t); // selftest_pictures.c
int selftest_cubes(selftest *t);
int selftest_energy(selftest *t);
int selftest_rows(selftest *t);
int selftest_repeats(selftest *t);
int selftest_slabs(selftest *t); // selftest_tables.c
int selftest_half_space(selftest *t);
int selftest_lamps(selftest *t);
int selftest_graphs(selftest *t); // selftest_graphs.c
int selftest_files(selftest *t);  // selftest_files.c
