// record.c -- a run's record as JSON, kept as a file.
#include "record.h"
#include "measuring.h"
#include "reference.h"
#include "stats.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <tyndall/io.h>

static char *record_path(const char *folder, const char *key)
{
    return text_format("%s/records/%s.json", folder, key);
}

void record_name_run(cJSON *json, const bench_run *run)
{
    static const char *const keys[] = {"name", "group", "baseline", "swept", "spec"};
    for (size_t i = 0; i < ARRAY_SIZE(keys); i++) {
        cJSON_DeleteItemFromObjectCaseSensitive(json, keys[i]);
    }
    cJSON_AddStringToObject(json, "name", run->name);
    cJSON_AddStringToObject(json, "group", run->group);
    cJSON_AddBoolToObject(json, "baseline", run->baseline);
    cJSON_AddBoolToObject(json, "swept", run->swept);
    cJSON_AddItemToObject(json, "spec", cJSON_Duplicate(run->spec, true));
}

// ---- whole records ----------------------------------------------------------------------------

static bool is_picture(const char *path, const cJSON *size)
{
    static const char *const names[] = {"R", "G", "B"};
    tyn_image_file file = {0};
    bool whole = tyn_exr_read(&file, path, NULL) == TYN_OK &&
                 file.width == json_figure(size, "0") && file.height == json_figure(size, "1");
    for (size_t i = 0; i < ARRAY_SIZE(names); i++) {
        whole = whole && tyn_image_file_channel(&file, names[i]);
    }
    tyn_image_file_finish(&file);
    return whole;
}

static bool has_picture(const char *folder, const cJSON *record, const bench_scene *scene,
                        const char *slug)
{
    const cJSON *run = cJSON_GetObjectItemCaseSensitive(record, "run");
    const cJSON *of = cJSON_GetObjectItemCaseSensitive(record, "scene");
    char *name = bench_picture(scene, slug);
    char *path = name ? text_format("%s/%s", folder, name) : NULL;
    const bool there = path && strcmp(json_text(run, "picture"), name) == 0 &&
                       is_picture(path, cJSON_GetObjectItemCaseSensitive(of, "size"));
    free(name);
    free(path);
    return there;
}

// Keys that are there, whatever they hold: null says that a figure is not known.
static bool has_keys(const cJSON *object, const char *const *keys)
{
    bool whole = cJSON_IsObject(object);
    for (; whole && *keys; keys++) {
        whole = cJSON_GetObjectItemCaseSensitive(object, *keys) != NULL;
    }
    return whole;
}

static bool has_numbers(const cJSON *object, const char *const *keys)
{
    bool whole = true;
    for (; whole && *keys; keys++) {
        whole = !isnan(json_figure(object, *keys));
    }
    return whole;
}

// The error is not known where values of the picture are not finite.
static bool has_errors(const cJSON *run)
{
    static const char *const keys[] = {"error", "n",    "rmse",    "rel_rmse", "rel_mse",
                                       "smape", "bias", "bias_se", "p95",      NULL};
    static const char *const numbers[] = {"block", "rel_l1", "nan", NULL};
    static const char *const flips[] = {"error", "n", NULL};
    const cJSON *error, *errors = cJSON_GetObjectItemCaseSensitive(run, "errors");
    bool whole = cJSON_IsArray(errors) && cJSON_GetArraySize(errors) == BENCH_MEASURES;
    cJSON_ArrayForEach(error, errors)
    {
        if (json_figure(error, "block") == 0) {
            whole = whole && has_keys(error, flips);
            continue;
        }
        whole = whole && has_keys(error, keys) && has_numbers(error, numbers) &&
                (!isnan(json_figure(error, "error")) || json_figure(error, "nan") > 0);
    }
    return whole;
}

static bool has_nodes(const cJSON *run)
{
    static const char *const keys[] = {"name", "setup",   "gpu_ms",   "bytes", "flops",
                                       "work", "ceiling", "fraction", NULL};
    static const char *const numbers[] = {"dispatches", "memory", NULL};
    const cJSON *node, *nodes = cJSON_GetObjectItemCaseSensitive(run, "nodes");
    bool whole = cJSON_IsArray(nodes) && cJSON_GetArraySize(nodes) > 0;
    cJSON_ArrayForEach(node, nodes)
    {
        whole = whole && has_keys(node, keys) && has_numbers(node, numbers);
    }
    return whole;
}

