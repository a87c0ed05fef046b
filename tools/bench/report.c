// report.c -- records put together: report.json (docs/report-schema.md).
#include "report.h"
#include "front.h"
#include "json.h"
#include "peers.h"
#include "plane.h"
#include "regime.h"
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/registry.h>

enum { REPORT_VERSION = 2 };

// ---- a scene ----------------------------------------------------------------------------------

static cJSON *json_reference(const bench_case *c)
{
    const bench_reference *r = &c->reference;
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "method", c->spec->reference ? "file" : tyn_method_reference());
    json_add_float(json, "spp", r->spp > 0 ? r->spp : NAN);
    json_add_float(json, "seed", r->spp > 0 ? BENCH_REFERENCE_SEED : NAN);
    json_add_float(json, "seconds", r->seconds > 0 ? r->seconds : NAN);
    cJSON_AddBoolToObject(json, "cached", r->cached);
    cJSON_AddBoolToObject(json, "stored", r->stored);
    cJSON_AddStringToObject(json, "key", r->key);
    char *picture = c->folder ? bench_picture(c->spec, BENCH_REFERENCE_SLUG) : NULL;
    cJSON_AddItemToObject(json, "picture",
                          picture ? cJSON_CreateString(picture) : cJSON_CreateNull());
    free(picture);
    cJSON *noise = cJSON_AddArrayToObject(json, "noise");
    for (int i = 0; i < BENCH_BLOCKS; i++) {
        cJSON *entry = cJSON_CreateObject();
        cJSON_AddNumberToObject(entry, "block", c->blocks[i]);
        json_add_float(entry, "n", r->known_noise ? r->noise[i] : NAN);
        cJSON_AddItemToArray(noise, entry);
    }
    cJSON *flip = cJSON_CreateObject();
    cJSON_AddNumberToObject(flip, "block", 0);
    json_add_float(flip, "n", r->known_noise ? r->flip_noise : NAN);
    cJSON_AddItemToArray(noise, flip);
    return json;
}

// Fronts, comparisons at equal error, and who wins over blocks, with one of a run's times.
static void add_planes(cJSON *to, const bench_case *c, cJSON *runs, bench_time time)
{
    cJSON *fronts = cJSON_AddArrayToObject(to, "fronts");
    cJSON *floors = cJSON_AddArrayToObject(to, "floors");
    cJSON *equal = cJSON_AddArrayToObject(to, "equal_error");
    for (int i = 0; i < BENCH_MEASURES; i++) {
        plane p;
        if (plane_make(&p, runs, i, c->blocks[i], time)) {
            if (i == 0 && time == TIME_LIGHT) {
                plane_choose_pictures(&p, runs);
            }
            if (i == 0) {
                cJSON_AddItemToObject(to, "ranges", plane_ranges(&p));
                cJSON_AddItemToObject(to, "verdicts", plane_verdicts(&p));
                cJSON_AddItemToObject(to, "promise", plane_promise(&p));
            }
            cJSON_AddItemToArray(fronts, plane_front(&p));
            plane_add_floors(&p, floors);
            plane_add_equal_errors(&p, equal);
            plane_add_own_equal_errors(&p, runs);
        }
        plane_finish(&p);
    }
}

// All that compares times: those of frames in which the light changes are the scene's own, the others beside them.
static void add_times(cJSON *scene, const bench_case *c, cJSON *runs)
{
    static const bench_time others[] = {TIME_FIRST, TIME_MEDIUM, TIME_CAMERA};
    add_planes(scene, c, runs, TIME_LIGHT);
    cJSON *times = cJSON_AddObjectToObject(scene, "times");
    for (size_t i = 0; i < ARRAY_SIZE(others); i++) {
        add_planes(cJSON_AddObjectToObject(times, bench_time_names[others[i]]), c, runs, others[i]);
    }
}

