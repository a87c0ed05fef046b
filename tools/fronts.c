// fronts.c -- stored error and time of methods: read, and made from a report.
#include "fronts.h"
#include "fronts_default.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>

static const char schema[] = "tyndall-fronts";
enum { VERSION = 1, SIZE_LIMIT = 64 << 20 };

static const cJSON *at(const cJSON *object, const char *name)
{
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

static const char *text_at(const cJSON *object, const char *name)
{
    const char *text = cJSON_GetStringValue(at(object, name));
    return text ? text : "";
}

static double number_at(const cJSON *object, const char *name, double otherwise)
{
    const cJSON *item = at(object, name);
    return cJSON_IsNumber(item) ? item->valuedouble : otherwise;
}

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

static bool read_run(cJSON *json, const fronts_scene *scene, fronts_run *run)
{
    const char *name = text_at(json, "method");
    const cJSON *ms = at(json, "ms");
    const double pixels = (double)scene->width * scene->height;
    snprintf(run->method, sizeof run->method, "%s", name);
    run->settings = cJSON_GetObjectItemCaseSensitive(json, "settings");
    run->spp = (uint32_t)number_at(json, "spp", 0);
    run->error = number_at(json, "error", NAN);
    run->error_pixel = number_at(json, "error_pixel", NAN);
    run->fixed_ms = number_at(ms, "fixed", NAN);
    run->pixel_ms = number_at(ms, "pixels", NAN) / pixels;
    run->key = key_of(name, run->settings);
    return *name && run->key && run->error > 0 && run->fixed_ms >= 0 && run->pixel_ms >= 0;
}

static bool read_scene(const cJSON *json, fronts_scene *scene)
{
    const cJSON *size = at(json, "size"), *runs = at(json, "runs");
    scene->name = text_at(json, "name");
    scene->width = (uint32_t)cJSON_GetNumberValue(cJSON_GetArrayItem(size, 0));
    scene->height = (uint32_t)cJSON_GetNumberValue(cJSON_GetArrayItem(size, 1));
    const int count = cJSON_GetArraySize(runs);
    scene->runs = calloc(count ? (size_t)count : 1, sizeof *scene->runs);
    if (!scene->runs || !regime_read(at(json, "regime"), &scene->regime) || !scene->width ||
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
    const cJSON *device = at(json, "device"), *ceilings = at(json, "ceilings");
    *d = (fronts_device){
        .name = text_at(device, "name"),
        .driver = text_at(device, "driver"),
        .fma_gflops = number_at(ceilings, "fma_gflops", 0),
        .copy_gb_s = number_at(ceilings, "copy_gb_s", 0),
        .trilinear_gsamples_s = number_at(ceilings, "trilinear_gsamples_s", 0),
        .exp_gops_s = number_at(ceilings, "exp_gops_s", 0),
        .dispatch_us = number_at(ceilings, "dispatch_us", 0),
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
    if (strcmp(text_at(f->json, "schema"), schema) != 0 ||
        number_at(f->json, "version", 0) != VERSION) {
        app_error(a, "--fronts: %s: not a file of fronts (\"schema\": \"%s\", \"version\": %d)",
                  name, schema, VERSION);
        return EXIT_WRONG;
    }
    read_device(f->json, &f->device);
    const cJSON *scenes = at(f->json, "scenes"), *scene;
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
                      name, f->num_scenes - 1, text_at(scene, "name"));
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

// ---- from a report ----------------------------------------------------------------------------

// Nodes whose work is that of the picture's pixels.
static bool is_of_pixels(const char *node)
{
    static const char *const names[] = {"raymarch", "gbuffer",   "shade",  "upsample",
                                        "path",     "composite", "tonemap"};
    for (size_t i = 0; i < ARRAY_SIZE(names); i++) {
        if (strcmp(node, names[i]) == 0) {
            return true;
        }
    }
    return false;
}

static double share_of_pixels(const cJSON *nodes)
{
    double all = 0, pixels = 0;
    const cJSON *node;
    cJSON_ArrayForEach(node, nodes)
    {
        if (!cJSON_IsTrue(at(node, "setup"))) {
            const double ms = number_at(node, "gpu_ms", 0);
            all += ms;
            pixels += is_of_pixels(text_at(node, "name")) ? ms : 0;
        }
    }
    return all > 0 ? pixels / all : 1;
}

// Of a block size. What the reference's noise hides is not 0: a third of that noise.
static double error_of(const cJSON *run, int block)
{
    const cJSON *e;
    cJSON_ArrayForEach(e, at(run, "errors"))
    {
        if (number_at(e, "block", 0) == block) {
            return fmax(number_at(e, "error", NAN), number_at(e, "n", 0) / 3);
        }
    }
    return NAN;
}

static cJSON *digits(double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.4g", value);
    return isfinite(value) ? cJSON_CreateRaw(text) : cJSON_CreateNull();
}

// NULL: the run failed, or lacks a figure.
static cJSON *compact_run(const cJSON *run)
{
    const double error = error_of(run, 8), cold = number_at(at(run, "frame_ms"), "cold", NAN);
    if (cJSON_GetStringValue(at(run, "failed")) || !(error > 0) || !(cold >= 0)) {
        return NULL;
    }
    cJSON *out = cJSON_CreateObject(), *settings = cJSON_Duplicate(at(run, "settings"), true);
    const double spp = number_at(settings, "spp", 0), share = share_of_pixels(at(run, "nodes"));
    cJSON_DeleteItemFromObjectCaseSensitive(settings, "spp");
    cJSON_AddStringToObject(out, "method", text_at(run, "method"));
    cJSON_AddItemToObject(out, "settings", settings ? settings : cJSON_CreateObject());
    if (spp > 0) {
        cJSON_AddNumberToObject(out, "spp", spp);
    }
    cJSON_AddItemToObject(out, "error", digits(error));
    cJSON_AddItemToObject(out, "error_pixel", digits(error_of(run, 1)));
    cJSON *ms = cJSON_AddObjectToObject(out, "ms");
    cJSON_AddItemToObject(ms, "fixed", digits(cold * (1 - share)));
    cJSON_AddItemToObject(ms, "pixels", digits(cold * share));
    return out;
}

static cJSON *compact_scene(const cJSON *scene)
{
    cJSON *out = cJSON_CreateObject(), *runs = cJSON_CreateArray();
    cJSON_AddStringToObject(out, "name", text_at(scene, "name"));
    cJSON_AddItemToObject(out, "size", cJSON_Duplicate(at(scene, "size"), true));
    cJSON_AddItemToObject(out, "regime", cJSON_Duplicate(at(scene, "regime"), true));
    const cJSON *run;
    cJSON_ArrayForEach(run, at(scene, "runs"))
    {
        cJSON *compact = compact_run(run);
        if (compact) {
            cJSON_AddItemToArray(runs, compact);
        }
    }
    cJSON_AddItemToObject(out, "runs", runs);
    return out;
}

// One line for what is not a list of scenes or runs, so that a file can be read and its changes be seen.
static bool print_lines(FILE *to, const cJSON *json, int depth)
{
    char *flat = NULL;
    if (cJSON_IsArray(json) && depth > 0 && cJSON_IsObject(json->child)) {
        fprintf(to, "[");
        const cJSON *item;
        cJSON_ArrayForEach(item, json)
        {
            fprintf(to, "%s\n%*s", item == json->child ? "" : ",", 2 * depth + 1, "");
            if (!print_lines(to, item, depth + 1)) {
                return false;
            }
        }
        return fprintf(to, "]") > 0;
    }
    if (cJSON_IsObject(json) && (at(json, "scenes") || at(json, "runs"))) {
        fprintf(to, "{");
        const cJSON *item;
        cJSON_ArrayForEach(item, json)
        {
            if (item != json->child) {
                fprintf(to, ",\n%*s", 2 * depth + 1, "");
            }
            fprintf(to, "\"%s\": ", item->string);
            if (!print_lines(to, item, depth + 1)) {
                return false;
            }
        }
        return fprintf(to, "}") > 0;
    }
    flat = cJSON_PrintUnformatted(json);
    const bool done = flat && fputs(flat, to) >= 0;
    free(flat);
    return done;
}

int fronts_write(app *a, const cJSON *report, const char *path)
{
    if (strcmp(text_at(report, "schema"), "tyndall-report") != 0) {
        app_error(a, "fronts are made from a report.json (\"schema\": \"tyndall-report\")");
        return EXIT_WRONG;
    }
    cJSON *root = cJSON_CreateObject(), *scenes = cJSON_CreateArray();
    cJSON_AddStringToObject(root, "schema", schema);
    cJSON_AddNumberToObject(root, "version", VERSION);
    static const char *const kept[] = {"tyndall", "date", "device", "ceilings"};
    for (size_t i = 0; i < ARRAY_SIZE(kept); i++) {
        cJSON *item = cJSON_Duplicate(at(report, kept[i]), true);
        cJSON_AddItemToObject(root, kept[i], item ? item : cJSON_CreateNull());
    }
    cJSON_AddStringToObject(root, "suite", text_at(at(report, "suite"), "name"));
    const cJSON *scene;
    cJSON_ArrayForEach(scene, at(report, "scenes"))
    {
        cJSON_AddItemToArray(scenes, compact_scene(scene));
    }
    cJSON_AddItemToObject(root, "scenes", scenes);
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    bool done = to && print_lines(to, root, 0) && fputc('\n', to) != EOF;
    done = (!to || fclose(to) == 0) && done;
    tyn_result result = done ? tyn_file_write(path, text, size, &a->log) : TYN_ERR_MEMORY;
    free(text);
    cJSON_Delete(root);
    return app_exit_code(a, result, false);
}