// What a report holds of a run (docs/report-schema.md); a file that somebody has cut, or an older program written,
// lacks some of it.
static bool has_figures(const cJSON *run)
{
    static const char *const keys[] = {"fill", "imbalance", "imbalance_se", "flicker", NULL};
    static const char *const numbers[] = {"setup_ms",
                                          "frame_ms.animated_light",
                                          "memory.transient",
                                          "memory.persistent",
                                          "non_finite",
                                          "negative",
                                          NULL};
    const char *times[NUM_TIMES + 1] = {NULL};
    memcpy(times, bench_time_names, sizeof bench_time_names);
    return has_keys(run, keys) && has_numbers(run, numbers) &&
           has_keys(cJSON_GetObjectItemCaseSensitive(run, "frame_ms"), times) &&
           has_numbers(cJSON_GetObjectItemCaseSensitive(run, "frames"), times) && has_errors(run) &&
           has_nodes(run) && cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(run, "warnings")) &&
           cJSON_IsObject(cJSON_GetObjectItemCaseSensitive(run, "inputs"));
}

// What is said of a run whether it could be measured or not.
static bool has_settings(const cJSON *run)
{
    static const char *const keys[] = {"sampling", "failed", NULL};
    return has_keys(run, keys) && json_text(run, "method")[0] && !isnan(json_figure(run, "seed")) &&
           cJSON_IsObject(cJSON_GetObjectItemCaseSensitive(run, "settings")) &&
           cJSON_IsObject(cJSON_GetObjectItemCaseSensitive(run, "all_settings"));
}

// What the run was measured on, and against.
static bool is_citable(const cJSON *record)
{
    static const char *const keys[] = {"tyndall", "library",   "suite", "device",
                                       "scene",   "reference", NULL};
    return has_keys(record, keys) && json_text(record, "date")[0];
}

static bool is_whole(const cJSON *record, const char *folder, const char *key,
                     const bench_scene *scene, const bench_run *of)
{
    const cJSON *run = cJSON_GetObjectItemCaseSensitive(record, "run");
    return strcmp(json_text(record, "schema"), "tyndall-record") == 0 &&
           json_figure(record, "version") == BENCH_RECORD_VERSION &&
           strcmp(json_text(record, "key"), key) == 0 && strcmp(json_text(run, "key"), key) == 0 &&
           is_citable(record) && has_settings(run) &&
           (json_text(run, "failed")[0] ||
            (has_figures(run) && has_picture(folder, record, scene, of->slug)));
}

cJSON *record_load(const char *folder, const char *key, const bench_scene *scene,
                   const bench_run *run)
{
    void *data = NULL;
    size_t size = 0;
    char *path = folder ? record_path(folder, key) : NULL;
    cJSON *record = NULL;
    if (path && tyn_file_read(path, 64u << 20, &data, &size, NULL) == TYN_OK) {
        record = cJSON_ParseWithLength(data, size);
    }
    if (record && is_whole(record, folder, key, scene, run)) {
        record_name_run(cJSON_GetObjectItemCaseSensitive(record, "run"), run);
    } else {
        cJSON_Delete(record);
        record = NULL;
    }
    free(data);
    free(path);
    return record;
}

int record_store(app *a, const char *folder, const char *key, cJSON **record)
{
    char *text = cJSON_Print(*record);
    cJSON *seen = text ? cJSON_Parse(text) : NULL;
    free(text);
    if (!seen) {
        return app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    cJSON_Delete(*record);
    *record = seen;
    if (!folder) {
        return EXIT_DONE;
    }
    char *below = text_format("%s/records", folder), *path = record_path(folder, key);
    int code = EXIT_FAILED;
    if (below && path) {
        mkdir(below, 0777);
        code = json_write(a, cJSON_Duplicate(seen, true), path);
    }
    free(below);
    free(path);
    return code;
}