void bench_report_scene(bench_report *r, const bench_case *c, cJSON *runs, cJSON *left_out)
{
    cJSON *scene = cJSON_CreateObject();
    const int size[2] = {(int)c->view.width, (int)c->view.height};
    cJSON_AddStringToObject(scene, "name", c->spec->name);
    cJSON_AddStringToObject(scene, "slug", c->spec->slug);
    cJSON_AddStringToObject(scene, "file", json_text(c->spec->json, "scene"));
    json_add_hash(scene, "hash", c->hash);
    cJSON_AddItemToObject(scene, "size", cJSON_CreateIntArray(size, 2));
    double fill = NAN;
    cJSON *run;
    cJSON_ArrayForEach(run, runs)
    {
        fill = isnan(fill) ? json_figure(run, "fill") : fill;
    }
    json_add_float(scene, "fill", fill);
    regime found;
    bool known = regime_of(&c->scene, &c->view.camera, &found);
    cJSON_AddItemToObject(scene, "regime", known ? regime_json(&found) : cJSON_CreateNull());
    cJSON_AddItemToObject(scene, "reference", json_reference(c));
    // Before the peers join: fronts and comparisons are of this library's runs.
    add_times(scene, c, runs);
    cJSON_AddItemToObject(
        scene, "peers",
        peers_add(c, runs, cJSON_GetObjectItemCaseSensitive(r->root, "peers_left_out")));
    cJSON_AddItemToObject(scene, "runs", runs);
    cJSON_AddItemToObject(scene, "left_out", left_out);
    // What is used from here on is what a reader of the file sees.
    char *text = cJSON_PrintUnformatted(scene);
    cJSON *seen = text ? cJSON_Parse(text) : NULL;
    free(text);
    if (seen) {
        cJSON_Delete(scene);
        scene = seen;
    }
    cJSON_AddItemToArray(cJSON_GetObjectItemCaseSensitive(r->root, "scenes"), scene);
    r->reference_seconds += c->reference.spent;
}

// ---- the whole --------------------------------------------------------------------------------

void bench_report_begin(app *a, bench_report *r, const bench_machine *on, const bench_suite *suite)
{
    *r = (bench_report){.root = cJSON_CreateObject()};
    cJSON_AddStringToObject(r->root, "schema", "tyndall-report");
    cJSON_AddNumberToObject(r->root, "version", REPORT_VERSION);
    cJSON_AddStringToObject(r->root, "tyndall", tyn_version_string());
    json_add_hash(r->root, "library", on->library);
    json_add_date(r->root);
    cJSON *about = cJSON_AddObjectToObject(r->root, "suite");
    cJSON_AddStringToObject(about, "name", suite->name);
    cJSON_AddStringToObject(about, "about", suite->about ? suite->about : "");
    json_add_hash(about, "hash", suite->hash);
    cJSON *device = cJSON_AddObjectToObject(r->root, "device");
    cJSON_AddStringToObject(device, "name", on->name);
    cJSON_AddStringToObject(device, "driver", on->driver);
    cJSON_AddStringToObject(device, "type", on->type);
    cJSON_AddItemToObject(r->root, "ceilings", ceilings_json(&on->ceilings));
    cJSON_AddItemToObject(r->root, "paces",
                          on->paces.solve_ms > 0 ? paces_json(&on->paces) : cJSON_CreateNull());
    cJSON_AddItemToObject(r->root, "seconds", cJSON_CreateObject());
    cJSON_AddItemToObject(r->root, "scenes", cJSON_CreateArray());
    peers_unknown(a, suite, cJSON_AddArrayToObject(r->root, "peers_left_out"));
}

void bench_report_finish(bench_report *r)
{
    cJSON_Delete(r->root);
    *r = (bench_report){0};
}

// ---- over all scenes --------------------------------------------------------------------------

// What a scene says with one of the times.
static const cJSON *said_of(const cJSON *scene, bench_time time)
{
    const cJSON *times = cJSON_GetObjectItemCaseSensitive(scene, "times");
    return time == TIME_LIGHT ? scene
                              : cJSON_GetObjectItemCaseSensitive(times, bench_time_names[time]);
}

// Means over the same scenes, which grow by one scene after the other.
typedef struct mean {
    double speedups[BENCH_MAX_SCENES], errors[BENCH_MAX_SCENES], ms[BENCH_MAX_SCENES];
    uint32_t num, extrapolated;
    cJSON *missing; // "scene: why"
} mean;

static void add_missing(mean *m, const cJSON *scene, const char *why)
{
    char *text = text_format("%s: %s", json_text(scene, "name"), why);
    cJSON_AddItemToArray(m->missing, cJSON_CreateString(text ? text : ""));
    free(text);
}

