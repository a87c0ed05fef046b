// fronts_write.c -- stored error and time of methods, made from a report.
#include "fronts.h"
#include "json_at.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>
#include <tyndall/registry.h>

// Is the node's work that of the picture's pixels?
static bool is_of_pixels(const char *node)
{
    for (uint32_t i = 0; i < tyn_num_passes(); i++) {
        const tyn_pass_desc *pass = tyn_pass_at(i);
        if (strcmp(node, pass->name) == 0) {
            return pass->of_pixels;
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
        if (!cJSON_IsTrue(json_at(node, "setup"))) {
            const double ms = json_number_at(node, "gpu_ms", 0);
            all += ms;
            pixels += is_of_pixels(json_text_at(node, "name")) ? ms : 0;
        }
    }
    return all > 0 ? pixels / all : 1;
}

// Of a block size; NAN: not known. An error below the noise of the reference is anything up to that noise: the most it
// may be.
static double error_of(const cJSON *run, int block)
{
    const cJSON *e;
    cJSON_ArrayForEach(e, json_at(run, "errors"))
    {
        if (json_number_at(e, "block", 0) == block) {
            const double error = json_number_at(e, "error", NAN);
            return isnan(error) ? NAN : fmax(error, json_number_at(e, "n", 0));
        }
    }
    return NAN;
}

static double cold_of(const cJSON *run)
{
    return json_number_at(json_at(run, "frame_ms"), "animated_light", NAN);
}

static double samples_of(const cJSON *run)
{
    return json_number_at(json_at(run, "settings"), "spp", 0);
}

// Do two runs differ in nothing but their samples?
static bool same_but_samples(const cJSON *a, const cJSON *b)
{
    cJSON *of_a = cJSON_Duplicate(json_at(a, "settings"), true);
    cJSON *of_b = cJSON_Duplicate(json_at(b, "settings"), true);
    cJSON_DeleteItemFromObjectCaseSensitive(of_a, "spp");
    cJSON_DeleteItemFromObjectCaseSensitive(of_b, "spp");
    const bool same = strcmp(json_text_at(a, "method"), json_text_at(b, "method")) == 0 &&
                      cJSON_Compare(of_a, of_b, true);
    cJSON_Delete(of_a);
    cJSON_Delete(of_b);
    return same;
}

// Of a method that samples: what a frame takes before its first sample, on a line parallel to that through the runs
// with the fewest and the most samples, above none of them: what samples take must be more than nothing in each, also
// where a frame of one sample was disturbed.
static double fixed_of_sampling(const cJSON *runs, const cJSON *like)
{
    const cJSON *few = like, *many = like, *run;
    cJSON_ArrayForEach(run, runs)
    {
        if (samples_of(run) > 0 && cold_of(run) >= 0 && same_but_samples(run, like)) {
            few = samples_of(run) < samples_of(few) ? run : few;
            many = samples_of(run) > samples_of(many) ? run : many;
        }
    }
    if (few == many) {
        return 0;
    }
    const double a_sample = (cold_of(many) - cold_of(few)) / (samples_of(many) - samples_of(few));
    double fixed = cold_of(few) - a_sample * samples_of(few);
    cJSON_ArrayForEach(run, runs)
    {
        if (samples_of(run) > 0 && cold_of(run) >= 0 && same_but_samples(run, like)) {
            fixed = fmin(fixed, cold_of(run) - a_sample * samples_of(run));
        }
    }
    return fmax(0, fixed);
}

static cJSON *digits(double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.4g", value);
    return isfinite(value) ? cJSON_CreateRaw(text) : cJSON_CreateNull();
}

// NULL: the run failed, or lacks a figure.
static cJSON *compact_run(const cJSON *runs, const cJSON *run)
{
    const double error = error_of(run, 8), cold = cold_of(run), spp = samples_of(run);
    if (cJSON_GetStringValue(json_at(run, "failed")) || !(error > 0) || !(cold >= 0)) {
        return NULL;
    }
    cJSON *out = cJSON_CreateObject(), *settings = cJSON_Duplicate(json_at(run, "settings"), true);
    const double fixed = spp > 0 ? fmin(fixed_of_sampling(runs, run), cold)
                                 : cold * (1 - share_of_pixels(json_at(run, "nodes")));
    cJSON_DeleteItemFromObjectCaseSensitive(settings, "spp");
    cJSON_AddStringToObject(out, "method", json_text_at(run, "method"));
    cJSON_AddItemToObject(out, "settings", settings ? settings : cJSON_CreateObject());
    if (spp > 0) {
        cJSON_AddNumberToObject(out, "spp", spp);
    }
    cJSON_AddItemToObject(out, "error", digits(error));
    cJSON_AddItemToObject(out, "error_pixel", digits(error_of(run, 1)));
    cJSON *ms = cJSON_AddObjectToObject(out, "ms");
    cJSON_AddItemToObject(ms, "fixed", digits(fixed));
    cJSON_AddItemToObject(ms, "pixels", digits(cold - fixed));
    return out;
}

static cJSON *compact_scene(const cJSON *scene)
{
    cJSON *out = cJSON_CreateObject(), *runs = cJSON_CreateArray();
    cJSON_AddStringToObject(out, "name", json_text_at(scene, "name"));
    cJSON_AddItemToObject(out, "size", cJSON_Duplicate(json_at(scene, "size"), true));
    cJSON_AddItemToObject(out, "regime", cJSON_Duplicate(json_at(scene, "regime"), true));
    const cJSON *all = json_at(scene, "runs"), *run;
    cJSON_ArrayForEach(run, all)
    {
        cJSON *compact = compact_run(all, run);
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
    if (cJSON_IsObject(json) && (json_at(json, "scenes") || json_at(json, "runs"))) {
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
    if (strcmp(json_text_at(report, "schema"), "tyndall-report") != 0) {
        app_error(a, "fronts are made from a report.json (\"schema\": \"tyndall-report\")");
        return EXIT_WRONG;
    }
    cJSON *root = cJSON_CreateObject(), *scenes = cJSON_CreateArray();
    cJSON_AddStringToObject(root, "schema", fronts_schema);
    cJSON_AddNumberToObject(root, "version", FRONTS_VERSION);
    static const char *const kept[] = {"tyndall", "date", "device", "paces"};
    for (size_t i = 0; i < ARRAY_SIZE(kept); i++) {
        cJSON *item = cJSON_Duplicate(json_at(report, kept[i]), true);
        cJSON_AddItemToObject(root, kept[i], item ? item : cJSON_CreateNull());
    }
    cJSON_AddStringToObject(root, "suite", json_text_at(json_at(report, "suite"), "name"));
    const cJSON *scene;
    cJSON_ArrayForEach(scene, json_at(report, "scenes"))
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
