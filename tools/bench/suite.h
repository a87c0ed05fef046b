// suite.h -- what to measure: a suite file (docs/bench.md).
#pragma once
#include "method_setup.h"
#include "scene_setup.h"
#include <cjson/cJSON.h>

enum { BENCH_MAX_SCENES = 32, BENCH_MAX_RUNS = 32, BENCH_MAX_BASELINES = 4, BENCH_MAX_RATIOS = 8 };

typedef struct bench_scene {
    const char *name;
    char *path; // found: beside the suite, or in the folder of the sample scenes
    scene_options scene;
    view_options view;
    uint32_t lights; // so many of the scene's alone, the first; 0: all
    uint32_t reference_spp;
    const cJSON *json; // the entry itself; part of the reference's key
} bench_scene;

typedef struct bench_run { // a method with settings
    const char *name;
    method_options method;
    char *defines; // memory behind method.defines
    const cJSON *json;
} bench_run;

typedef struct bench_ratio { // of the cold frames of two scenes
    const char *name, *of, *to;
} bench_ratio;

typedef struct bench_suite {
    cJSON *root;
    const char *name;
    bench_scene scenes[BENCH_MAX_SCENES];
    bench_run runs[BENCH_MAX_RUNS];
    bench_run baselines[BENCH_MAX_BASELINES]; // sampling methods, measured at the error of each run
    bench_ratio ratios[BENCH_MAX_RATIOS];
    uint32_t num_scenes, num_runs, num_baselines, num_ratios;
    uint32_t block;     // beside 1
    uint32_t frames;    // timing frames of each kind
    uint32_t pilot_spp; // samples that tell the noise of a baseline
    float max_seconds;  // a baseline that would take longer is not rendered but extrapolated
} bench_suite;

// `path` NULL = the suite that is built in. `scenes` = folder of the sample scenes. Gives the exit code;
// suite_finish is due in any case.
int bench_suite_load(app *a, const char *path, const char *scenes, bench_suite *suite);
void bench_suite_finish(bench_suite *suite);