static void add_values(mean *m, const cJSON *comparison, double error, double ms)
{
    if (m->num < BENCH_MAX_SCENES) {
        m->speedups[m->num] = json_figure(comparison, "speedup");
        m->errors[m->num] = error;
        m->ms[m->num++] = ms;
        m->extrapolated += !json_true(comparison, "measured");
    }
}

// The mean, over how many of the scenes, and of how many what a baseline takes is extrapolated.
static void finish_mean(mean *m, cJSON *to, const cJSON *scenes)
{
    json_add_float(to, "geometric_mean", front_geometric_mean(m->speedups, m->num));
    cJSON_AddNumberToObject(to, "scenes", m->num);
    cJSON_AddNumberToObject(to, "of", cJSON_GetArraySize(scenes));
    cJSON_AddNumberToObject(to, "extrapolated", m->extrapolated);
    cJSON_AddItemToObject(to, "missing", m->missing);
}

static bool same_comparison(const cJSON *a, const cJSON *b)
{
    return json_figure(a, "block") == json_figure(b, "block") &&
           json_figure(a, "error") == json_figure(b, "error") &&
           strcmp(json_text(a, "method"), json_text(b, "method")) == 0;
}

static const cJSON *errors_of(const cJSON *run, double block)
{
    const cJSON *error;
    cJSON_ArrayForEach(error, cJSON_GetObjectItemCaseSensitive(run, "errors"))
    {
        if (json_figure(error, "block") == block) {
            return error;
        }
    }
    return NULL;
}

// A picture of which some values are not finite has no error that is known, by any measure.
static bool is_finite(const cJSON *run)
{
    bool finite = true;
    const cJSON *error;
    cJSON_ArrayForEach(error, cJSON_GetObjectItemCaseSensitive(run, "errors"))
    {
        finite = finite && !(json_figure(error, "nan") > 0);
    }
    return finite;
}

// Why a run has no part in a comparison with this time; NULL: it has one.
static const char *why_unknown(const cJSON *run, bench_time time, double block)
{
    char path[48];
    snprintf(path, sizeof path, "frame_ms.%s", bench_time_names[time]);
    return json_text(run, "failed")[0] ? "it cannot do this scene"
           : !is_finite(run)           ? "not finite"
           : isnan(json_figure(errors_of(run, block), "error")) || !(json_figure(run, path) > 0)
               ? "not measured"
               : NULL;
}

// Why none of the runs of a method has one: the reason that all of them share.
static const char *why_no_run(const cJSON *scene, const char *group, bench_time time, double block)
{
    const char *shared = NULL;
    const cJSON *run;
    cJSON_ArrayForEach(run, cJSON_GetObjectItemCaseSensitive(scene, "runs"))
    {
        if (strcmp(json_text(run, "group"), group) == 0) {
            const char *why = why_unknown(run, time, block);
            shared = why && (!shared || strcmp(shared, why) == 0) ? why : "not measured";
        }
    }
    return shared ? shared : "not measured";
}

static bool has_baseline(const cJSON *scene)
{
    bool has = false;
    const cJSON *run;
    cJSON_ArrayForEach(run, cJSON_GetObjectItemCaseSensitive(scene, "runs"))
    {
        has = has || json_true(run, "baseline");
    }
    return has;
}

// Why a scene has no speed-up at this error. `entry` NULL: the scene has no such comparison.
static char *why_missing(const cJSON *scene, const cJSON *entry, const cJSON *asked,
                         bench_time time)
{
    const char *group = json_text(asked, "method");
    const double block = json_figure(asked, "block");
    if (json_text(entry, "why")[0]) {
        return text_format("%s", json_text(entry, "why"));
    }
    if (!has_baseline(scene)) {
        return text_format("no baseline was measured");
    }
    if (!isnan(json_figure(entry, "ms"))) {
        return text_format("no baseline is known to get there");
    }
    const cJSON *floor;
    cJSON_ArrayForEach(floor, cJSON_GetObjectItemCaseSensitive(said_of(scene, time), "floors"))
    {
        const double least = json_figure(floor, "error");
        if (strcmp(json_text(floor, "method"), group) == 0 &&
            json_figure(floor, "block") == block) {
            return block > 0 ? text_format("its least error is %.1f %%", 100 * least)
                             : text_format("its least error is %.4f", least);
        }
    }
    return text_format("%s", why_no_run(scene, group, time, block));
}

