// report.c -- records put together: report.json (docs/report-schema.md).
#include "report.h"
#include "front.h"
#include "record.h"
#include "regime.h"
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REPORT_VERSION = 1, MAX_LINES = 64, NUM_ASKED = 3 };
static const double asked[NUM_ASKED] = {0.10, 0.05, 0.03}; // errors at which methods are compared

// ---- a scene's runs as points -----------------------------------------------------------------

typedef struct line { // the runs of one group
    const char *name;
    bool sampling;
} line;

typedef struct plane {   // error against time, of one scene and block size
    front_point *points; // one a run
    const cJSON **runs;
    uint32_t count;
    line lines[MAX_LINES];
    uint32_t num_lines;
} plane;

static uint32_t line_of(plane *p, const cJSON *run)
{
    const char *name = json_text(run, "group");
    for (uint32_t i = 0; i < p->num_lines; i++) {
        if (strcmp(p->lines[i].name, name) == 0) {
            return i;
        }
    }
    if (p->num_lines == MAX_LINES) {
        return MAX_LINES - 1;
    }
    const cJSON *sampling = cJSON_GetObjectItemCaseSensitive(run, "sampling");
    p->lines[p->num_lines] = (line){name, cJSON_IsTrue(sampling)};
    return p->num_lines++;
}

// `block`: which of the errors. False: out of memory; plane_finish is due in any case.
static bool plane_make(plane *p, const cJSON *runs, int block)
{
    const uint32_t count = (uint32_t)cJSON_GetArraySize(runs);
    char error[32];
    snprintf(error, sizeof error, "errors.%d.error", block);
    *p = (plane){.points = calloc(count + 1, sizeof *p->points),
                 .runs = calloc(count + 1, sizeof *p->runs)};
    const cJSON *run;
    cJSON_ArrayForEach(run, runs)
    {
        if (!p->points || !p->runs) {
            return false;
        }
        const uint32_t of = line_of(p, run);
        p->runs[p->count] = run;
        p->points[p->count++] = (front_point){.ms = json_figure(run, "frame_ms.cold"),
                                              .error = json_figure(run, error),
                                              .line = of,
                                              .sampling = p->lines[of].sampling};
    }
    return p->points && p->runs;
}

static void plane_finish(plane *p)
{
    free(p->points);
    free(p->runs);
}

static cJSON *json_key(const plane *p, int32_t point)
{
    return point >= 0 ? cJSON_CreateString(json_text(p->runs[point], "key")) : cJSON_CreateNull();
}

// ---- what follows from them -------------------------------------------------------------------

static cJSON *json_front(const plane *p, uint32_t block)
{
    uint32_t *indices = calloc(p->count + 1, sizeof *indices);
    const uint32_t num = indices ? front_pareto(p->points, p->count, indices) : 0;
    cJSON *front = cJSON_CreateObject();
    cJSON_AddNumberToObject(front, "block", block);
    cJSON *list = cJSON_AddArrayToObject(front, "runs");
    for (uint32_t i = 0; i < num; i++) {
        cJSON_AddItemToArray(list, json_key(p, (int32_t)indices[i]));
    }
    free(indices);
    return front;
}

// Every method against every one that samples, at the errors asked for.
static void add_equal_errors(const plane *p, uint32_t block, cJSON *list)
{
    for (int e = 0; e < NUM_ASKED; e++) {
        for (uint32_t m = 0; m < p->num_lines; m++) {
            for (uint32_t b = 0; b < p->num_lines; b++) {
                if (p->lines[m].sampling || !p->lines[b].sampling) {
                    continue;
                }
                const front_time own = front_time_at(p->points, p->count, m, asked[e]);
                const front_time base = front_time_at(p->points, p->count, b, asked[e]);
                cJSON *entry = cJSON_CreateObject();
                cJSON_AddNumberToObject(entry, "block", block);
                cJSON_AddNumberToObject(entry, "error", asked[e]);
                cJSON_AddStringToObject(entry, "method", p->lines[m].name);
                json_add_float(entry, "ms", own.ms);
                cJSON_AddItemToObject(entry, "run", json_key(p, own.point));
                cJSON_AddStringToObject(entry, "baseline", p->lines[b].name);
                json_add_float(entry, "baseline_ms", base.ms);
                json_add_float(entry, "speedup", base.ms / own.ms);
                cJSON_AddBoolToObject(entry, "measured", base.measured);
                cJSON_AddItemToArray(list, entry);
            }
        }
    }
}

