// stats.h -- what a run did, as JSON.
#pragma once
#include "app.h"
#include "method_setup.h"
#include <cjson/cJSON.h>
#include <tyndall/offline.h>

typedef struct stats {
    const char *device;
    const method *method;
    const tyn_scene *scene;
    const tyn_view *view;
    double setup_ms;
    // Medians; NaN = not run.
    double cold_ms, camera_moved_ms, light_moved_ms, sky_dimmed_ms, unchanged_ms;
    const tyn_report *report;
    tyn_pipeline_stats pipelines; // of the device
    const char *warnings[3];      // beside those of the scene and the report; NULL = none
    const cJSON *choice;   // what --max-error and --budget-ms chose; NULL = nothing was asked
    const char *inputs[4]; // paths; NULL = none
} stats;

cJSON *stats_make(const stats *s);
// Every parameter of the method's passes by the name -D takes, and the samples: the "settings".
cJSON *stats_settings(const method *m, const tyn_view *view);
// Hashes of the files at `paths` (NULL = none), and of grids and the map as they were read: the "inputs".
cJSON *stats_inputs(const tyn_scene *scene, const char *const *paths, size_t num_paths);
cJSON *stats_report_nodes(const tyn_report *report); // the "nodes" of the stats

// Writes an object to a file, or to stdout with path NULL; deletes it. Gives the exit code.
int json_write(app *a, cJSON *object, const char *path);

// A float as it is written shortest ("0.1", not 0.100000001490116), null if it is not finite.
void json_add_float(cJSON *object, const char *name, double value);
cJSON *json_floats(const float *values, int count);
