// record.c -- a run's record as JSON, kept as a file.
#include "record.h"
#include "stats.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <tyndall/io.h>
#include <unistd.h>

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

static bool has_picture(const char *folder, const cJSON *run, const bench_scene *scene,
                        const char *slug)
{
    char *name = bench_picture(scene, slug);
    char *path = name ? text_format("%s/%s", folder, name) : NULL;
    const bool there =
        path && strcmp(json_text(run, "picture"), name) == 0 && access(path, R_OK) == 0;
    free(name);
    free(path);
    return there;
}

// What a report cannot do without; a file that somebody has cut, or an older program written, lacks some of it.
static bool has_figures(const cJSON *run)
{
    static const char *const numbers[] = {
        "errors.0.block",    "errors.0.rel_l1",  "errors.1.block", "errors.1.rel_l1",
        "frame_ms.cold",     "frames.cold",      "seed",           "setup_ms",
        "memory.persistent", "memory.transient", "non_finite",     "negative"};
    static const char *const lists[] = {"errors", "nodes", "warnings"};
    static const char *const objects[] = {"settings", "all_settings", "inputs"};
    bool whole = true;
    for (size_t i = 0; i < ARRAY_SIZE(numbers); i++) {
        whole = whole && !isnan(json_figure(run, numbers[i]));
    }
    for (size_t i = 0; i < ARRAY_SIZE(lists); i++) {
        whole = whole && cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(run, lists[i]));
    }
    for (size_t i = 0; i < ARRAY_SIZE(objects); i++) {
        whole = whole && cJSON_IsObject(cJSON_GetObjectItemCaseSensitive(run, objects[i]));
    }
    return whole;
}

static bool is_whole(const cJSON *record, const char *folder, const char *key,
                     const bench_scene *scene, const bench_run *of)
{
    const cJSON *run = cJSON_GetObjectItemCaseSensitive(record, "run");
    return strcmp(json_text(record, "schema"), "tyndall-record") == 0 &&
           json_figure(record, "version") == BENCH_RECORD_VERSION &&
           strcmp(json_text(record, "key"), key) == 0 && strcmp(json_text(run, "key"), key) == 0 &&
           json_text(record, "date")[0] && json_text(run, "method")[0] &&
           (json_text(run, "failed")[0] ||
            (has_figures(run) && has_picture(folder, run, scene, of->slug)));
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
