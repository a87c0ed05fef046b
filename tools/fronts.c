// fronts.c -- stored error and time of methods: read.
#include "fronts.h"
#include "fronts_default.h"
#include "json_at.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>

enum { SIZE_LIMIT = 64 << 20 };

const char fronts_schema[] = "tyndall-fronts";

// ---- reading ----------------------------------------------------------------------------------

static int by_name(const void *a, const void *b)
{
    return strcmp((*(const cJSON *const *)a)->string, (*(const cJSON *const *)b)->string);
}

// "pop lattice.cells=16 raymarch.step=2": sorted by name.
static char *key_of(const char *name, const cJSON *settings)
{
    const cJSON *items[OPT_MAX_LIST], *item;
    size_t count = 0;
    cJSON_ArrayForEach(item, settings)
    {
        if (count < OPT_MAX_LIST) {
            items[count++] = item;
        }
    }
    qsort(items, count, sizeof items[0], by_name);
    char *key = text_format("%s", name);
    for (size_t i = 0; i < count && key; i++) {
        char *value = cJSON_IsString(items[i]) ? text_format("%s", items[i]->valuestring)
                                               : cJSON_PrintUnformatted(items[i]);
        char *longer = value ? text_format("%s %s=%s", key, items[i]->string, value) : NULL;
        free(value);
        free(key);
        key = longer;
    }
    return key;
}

// Lattice cells along the longest side that a run of `pop` has.
static double cells_of(const cJSON *settings)
{
    const char *quality = json_text_at(settings, "quality");
    const double preset = strcmp(quality, "draft") == 0  ? 16
                          : strcmp(quality, "high") == 0 ? 48
                                                         : REGIME_LATTICE_CELLS;
    return json_number_at(settings, "lattice.cells", preset);
}

static bool read_run(cJSON *json, const fronts_scene *scene, fronts_run *run)
{
    const char *name = json_text_at(json, "method");
    const cJSON *ms = json_at(json, "ms");
    const double pixels = (double)scene->width * scene->height;
    snprintf(run->method, sizeof run->method, "%s", name);
    run->settings = cJSON_GetObjectItemCaseSensitive(json, "settings");
    run->spp = (uint32_t)json_number_at(json, "spp", 0);
    run->cells = cells_of(run->settings);
    run->error = json_number_at(json, "error", NAN);
    run->error_pixel = json_number_at(json, "error_pixel", NAN);
    run->fixed_ms = json_number_at(ms, "fixed", NAN);
    run->pixel_ms = json_number_at(ms, "pixels", NAN) / pixels;
    run->key = key_of(name, run->settings);
    return *name && run->key && run->error > 0 && run->fixed_ms >= 0 && run->pixel_ms >= 0;
}

static bool read_scene(const cJSON *json, fronts_scene *scene)
{
    const cJSON *size = json_at(json, "size"), *runs = json_at(json, "runs");
    scene->name = json_text_at(json, "name");
    scene->width = (uint32_t)cJSON_GetNumberValue(cJSON_GetArrayItem(size, 0));
    scene->height = (uint32_t)cJSON_GetNumberValue(cJSON_GetArrayItem(size, 1));
    const int count = cJSON_GetArraySize(runs);
    scene->runs = calloc(count ? (size_t)count : 1, sizeof *scene->runs);
    if (!scene->runs || !regime_read(json_at(json, "regime"), &scene->regime) || !scene->width ||
        !scene->height) {
        return false;
    }
    cJSON *run;
    cJSON_ArrayForEach(run, runs)
    {
        if (!read_run(run, scene, &scene->runs[scene->num_runs++])) {
            return false;
        }
    }
    return true;
}

static void read_device(const cJSON *json, fronts_device *d)
{
    const cJSON *device = json_at(json, "device");
    *d = (fronts_device){
        .name = json_text_at(device, "name"),
        .driver = json_text_at(device, "driver"),
        .paces = paces_read(json_at(json, "paces")),
    };
}

// What is compiled in, as one text: a new string.
static char *default_text(void)
{
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    for (size_t i = 0; to && i < ARRAY_SIZE(fronts_default); i++) {
        fprintf(to, "%s\n", fronts_default[i]);
    }
    return to && fclose(to) == 0 ? text : NULL;
}

int fronts_open(app *a, const char *path, fronts *f)
{
    *f = (fronts){0};
    void *data = NULL;
    size_t size = 0;
    tyn_result result = TYN_OK;
    if (path) {
        result = tyn_file_read(path, SIZE_LIMIT, &data, &size, &a->log);
    } else {
        data = default_text();
        size = data ? strlen(data) : 0;
        result = data ? TYN_OK : TYN_ERR_MEMORY;
    }
    if (result != TYN_OK) {
        return app_exit_code(a, result, true);
    }
    f->json = cJSON_ParseWithLength(data, size);
    free(data);
    const char *name = path ? path : "the fronts that are compiled in";
    if (strcmp(json_text_at(f->json, "schema"), fronts_schema) != 0 ||
        json_number_at(f->json, "version", 0) != FRONTS_VERSION) {
        app_error(a, "--fronts: %s: not a file of fronts (\"schema\": \"%s\", \"version\": %d)",
                  name, fronts_schema, FRONTS_VERSION);
        return EXIT_WRONG;
    }
    read_device(f->json, &f->device);
    const cJSON *scenes = json_at(f->json, "scenes"), *scene;
    const int count = cJSON_GetArraySize(scenes);
    f->scenes = calloc(count ? (size_t)count : 1, sizeof *f->scenes);
    if (!f->scenes) {
        return app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    cJSON_ArrayForEach(scene, scenes)
    {
        if (!read_scene(scene, &f->scenes[f->num_scenes++])) {
            app_error(a,
                      "--fronts: %s: scene %u '%s': needs \"size\", \"regime\" and \"runs\" with "
                      "\"method\", \"error\" above 0 and \"ms\"",
                      name, f->num_scenes - 1, json_text_at(scene, "name"));
            return EXIT_WRONG;
        }
    }
    return EXIT_DONE;
}

void fronts_finish(fronts *f)
{
    for (uint32_t i = 0; i < f->num_scenes; i++) {
        for (uint32_t k = 0; k < f->scenes[i].num_runs; k++) {
            free(f->scenes[i].runs[k].key);
        }
        free(f->scenes[i].runs);
    }
    free(f->scenes);
    cJSON_Delete(f->json);
    *f = (fronts){0};
}
