// report.c -- records put together: report.json (docs/report-schema.md).
#include "report.h"
#include "front.h"
#include "json.h"
#include "plane.h"
#include "regime.h"
#include "stats.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/registry.h>

enum { REPORT_VERSION = 1 };

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
    return json;
}

// Fronts, comparisons at equal error, and who wins over blocks.
static void add_planes(cJSON *to, const bench_case *c, cJSON *runs, plane_frame frame)
{
    cJSON *fronts = cJSON_AddArrayToObject(to, "fronts");
    cJSON *equal = cJSON_AddArrayToObject(to, "equal_error");
    for (int i = 0; i < BENCH_BLOCKS; i++) {
        plane p;
        if (plane_make(&p, runs, i, c->blocks[i], frame)) {
            if (i == 0 && frame == PLANE_COLD) {
                plane_choose_pictures(&p, runs);
                cJSON_AddItemToObject(to, "floors", plane_floors(&p));
            }
            if (i == 0) {
                cJSON_AddItemToObject(to, "ranges", plane_ranges(&p));
                cJSON_AddItemToObject(to, "verdicts", plane_verdicts(&p));
                cJSON_AddItemToObject(to, "promise", plane_promise(&p));
            }
            cJSON_AddItemToArray(fronts, plane_front(&p));
            plane_add_equal_errors(&p, equal);
            if (frame == PLANE_COLD) {
                plane_add_own_equal_errors(&p, runs);
            }
        }
        plane_finish(&p);
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
    cJSON *moved = cJSON_CreateObject();
    add_planes(scene, c, runs, PLANE_COLD);
    add_planes(moved, c, runs, PLANE_MOVED);
    cJSON_AddItemToObject(scene, "moved", moved);
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

void bench_report_begin(bench_report *r, const bench_machine *on, const bench_suite *suite)
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
    cJSON_AddItemToObject(r->root, "seconds", cJSON_CreateObject());
    cJSON_AddItemToObject(r->root, "scenes", cJSON_CreateArray());
}

void bench_report_finish(bench_report *r)
{
    cJSON_Delete(r->root);
    *r = (bench_report){0};
}

static bool same_comparison(const cJSON *a, const cJSON *b)
{
    return json_figure(a, "block") == json_figure(b, "block") &&
           json_figure(a, "error") == json_figure(b, "error") &&
           strcmp(json_text(a, "method"), json_text(b, "method")) == 0 &&
           strcmp(json_text(a, "baseline"), json_text(b, "baseline")) == 0;
}

// Why a scene has no speed-up at this error.
static char *why_missing(const cJSON *scene, const cJSON *entry)
{
    const char *name = json_text(scene, "name"), *why = json_text(entry, "why");
    if (why[0]) {
        return text_format("%s: %s", name, why);
    }
    if (!isnan(json_figure(entry, "ms"))) {
        return text_format("%s: %s was not measured", name, json_text(entry, "baseline"));
    }
    const cJSON *floor;
    cJSON_ArrayForEach(floor, cJSON_GetObjectItemCaseSensitive(scene, "floors"))
    {
        if (strcmp(json_text(floor, "method"), json_text(entry, "method")) == 0 &&
            json_figure(floor, "block") == json_figure(entry, "block")) {
            return text_format("%s: its least error is %.1f %%", name,
                               100 * json_figure(floor, "error"));
        }
    }
    return text_format("%s: the error is not reached", name);
}

// What a scene says of times of cold frames, or of those after the camera has moved.
static const cJSON *said_of(const cJSON *scene, plane_frame frame)
{
    return frame == PLANE_COLD ? scene : cJSON_GetObjectItemCaseSensitive(scene, "moved");
}

// One comparison over all scenes, as the first scene that has it lists it.
static cJSON *json_headline(const cJSON *scenes, const cJSON *first, plane_frame frame)
{
    cJSON *headline = cJSON_CreateObject(), *missing = cJSON_CreateArray();
    double values[BENCH_MAX_SCENES];
    uint32_t num = 0, extrapolated = 0;
    const cJSON *scene, *entry;
    cJSON_ArrayForEach(scene, scenes)
    {
        cJSON_ArrayForEach(entry,
                           cJSON_GetObjectItemCaseSensitive(said_of(scene, frame), "equal_error"))
        {
            if (!same_comparison(entry, first)) {
                continue;
            }
            const double speedup = json_figure(entry, "speedup");
            if (isfinite(speedup) && num < BENCH_MAX_SCENES) {
                values[num++] = speedup;
                extrapolated += !json_true(entry, "measured");
            } else {
                char *why = why_missing(scene, entry);
                cJSON_AddItemToArray(missing, cJSON_CreateString(why ? why : ""));
                free(why);
            }
        }
    }
    cJSON_AddNumberToObject(headline, "block", json_figure(first, "block"));
    cJSON_AddNumberToObject(headline, "error", json_figure(first, "error"));
    cJSON_AddStringToObject(headline, "method", json_text(first, "method"));
    cJSON_AddStringToObject(headline, "baseline", json_text(first, "baseline"));
    json_add_float(headline, "geometric_mean", front_geometric_mean(values, num));
    cJSON_AddNumberToObject(headline, "scenes", num);
    cJSON_AddNumberToObject(headline, "extrapolated", extrapolated);
    cJSON_AddItemToObject(headline, "missing", missing);
    return headline;
}

static cJSON *json_headlines(const cJSON *scenes, plane_frame frame)
{
    cJSON *list = cJSON_CreateArray();
    const cJSON *scene, *entry, *known;
    cJSON_ArrayForEach(scene, scenes)
    {
        cJSON_ArrayForEach(entry,
                           cJSON_GetObjectItemCaseSensitive(said_of(scene, frame), "equal_error"))
        {
            bool seen = false;
            cJSON_ArrayForEach(known, list)
            {
                seen = seen || same_comparison(known, entry);
            }
            if (!seen) {
                cJSON_AddItemToArray(list, json_headline(scenes, entry, frame));
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
            const double of = json_figure(find_run(scenes, ratio->of, run), "frame_ms.cold");
            const double to = json_figure(find_run(scenes, ratio->to, run), "frame_ms.cold");
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
    cJSON_AddItemToObject(r->root, "headline", json_headlines(scenes, PLANE_COLD));
    cJSON_AddItemToObject(r->root, "headline_moved", json_headlines(scenes, PLANE_MOVED));
    cJSON_AddItemToObject(r->root, "ratios", json_ratios(suite, scenes));
    cJSON_AddNullToObject(r->root, "bands");
    cJSON_AddNullToObject(r->root, "stress");
}
