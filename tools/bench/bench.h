// bench.h -- measurements of a suite: errors, times, memory, and what a baseline needs for the same error.
#pragma once
#include "suite.h"
#include "metrics.h"
#include "renderer.h"
#include <tyndall/io.h>

enum { BENCH_BLOCKS = 2, BENCH_MAX_NODES = 32 }; // error over blocks of suite->block, and per pixel

// A reference picture with its standard errors, and how it was made.
typedef struct bench_reference {
    tyn_image_file file;
    metrics_image image;        // borrows from file
    double seconds;             // 0: it was in the cache
    double noise[BENCH_BLOCKS]; // metrics.n of the reference alone
} bench_reference;

typedef struct bench_node {
    char name[48], state[16]; // state after the camera moved
    double gpu_ms;            // median over the cold frames
    double steps;             // work "steps" of the last cold frame, 0 = does not count them
    uint64_t bytes;
    bool setup; // depends on the media alone: not part of a frame
} bench_node;

// What a baseline needs for the error of a run.
typedef struct bench_equal {
    double spp, ms; // at that error
    bool measured;  // false: extrapolated from fewer samples
} bench_equal;

typedef struct bench_result {
    metrics error[BENCH_BLOCKS];
    double setup_ms, cold_ms, camera_ms, unchanged_ms;
    uint64_t persistent, transient;
    bench_node nodes[BENCH_MAX_NODES];
    uint32_t num_nodes;
    bench_equal equal[BENCH_MAX_BASELINES][BENCH_BLOCKS];
    bool failed; // the method cannot do this scene; the reason went to stderr
} bench_result;

// A scene that is being measured.
typedef struct bench_case {
    app *a;
    tyn_device *device;
    const bench_suite *suite;
    const bench_scene *spec;
    uint32_t blocks[BENCH_BLOCKS];
    tyn_scene scene;
    tyn_view view;
    bench_reference reference;
    double
        fill; // share of the pixels that see the medium (transmittance below 0.99); NaN = not known
} bench_case;

// Renders the reference or takes it from the cache ($XDG_CACHE_HOME/tyndall/references).
int bench_reference_get(bench_case *c);
void bench_reference_finish(bench_reference *r);

// Error, times, memory and nodes of a run. EXIT_DONE with result->failed where the method cannot.
int bench_measure(bench_case *c, const bench_run *run, bench_result *result);

// A rendering of a baseline: its time, and its error without the noise of the reference.
typedef struct bench_sample {
    uint32_t spp; // 0: not rendered
    double ms, error[BENCH_BLOCKS];
} bench_sample;

// How the error of a baseline falls, found once a scene, and then what it needs at an error.
typedef struct bench_baseline {
    bench_sample pilot;   // of suite->pilot_spp
    bench_sample longest; // of suite->max_seconds, when it was first needed
} bench_baseline;
int bench_baseline_pilot(bench_case *c, const bench_run *run, bench_baseline *b);
int bench_baseline_equal(bench_case *c, const bench_run *run, bench_baseline *b,
                         uint32_t block_index, double error, bench_equal *equal);

// Planar R, G, B (and errors, or NULL) of the last frame, in `planes` of 6 w h floats.
void bench_planes(tyn_offline *offline, const tyn_view *view, float *planes, metrics_image *image);

// The table on stdout, and the same and more as JSON.
void bench_print_scene(const bench_case *c);
void bench_print_result(const bench_case *c, const bench_run *run, const bench_result *result);
cJSON *bench_json_scene(const bench_case *c);
cJSON *bench_json_result(const bench_case *c, const bench_run *run, const bench_result *result);