static const cJSON *same_in(const cJSON *said, const cJSON *asked)
{
    const cJSON *entry;
    cJSON_ArrayForEach(entry, cJSON_GetObjectItemCaseSensitive(said, "equal_error"))
    {
        if (same_comparison(entry, asked)) {
            return entry;
        }
    }
    return NULL;
}

// One comparison over all scenes, as the first scene that has it lists it.
static cJSON *json_headline(const cJSON *scenes, const cJSON *first, bench_time time)
{
    cJSON *headline = cJSON_CreateObject();
    mean m = {.missing = cJSON_CreateArray()};
    const cJSON *scene;
    cJSON_ArrayForEach(scene, scenes)
    {
        const cJSON *entry = same_in(said_of(scene, time), first);
        if (isfinite(json_figure(entry, "speedup"))) {
            add_values(&m, entry, json_figure(entry, "error"), json_figure(entry, "ms"));
        } else {
            char *why = why_missing(scene, entry, first, time);
            add_missing(&m, scene, why ? why : "");
            free(why);
        }
    }
    cJSON_AddStringToObject(headline, "frame", bench_time_names[time]);
    cJSON_AddNumberToObject(headline, "block", json_figure(first, "block"));
    cJSON_AddNumberToObject(headline, "error", json_figure(first, "error"));
    cJSON_AddStringToObject(headline, "method", json_text(first, "method"));
    finish_mean(&m, headline, scenes);
    return headline;
}

static void add_headlines(cJSON *list, const cJSON *scenes, bench_time time)
{
    const int before = cJSON_GetArraySize(list);
    const cJSON *scene, *entry;
    cJSON_ArrayForEach(scene, scenes)
    {
        cJSON_ArrayForEach(entry,
                           cJSON_GetObjectItemCaseSensitive(said_of(scene, time), "equal_error"))
        {
            bool seen = false;
            for (int i = before; i < cJSON_GetArraySize(list); i++) {
                seen = seen || same_comparison(cJSON_GetArrayItem(list, i), entry);
            }
            if (!seen) {
                cJSON_AddItemToArray(list, json_headline(scenes, entry, time));
            }
        }
    }
}

// The run of a scene that is a preset of a method; NULL: none.
static const cJSON *preset_of(const cJSON *scene, const char *how, const char *preset)
{
    const cJSON *run;
    cJSON_ArrayForEach(run, cJSON_GetObjectItemCaseSensitive(scene, "runs"))
    {
        if (strcmp(json_text(run, "method"), how) == 0 &&
            strcmp(json_text(run, "preset"), preset) == 0) {
            return run;
        }
    }
    return NULL;
}

static const cJSON *comparison_of(const cJSON *run, bench_time time, double block)
{
    const cJSON *entry;
    cJSON_ArrayForEach(entry, cJSON_GetObjectItemCaseSensitive(run, "equal_error"))
    {
        if (strcmp(json_text(entry, "frame"), bench_time_names[time]) == 0 &&
            json_figure(entry, "block") == block) {
            return entry;
        }
    }
    return NULL;
}

// Why a scene is not in the means of a preset; NULL: it is.
static const char *why_left_out(const cJSON *run, const cJSON *entry, bench_time time, double block)
{
    const cJSON *error = errors_of(run, block);
    const char *why = run ? why_unknown(run, time, block) : "not measured";
    return why                                       ? why
           : isfinite(json_figure(entry, "speedup")) ? NULL
           : !entry                                  ? "no baseline was measured"
           : json_figure(error, "error") < 2 * json_figure(error, "n")
               ? "the error is below twice the noise of its reference"
               : "no baseline is known to get there";
}