// What the methods that sample need for the error of each other run.
static void add_own_equal_errors(const plane *p, uint32_t block, cJSON *runs)
{
    for (uint32_t i = 0; i < p->count; i++) {
        const front_point *point = &p->points[i];
        if (point->sampling || !isfinite(point->error)) {
            continue;
        }
        cJSON *run = cJSON_GetArrayItem(runs, (int)i);
        cJSON *list = cJSON_GetObjectItemCaseSensitive(run, "equal_error");
        list = list ? list : cJSON_AddArrayToObject(run, "equal_error");
        for (uint32_t b = 0; b < p->num_lines; b++) {
            if (!p->lines[b].sampling) {
                continue;
            }
            const front_time base = front_time_at(p->points, p->count, b, point->error);
            cJSON *entry = cJSON_CreateObject();
            cJSON_AddNumberToObject(entry, "block", block);
            cJSON_AddStringToObject(entry, "baseline", p->lines[b].name);
            json_add_float(entry, "ms", base.ms);
            json_add_float(entry, "speedup", base.ms / point->ms);
            cJSON_AddBoolToObject(entry, "measured", base.measured);
            cJSON_AddItemToArray(list, entry);
        }
    }
}

// The least error of each method: what no setting of this suite gets below.
static cJSON *json_floors(const plane *p, uint32_t block)
{
    cJSON *floors = cJSON_CreateArray();
    for (uint32_t m = 0; m < p->num_lines; m++) {
        double least = NAN;
        for (uint32_t i = 0; i < p->count; i++) {
            least = p->points[i].line == m ? fmin(least, p->points[i].error) : least;
        }
        if (!p->lines[m].sampling && isfinite(least)) {
            cJSON *floor = cJSON_CreateObject();
            cJSON_AddNumberToObject(floor, "block", block);
            cJSON_AddStringToObject(floor, "method", p->lines[m].name);
            json_add_float(floor, "error", least);
            cJSON_AddItemToArray(floors, floor);
        }
    }
    return floors;
}

static const char *percent(double error, char text[16])
{
    snprintf(text, 16, error < 0.1 ? "%.1f %%" : "%.0f %%", 100 * error);
    return text;
}

// Ranges of errors in which one method is fastest, from small to large errors; null: without an end.
static cJSON *json_ranges(const plane *p, uint32_t block)
{
    enum { MAX_RANGES = 16 };
    front_range ranges[MAX_RANGES];
    const uint32_t num = front_ranges(p->points, p->count, 0.5, ranges, MAX_RANGES);
    cJSON *list = cJSON_CreateArray();
    for (uint32_t i = 0; i < num; i++) {
        const front_range *r = &ranges[i];
        cJSON *range = cJSON_CreateObject();
        cJSON_AddNumberToObject(range, "block", block);
        cJSON_AddStringToObject(range, "method", p->lines[r->line].name);
        json_add_float(range, "low", r->lowest ? NAN : r->low);
        json_add_float(range, "high", r->highest ? NAN : r->high);
        cJSON_AddItemToArray(list, range);
    }
    return list;
}

static void add_verdict(cJSON *verdicts, char *text)
{
    cJSON_AddItemToArray(verdicts, cJSON_CreateString(text ? text : ""));
    free(text);
}

static cJSON *json_verdicts(const plane *p)
{
    enum { MAX_RANGES = 16 };
    front_range ranges[MAX_RANGES];
    const uint32_t num = front_ranges(p->points, p->count, 0.5, ranges, MAX_RANGES);
    cJSON *verdicts = cJSON_CreateArray();
    bool has_pop = false, pop_wins = false;
    for (uint32_t i = 0; i < p->num_lines; i++) {
        has_pop = has_pop || strcmp(p->lines[i].name, "pop") == 0;
    }
    for (uint32_t i = num; i-- > 0;) { // from what is asked for most
        const front_range *r = &ranges[i];
        const char *name = p->lines[r->line].name;
        bool is_pop = strcmp(name, "pop") == 0;
        const char *does = is_pop ? "is on the front" : "wins";
        char low[16], high[16];
        percent(r->low, low);
        percent(r->high, high);
        pop_wins = pop_wins || is_pop;
        add_verdict(verdicts,
                    r->lowest && r->highest ? text_format("%s %s at all errors", name, does)
                    : r->highest            ? text_format("%s %s above %s", name, does, low)
                    : r->lowest             ? text_format("%s %s below %s", name, does, high)
                                : text_format("%s %s from %s to %s", name, does, low, high));
    }
    if (has_pop && !pop_wins) {
        add_verdict(verdicts, text_format("pop is nowhere on the front"));
    }
    return verdicts;
}

// ---- a scene ----------------------------------------------------------------------------------

static cJSON *json_reference(const bench_case *c)
{
    const bench_reference *r = &c->reference;
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "method", c->spec->reference ? "file" : "path");
    json_add_float(json, "spp", c->spec->reference ? NAN : c->spec->reference_spp);
    json_add_float(json, "seed", c->spec->reference ? NAN : BENCH_REFERENCE_SEED);
    json_add_float(json, "seconds", r->seconds > 0 ? r->seconds : NAN);
    cJSON_AddBoolToObject(json, "cached", r->cached);
    cJSON_AddStringToObject(json, "key", r->key);
    char *picture = c->folder ? text_format("pictures/%s/reference.exr", c->spec->slug) : NULL;
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

