// bands.c -- figures that must stay within recorded bounds: what continuous integration asks a report.
#include "bands.h"
#include "json.h"
#include "suite_reader.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>

// ---- the file ---------------------------------------------------------------------------------

static int fault(app *a, const char *path, int index, const char *what)
{
    app_error(a, "%s: bands[%d]%s", path, index, what);
    return EXIT_WRONG;
}

static int check_band(app *a, const char *path, int index, const cJSON *band)
{
    static const char *const texts[] = {"scene", "run", "figure", "reason"};
    static const char *const known[] = {"scene", "run", "figure", "reason", "low", "high"};
    if (!cJSON_IsObject(band)) {
        return fault(a, path, index, ": must be an object");
    }
    for (size_t i = 0; i < ARRAY_SIZE(texts); i++) {
        if (!json_text(band, texts[i])[0]) {
            char what[64];
            snprintf(what, sizeof what, ".%s: must be a string", texts[i]);
            return fault(a, path, index, what);
        }
    }
    const double low = json_figure(band, "low"), high = json_figure(band, "high");
    if (!(low <= high)) {
        return fault(a, path, index, ": needs numbers low <= high");
    }
    const cJSON *item;
    cJSON_ArrayForEach(item, band)
    {
        bool is_known = false;
        for (size_t i = 0; i < ARRAY_SIZE(known); i++) {
            is_known = is_known || strcmp(known[i], item->string) == 0;
        }
        if (!is_known) {
            char what[160];
            snprintf(what, sizeof what, ".%.80s: is not a known key (docs/bench.md lists them)",
                     item->string);
            return fault(a, path, index, what);
        }
    }
    return EXIT_DONE;
}

int bands_load(app *a, const char *path, cJSON **bands)
{
    void *data = NULL;
    size_t size = 0;
    *bands = NULL;
    tyn_result result = tyn_file_read(path, 16u << 20, &data, &size, &a->log);
    if (result != TYN_OK) {
        return app_exit_code(a, result, true);
    }
    suite_reader r = {.a = a, .file = path, .ok = true};
    *bands = suite_parse(&r, data, size);
    free(data);
    if (!*bands) {
        return EXIT_WRONG;
    }
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(*bands, "bands"), *band;
    int code = EXIT_DONE, index = 0;
    if (!cJSON_IsArray(list) || cJSON_GetArraySize(list) == 0) {
        app_error(a, "%s: must be a JSON object with a list \"bands\" (docs/bench.md)", path);
        code = EXIT_WRONG;
    }
    cJSON_ArrayForEach(band, list)
    {
        if (code == EXIT_DONE) {
            code = check_band(a, path, index++, band);
        }
    }
    return code;
}

// ---- figures ----------------------------------------------------------------------------------

static bool is_for(const char *pattern, const char *name)
{
    return strcmp(pattern, "*") == 0 || strcmp(pattern, name) == 0;
}

// "errors.0.bias", or the quotient of two: "frame_ms.unchanged / frame_ms.animated_light".
static double figure_of(const cJSON *run, const char *figure)
{
    const char *slash = strstr(figure, " / ");
    if (!slash) {
        return json_figure(run, figure);
    }
    char first[96];
    snprintf(first, sizeof first, "%.*s", (int)(slash - figure), figure);
    return json_figure(run, first) / json_figure(run, slash + 3);
}

// One line, and an entry of the report, for a figure that is not in its band.
static void tell(app *a, const cJSON *band, const char *scene, const char *run, double value,
                 cJSON *outside)
{
    const double low = json_figure(band, "low"), high = json_figure(band, "high");
    const char *figure = json_text(band, "figure"), *reason = json_text(band, "reason");
    if (isnan(value)) {
        app_error(a, "%s: %s: %s is not there; its band is %.6g to %.6g (%s)", scene, run, figure,
                  low, high, reason);
    } else {
        app_error(a, "%s: %s: %s is %.6g, outside of %.6g to %.6g (%s)", scene, run, figure, value,
                  low, high, reason);
    }
    cJSON *entry = cJSON_CreateObject();
    cJSON_AddStringToObject(entry, "scene", scene);
    cJSON_AddStringToObject(entry, "run", run);
    cJSON_AddStringToObject(entry, "figure", figure);
    cJSON_AddItemToObject(entry, "value",
                          isfinite(value) ? cJSON_CreateNumber(value) : cJSON_CreateNull());
    cJSON_AddNumberToObject(entry, "low", low);
    cJSON_AddNumberToObject(entry, "high", high);
    cJSON_AddStringToObject(entry, "reason", reason);
    cJSON_AddItemToArray(outside, entry);
}

int bands_apply(app *a, const char *path, const cJSON *bands, cJSON *report)
{
    cJSON *result = cJSON_CreateObject();
    const char *slash = strrchr(path, '/');
    cJSON_AddStringToObject(result, "file", slash ? slash + 1 : path);
    cJSON *outside = cJSON_AddArrayToObject(result, "outside");
    const cJSON *scenes = cJSON_GetObjectItemCaseSensitive(report, "scenes"), *band, *scene, *run;
    uint32_t checked = 0;
    cJSON_ArrayForEach(band, cJSON_GetObjectItemCaseSensitive(bands, "bands"))
    {
        const char *of_scene = json_text(band, "scene"), *of_run = json_text(band, "run");
        uint32_t found = 0;
        cJSON_ArrayForEach(scene, scenes)
        {
            cJSON_ArrayForEach(run, cJSON_GetObjectItemCaseSensitive(scene, "runs"))
            {
                const char *scene_name = json_text(scene, "name"), *name = json_text(run, "name");
                if (!is_for(of_scene, scene_name) || !is_for(of_run, name)) {
                    continue;
                }
                const double value = figure_of(run, json_text(band, "figure"));
                found++;
                if (!(value >= json_figure(band, "low") && value <= json_figure(band, "high"))) {
                    tell(a, band, scene_name, name, value, outside);
                }
            }
        }
        if (found == 0) {
            tell(a, band, of_scene, of_run, NAN, outside);
        }
        checked += found;
    }
    cJSON_AddNumberToObject(result, "checked", checked);
    cJSON_ReplaceItemInObjectCaseSensitive(report, "bands", result);
    return cJSON_GetArraySize(outside) == 0 ? EXIT_DONE : EXIT_FAILED;
}
