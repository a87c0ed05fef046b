// suite.h -- what to measure: a suite file (docs/bench.md), its sweeps written out.
#pragma once
#include "method_setup.h"
#include "scene_setup.h"
#include <cjson/cJSON.h>

enum {
    BENCH_MAX_SCENES = 64,
    BENCH_MAX_RUNS = 256,
    BENCH_MAX_RATIOS = 8,
    BENCH_MAX_PEERS = 8,
    BENCH_MAX_SWEEP = 4
};

// The reference's picture, beside those of the runs.
#define BENCH_REFERENCE_SLUG "reference"

// When a reference is good enough: samples are added until there are `spp`, or a pixel's noise (metrics.n) is at most
// `noise`, or rendering has taken `seconds`.
typedef struct bench_goal {
    uint32_t spp;
    double noise, seconds;
} bench_goal;

typedef struct bench_scene {
    const char *name;
    char *slug;               // the name as part of a file's name, unique in the suite
    char *path, *environment; // found: beside the suite, or in the folder of the sample scenes
    scene_options scene;
    view_options view;
    uint32_t lights; // so many of the scene's alone, the first; 0: all
    bench_goal goal;
    char *reference; // a file instead; NULL: `path` renders it
    const cJSON *json;
} bench_scene;

// A method with settings. An entry with a sweep gives one for each combination of its values.
typedef struct bench_run {
    char *name, *slug;
    const char *group; // the line of a plot that it is a point of
    uint32_t entry;    // of the suite, its runs and then its baselines
    bool swept;        // one of several of its entry
    bool baseline;     // from the list of baselines: a method that samples
    method_options method;
    char *defines;     // memory behind method.defines
    cJSON *spec;       // the entry with the values of its sweep put in place
    const cJSON *only; // names of the scenes it is for; NULL: all
} bench_run;

typedef struct bench_ratio { // of the cold frames of two scenes
    const char *name, *of, *to;
} bench_ratio;

// A renderer that is not of this library: what a file says of its errors and times (peers.h).
typedef struct bench_peer {
    char *file;
    const char *name, *group;
    cJSON *root;
} bench_peer;

typedef struct bench_suite {
    cJSON *root;
    const char *file; // for messages; the caller's
    const char *name, *about;
    uint64_t hash;    // of the file
    char *references; // folder of stored references; NULL: none
    bench_scene scenes[BENCH_MAX_SCENES];
    bench_run runs[BENCH_MAX_RUNS];
    bench_ratio ratios[BENCH_MAX_RATIOS];
    bench_peer peers[BENCH_MAX_PEERS];
    uint32_t num_scenes, num_runs, num_ratios, num_peers;
    uint32_t num_left_out; // entries of runs whose method this build leaves out
    uint32_t block;        // beside 1; 2 or more
    uint32_t frames;       // timing frames of each kind
    float timing_seconds;  // no further frame of a kind is begun after this long
    float warm_seconds; // of frames before those of a kind, so that the device's clock has gone up
    float max_seconds;  // a rendering that would take longer is left out
    bool ceilings;      // measure those of the device
} bench_suite;

// `path` NULL = the suite that is built in. `scenes` = folder of the sample scenes. Gives the exit code;
// bench_suite_finish is due in any case.
int bench_suite_load(app *a, const char *path, const char *scenes, bench_suite *suite);
void bench_suite_finish(bench_suite *suite);

// "FILE: scenes[2] 'smoke'", "FILE: runs[0] 'pop, cells 8'": where a fault is. A new string.
char *bench_scene_place(const bench_suite *suite, const bench_scene *scene);
char *bench_run_place(const bench_suite *suite, const bench_run *run);

// "pictures/SCENE/SLUG.exr": a new string, below the report's folder.
char *bench_picture(const bench_scene *scene, const char *slug);

// What a user gets who sets nothing, or the quality alone: that quality. NULL: the run sets more, or it samples.
const char *bench_preset(const bench_run *run);

// Whether a run is meant for a scene.
bool bench_run_is_for(const bench_run *run, const bench_scene *scene);