// Pages hold pictures: of a sweep only those on a front, the best and what no sweep made are worth it.
static void choose_pictures(const plane *p, cJSON *runs)
{
    uint32_t *front = calloc(p->count + 1, sizeof *front);
    const uint32_t num = front ? front_pareto(p->points, p->count, front) : 0;
    for (uint32_t i = 0; i < p->count; i++) {
        cJSON *run = cJSON_GetArrayItem(runs, (int)i);
        bool shown = !cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(run, "swept"));
        bool best = true;
        for (uint32_t k = 0; k < num; k++) {
            shown = shown || front[k] == i;
        }
        for (uint32_t k = 0; k < p->count; k++) {
            best = best && !(p->points[k].line == p->points[i].line &&
                             p->points[k].error < p->points[i].error);
        }
        cJSON_AddBoolToObject(run, "shown", (shown || best) && isfinite(p->points[i].error));
    }
    free(front);
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
    cJSON *fronts = cJSON_CreateArray(), *equal = cJSON_CreateArray();
    cJSON *floors = NULL, *ranges = NULL, *verdicts = NULL;
    for (int i = 0; i < BENCH_BLOCKS; i++) {
        plane p;
        if (plane_make(&p, runs, i)) {
            if (i == 0) {
                choose_pictures(&p, runs);
                floors = json_floors(&p, c->blocks[i]);
                ranges = json_ranges(&p, c->blocks[i]);
                verdicts = json_verdicts(&p);
            }
            cJSON_AddItemToArray(fronts, json_front(&p, c->blocks[i]));
            add_equal_errors(&p, c->blocks[i], equal);
            add_own_equal_errors(&p, c->blocks[i], runs);
        }
        plane_finish(&p);
    }
    cJSON_AddItemToObject(scene, "runs", runs);
    cJSON_AddItemToObject(scene, "left_out", left_out);
    cJSON_AddItemToObject(scene, "fronts", fronts);
    cJSON_AddItemToObject(scene, "equal_error", equal);
    cJSON_AddItemToObject(scene, "floors", floors ? floors : cJSON_CreateArray());
    cJSON_AddItemToObject(scene, "ranges", ranges ? ranges : cJSON_CreateArray());
    cJSON_AddItemToObject(scene, "verdicts", verdicts ? verdicts : cJSON_CreateArray());
    // What is used from here on is what a reader of the file sees.
    char *text = cJSON_PrintUnformatted(scene);
    cJSON *seen = text ? cJSON_Parse(text) : NULL;
    free(text);
    if (seen) {
        cJSON_Delete(scene);
        scene = seen;
    }
    cJSON_AddItemToArray(cJSON_GetObjectItemCaseSensitive(r->root, "scenes"), scene);
    r->reference_seconds += c->reference.seconds;
}

// ---- the whole --------------------------------------------------------------------------------

void bench_report_begin(bench_report *r, const bench_machine *on, const bench_suite *suite)
{
    *r = (bench_report){.root = cJSON_CreateObject()};
    cJSON_AddStringToObject(r->root, "schema", "tyndall-report");
    cJSON_AddNumberToObject(r->root, "version", REPORT_VERSION);
    cJSON_AddStringToObject(r->root, "tyndall", tyn_version_string());
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
    const char *name = json_text(scene, "name");
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

// One comparison over all scenes, as the first scene that has it lists it.
static cJSON *json_headline(const cJSON *scenes, const cJSON *first)
{
    cJSON *headline = cJSON_CreateObject(), *missing = cJSON_CreateArray();
    double values[BENCH_MAX_SCENES];
    uint32_t num = 0, extrapolated = 0;
    const cJSON *scene, *entry;
    cJSON_ArrayForEach(scene, scenes)
    {
        cJSON_ArrayForEach(entry, cJSON_GetObjectItemCaseSensitive(scene, "equal_error"))
        {
            if (!same_comparison(entry, first)) {
                continue;
            }
            const double speedup = json_figure(entry, "speedup");
            if (isfinite(speedup) && num < BENCH_MAX_SCENES) {
                values[num++] = speedup;
                extrapolated += !cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(entry, "measured"));
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

static cJSON *json_headlines(const cJSON *scenes)
{
    cJSON *list = cJSON_CreateArray();
    const cJSON *scene, *entry, *known;
    cJSON_ArrayForEach(scene, scenes)
    {
        cJSON_ArrayForEach(entry, cJSON_GetObjectItemCaseSensitive(scene, "equal_error"))
        {
            bool seen = false;
            cJSON_ArrayForEach(known, list)
            {
                seen = seen || same_comparison(known, entry);
            }
            if (!seen) {
                cJSON_AddItemToArray(list, json_headline(scenes, entry));
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
    cJSON_AddItemToObject(r->root, "headline", json_headlines(scenes));
    cJSON_AddItemToObject(r->root, "ratios", json_ratios(suite, scenes));
    cJSON_AddNullToObject(r->root, "bands");
    cJSON_AddNullToObject(r->root, "stress");
}