// The error and the time of a preset, and how many times as long a baseline takes to that error: all three over the
// same scenes, those in which all three are known.
static cJSON *json_preset(const cJSON *scenes, const char *how, const char *preset, bench_time time,
                          double block)
{
    char path[48];
    snprintf(path, sizeof path, "frame_ms.%s", bench_time_names[time]);
    mean m = {.missing = cJSON_CreateArray()};
    const cJSON *scene;
    cJSON_ArrayForEach(scene, scenes)
    {
        const cJSON *run = preset_of(scene, how, preset);
        const cJSON *entry = comparison_of(run, time, block);
        const char *why = why_left_out(run, entry, time, block);
        if (why) {
            add_missing(&m, scene, why);
        } else {
            add_values(&m, entry, json_figure(errors_of(run, block), "error"),
                       json_figure(run, path));
        }
    }
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "frame", bench_time_names[time]);
    cJSON_AddNumberToObject(json, "block", block);
    cJSON_AddStringToObject(json, "method", how);
    cJSON_AddStringToObject(json, "preset", preset);
    json_add_float(json, "error", front_geometric_mean(m.errors, m.num));
    json_add_float(json, "ms", front_geometric_mean(m.ms, m.num));
    finish_mean(&m, json, scenes);
    return json;
}

static cJSON *json_presets(const bench_suite *suite, const cJSON *scenes)
{
    cJSON *list = cJSON_CreateArray();
    const uint32_t blocks[] = {suite->block, 1, 0};
    for (uint32_t i = 0; i < suite->num_runs; i++) {
        const char *how = suite->runs[i].method.method, *preset = bench_preset(&suite->runs[i]);
        bool any = false;
        const cJSON *scene;
        cJSON_ArrayForEach(scene, scenes)
        {
            any = any || (preset && preset_of(scene, how, preset));
        }
        for (int time = 0; any && time < TIME_UNCHANGED; time++) {
            for (int k = 0; k < BENCH_MEASURES; k++) {
                cJSON_AddItemToArray(list,
                                     json_preset(scenes, how, preset, (bench_time)time, blocks[k]));
            }
        }
    }
    return list;
}

static const cJSON *find_run(const cJSON *scenes, const char *scene, const char *run)
{
    const cJSON *s, *r;
    cJSON_ArrayForEach(s, scenes)
    {
        cJSON_ArrayForEach(r, cJSON_GetObjectItemCaseSensitive(s, "runs"))
        {
            if (strcmp(json_text(s, "name"), scene) == 0 &&
                strcmp(json_text(r, "name"), run) == 0) {
                return r;
            }
        }
    }
    return NULL;
}

static cJSON *json_ratios(const bench_suite *suite, const cJSON *scenes)
{
    cJSON *list = cJSON_CreateArray();
    for (uint32_t k = 0; k < suite->num_ratios; k++) {
        const bench_ratio *ratio = &suite->ratios[k];
        for (uint32_t i = 0; i < suite->num_runs; i++) {
            const char *run = suite->runs[i].name;
            const double of =
                json_figure(find_run(scenes, ratio->of, run), "frame_ms.animated_light");
            const double to =
                json_figure(find_run(scenes, ratio->to, run), "frame_ms.animated_light");
            if (suite->runs[i].baseline || isnan(of / to)) {
                continue;
            }
            cJSON *entry = cJSON_CreateObject();
            cJSON_AddStringToObject(entry, "name", ratio->name);
            cJSON_AddStringToObject(entry, "run", run);
            cJSON_AddNumberToObject(entry, "times", of / to);
            cJSON_AddItemToArray(list, entry);
        }
    }
    return list;
}

void bench_report_end(bench_report *r, const bench_suite *suite)
{
    const cJSON *scenes = cJSON_GetObjectItemCaseSensitive(r->root, "scenes");
    cJSON *seconds = cJSON_GetObjectItemCaseSensitive(r->root, "seconds");
    json_add_float(seconds, "references", r->reference_seconds);
    json_add_float(seconds, "measuring", r->measuring_seconds);
    cJSON *headline = cJSON_AddArrayToObject(r->root, "headline");
    for (int time = 0; time < TIME_UNCHANGED; time++) {
        add_headlines(headline, scenes, (bench_time)time);
    }
    cJSON_AddItemToObject(r->root, "presets", json_presets(suite, scenes));
    cJSON_AddItemToObject(r->root, "ratios", json_ratios(suite, scenes));
    cJSON_AddNullToObject(r->root, "bands");
    cJSON_AddNullToObject(r->root, "stress");
}
