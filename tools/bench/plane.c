// plane.c -- the runs of a scene as points of error against time: fronts, times at equal error, verdicts.
#include "plane.h"
#include "app.h"
#include "json.h"
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/registry.h>

enum { NUM_ASKED = 3, MAX_RANGES = 64 };
// What is promised of `pop`: the front at errors above both of these.
static const double promised_error = 0.03, promised_floors = 1.2;
// Errors at which methods are compared, and values of FLIP; those at which a peer is, which samples as `path` does.
static const double asked_errors[NUM_ASKED] = {0.10, 0.05, 0.03};
static const double peer_errors[NUM_ASKED] = {0.10, 0.05, 0.02};
static const double asked_flips[NUM_ASKED] = {0.05, 0.02, 0.01};

// ---- runs as points ---------------------------------------------------------------------------

static uint32_t line_of(plane *p, const cJSON *run)
{
    const char *name = json_text(run, "group");
    for (uint32_t i = 0; i < p->num_lines; i++) {
        if (strcmp(p->lines[i].name, name) == 0) {
            return i;
        }
    }
    p->lines[p->num_lines] =
        (plane_line){name, json_true(run, "sampling"), json_true(run, "baseline")};
    return p->num_lines++;
}

static int64_t find_line(const plane *p, const char *name)
{
    for (uint32_t i = 0; i < p->num_lines; i++) {
        if (strcmp(p->lines[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

static double time_of(const cJSON *run, bench_time time)
{
    char path[48];
    snprintf(path, sizeof path, "frame_ms.%s", bench_time_names[time]);
    return json_figure(run, path);
}

// NAN: not known, as that of a picture of which some values are not finite.
static double error_of(const cJSON *run, int index)
{
    char error[32], nan[32];
    snprintf(error, sizeof error, "errors.%d.error", index);
    snprintf(nan, sizeof nan, "errors.%d.nan", index);
    return json_figure(run, nan) > 0 ? NAN : json_figure(run, error);
}

bool plane_make(plane *p, const cJSON *runs, int index, uint32_t block, bench_time time)
{
    const uint32_t count = (uint32_t)cJSON_GetArraySize(runs);
    char noise_path[32];
    snprintf(noise_path, sizeof noise_path, "errors.%d.n", index);
    *p = (plane){.points = calloc(count + 1, sizeof *p->points),
                 .runs = calloc(count + 1, sizeof *p->runs),
                 .lines = calloc(count + 1, sizeof *p->lines),
                 .block = block,
                 .time = time};
    if (!p->points || !p->runs || !p->lines) {
        return false;
    }
    const cJSON *run;
    cJSON_ArrayForEach(run, runs)
    {
        const double error = error_of(run, index), noise = json_figure(run, noise_path);
        const uint32_t of = line_of(p, run);
        p->noise = noise > 0 ? noise : p->noise;
        p->runs[p->count] = run;
        p->points[p->count++] = (front_point){.ms = time_of(run, time),
                                              .error = error < noise ? noise : error,
                                              .line = of,
                                              .sampling = p->lines[of].sampling,
                                              .bound = error < noise};
    }
    return true;
}

void plane_finish(plane *p)
{
    free(p->points);
    free(p->runs);
    free(p->lines);
}

static cJSON *json_key(const plane *p, int32_t point)
{
    return point >= 0 ? cJSON_CreateString(json_text(p->runs[point], "key")) : cJSON_CreateNull();
}

static const char *percent(double error, char text[16])
{
    const int digits = error < 0.01 ? 2 : error < 0.1 ? 1 : 0; // one would hide ranges there
    snprintf(text, 16, "%.*f %%", digits, 100 * error);
    return text;
}

// ---- the front --------------------------------------------------------------------------------

cJSON *plane_front(const plane *p)
{
    uint32_t *indices = calloc(p->count + 1, sizeof *indices);
    const uint32_t num = indices ? front_pareto(p->points, p->count, indices) : 0;
    cJSON *front = cJSON_CreateObject();
    cJSON_AddNumberToObject(front, "block", p->block);
    cJSON *list = cJSON_AddArrayToObject(front, "runs");
    for (uint32_t i = 0; i < num; i++) {
        cJSON_AddItemToArray(list, json_key(p, (int32_t)indices[i]));
    }
    free(indices);
    return front;
}

// Of the points that have the plane's time: what was not measured with it gets nowhere.
static double least_error(const plane *p, int64_t line)
{
    double least = NAN;
    for (uint32_t i = 0; i < p->count; i++) {
        const front_point *point = &p->points[i];
        least = point->line == line && point->ms > 0 ? fmin(least, point->error) : least;
    }
    return least;
}

void plane_add_floors(const plane *p, cJSON *floors)
{
    for (uint32_t m = 0; m < p->num_lines; m++) {
        const double least = least_error(p, m);
        if (!p->lines[m].sampling && isfinite(least)) {
            cJSON *floor = cJSON_CreateObject();
            cJSON_AddNumberToObject(floor, "block", p->block);
            cJSON_AddStringToObject(floor, "method", p->lines[m].name);
            json_add_float(floor, "error", least);
            cJSON_AddBoolToObject(floor, "vague", least < 2 * p->noise);
            cJSON_AddItemToArray(floors, floor);
        }
    }
}

void plane_choose_pictures(const plane *p, cJSON *runs)
{
    uint32_t *front = calloc(p->count + 1, sizeof *front);
    const uint32_t num = front ? front_pareto(p->points, p->count, front) : 0;
    for (uint32_t i = 0; i < p->count; i++) {
        const front_point *own = &p->points[i];
        cJSON *run = cJSON_GetArrayItem(runs, (int)i);
        bool shown = !json_true(run, "swept"), best = true;
        for (uint32_t k = 0; k < num; k++) {
            shown = shown || front[k] == i;
        }
        for (uint32_t k = 0; k < p->count; k++) {
            const front_point *other = &p->points[k];
            best = best && !(other->line == own->line &&
                             (other->error < own->error ||
                              (other->error == own->error && other->ms < own->ms)));
        }
        cJSON_AddBoolToObject(run, "shown", (shown || best) && isfinite(own->error));
    }
    free(front);
}

// ---- times at equal error ---------------------------------------------------------------------

// The baseline that takes the least time to an error, whether that is measured or extrapolated: a baseline that was given
// fewer samples is no slower for it. *line: which; undefined where none gets there.
static front_time best_baseline(const plane *p, double error, uint32_t *line)
{
    front_time best = {NAN, -1, false};
    for (uint32_t b = 0; b < p->num_lines; b++) {
        if (!p->lines[b].baseline) {
            continue;
        }
        const front_time time = front_time_at(p->points, p->count, b, error);
        if (time.ms < best.ms || (isnan(best.ms) && !isnan(time.ms))) {
            best = time;
            *line = b;
        }
    }
    return best;
}

// The least error of a baseline after a time, whether that is measured or extrapolated.
static front_error best_error(const plane *p, double ms)
{
    front_error best = {NAN, false};
    for (uint32_t b = 0; b < p->num_lines; b++) {
        const front_error own =
            p->lines[b].baseline ? front_error_at(p->points, p->count, b, ms) : best;
        if (own.error < best.error || (isnan(best.error) && !isnan(own.error))) {
            best = own;
        }
    }
    return best;
}

static bool has_baseline(const plane *p)
{
    bool has = false;
    for (uint32_t b = 0; b < p->num_lines; b++) {
        has = has || p->lines[b].baseline;
    }
    return has;
}

static cJSON *json_comparison(const plane *p, double own_ms, double error, bool known)
{
    uint32_t line = 0;
    const front_time base = known ? best_baseline(p, error, &line) : (front_time){NAN, -1, false};
    cJSON *entry = cJSON_CreateObject();
    cJSON_AddStringToObject(entry, "frame", bench_time_names[p->time]);
    cJSON_AddNumberToObject(entry, "block", p->block);
    cJSON_AddItemToObject(entry, "baseline",
                          isnan(base.ms) ? cJSON_CreateNull()
                                         : cJSON_CreateString(p->lines[line].name));
    json_add_float(entry, "baseline_ms", base.ms);
    json_add_float(entry, "speedup", base.ms / own_ms);
    cJSON_AddBoolToObject(entry, "measured", base.measured);
    return entry;
}

static void add_why(const plane *p, cJSON *entry, bool vague)
{
    char noise[16];
    char *why = vague ? text_format("the noise of its reference, %s, is more than half of this",
                                    percent(p->noise, noise))
                      : NULL;
    cJSON_AddItemToObject(entry, "why", why ? cJSON_CreateString(why) : cJSON_CreateNull());
    free(why);
}

// Below twice the noise of the reference an error is not known well enough to be asked for: "why", and no times.
static cJSON *json_equal_error(const plane *p, double error, uint32_t own_line)
{
    const bool vague = error < 2 * p->noise;
    const front_time own =
        vague ? (front_time){NAN, -1, false} : front_time_at(p->points, p->count, own_line, error);
    cJSON *entry = json_comparison(p, own.ms, error, !vague);
    cJSON_AddNumberToObject(entry, "error", error);
    cJSON_AddStringToObject(entry, "method", p->lines[own_line].name);
    json_add_float(entry, "ms", own.ms);
    cJSON_AddItemToObject(entry, "run", json_key(p, own.point));
    add_why(p, entry, vague);
    return entry;
}

void plane_add_equal_errors(const plane *p, cJSON *list)
{
    const double *asked = p->block ? asked_errors : asked_flips;
    for (int e = 0; e < NUM_ASKED && has_baseline(p); e++) {
        for (uint32_t m = 0; m < p->num_lines; m++) {
            if (!p->lines[m].sampling) {
                cJSON_AddItemToArray(list, json_equal_error(p, asked[e], m));
            }
        }
    }
}

void plane_add_own_equal_errors(const plane *p, cJSON *runs)
{
    for (uint32_t i = 0; i < p->count; i++) {
        const front_point *point = &p->points[i];
        cJSON *run = cJSON_GetArrayItem(runs, (int)i), *error;
        cJSON_ArrayForEach(error, cJSON_GetObjectItemCaseSensitive(run, "errors"))
        {
            if (json_figure(error, "block") == p->block && p->time == TIME_LIGHT) {
                cJSON_AddBoolToObject(error, "vague", point->error < 2 * p->noise);
            }
        }
        const bool asked = p->time == TIME_LIGHT || json_text(run, "preset")[0];
        if (!point->sampling && isfinite(point->error) && isfinite(point->ms) && asked &&
            has_baseline(p)) {
            cJSON *list = cJSON_GetObjectItemCaseSensitive(run, "equal_error");
            list = list ? list : cJSON_AddArrayToObject(run, "equal_error");
            cJSON *entry =
                json_comparison(p, point->ms, point->error, point->error >= 2 * p->noise);
            const front_error there = best_error(p, point->ms); // at equal time
            json_add_float(entry, "baseline_error", there.error);
            cJSON_AddBoolToObject(entry, "error_measured", there.measured);
            cJSON_AddItemToArray(list, entry);
        }
    }
}

// ---- peers ------------------------------------------------------------------------------------

static void add_time(cJSON *entry, const char *ms, const char *measured, front_time time)
{
    json_add_float(entry, ms, time.ms);
    cJSON_AddBoolToObject(entry, measured, time.measured);
}

static cJSON *json_peer(const plane *p, uint32_t line, double error)
{
    const front_time none = {NAN, -1, false};
    const bool vague = error < 2 * p->noise;
    const int64_t own_line = find_line(p, tyn_method_default());
    uint32_t base_line = 0;
    const front_time base = vague ? none : best_baseline(p, error, &base_line);
    cJSON *entry = cJSON_CreateObject();
    cJSON_AddNumberToObject(entry, "block", p->block);
    cJSON_AddNumberToObject(entry, "error", error);
    add_time(entry, "ms", "measured",
             vague ? none : front_time_at(p->points, p->count, line, error));
    cJSON_AddItemToObject(entry, "baseline",
                          isnan(base.ms) ? cJSON_CreateNull()
                                         : cJSON_CreateString(p->lines[base_line].name));
    add_time(entry, "baseline_ms", "baseline_measured", base);
    cJSON_AddStringToObject(entry, "method", tyn_method_default());
    json_add_float(entry, "method_ms",
                   vague || own_line < 0
                       ? NAN
                       : front_time_at(p->points, p->count, (uint32_t)own_line, error).ms);
    add_why(p, entry, vague);
    return entry;
}

void plane_add_peer(const plane *p, const char *peer, cJSON *list)
{
    const int64_t line = find_line(p, peer);
    for (int e = 0; e < NUM_ASKED && line >= 0 && p->block > 0; e++) {
        cJSON_AddItemToArray(list, json_peer(p, (uint32_t)line, peer_errors[e]));
    }
}

// ---- who is fastest ---------------------------------------------------------------------------

cJSON *plane_ranges(const plane *p)
{
    front_range ranges[MAX_RANGES];
    const uint32_t num = front_ranges(p->points, p->count, ranges, MAX_RANGES);
    cJSON *list = cJSON_CreateArray();
    for (uint32_t i = 0; i < num; i++) {
        const front_range *r = &ranges[i];
        cJSON *range = cJSON_CreateObject();
        cJSON_AddNumberToObject(range, "block", p->block);
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

// "above 12 %", "from 3.0 % to 5.1 %"
static char *where(double low, double high)
{
    char from[16], to[16];
    percent(low, from);
    return isfinite(high) ? text_format("from %s to %s", from, percent(high, to))
                          : text_format("above %s", from);
}

// "at errors above 5.0 % pop is not on the front everywhere: path wins above 12 %"
static char *promise_text(double above, const cJSON *beaten)
{
    char from[16];
    percent(above, from);
    if (cJSON_GetArraySize(beaten) == 0) {
        return text_format("pop is on the front at all errors above %s", from);
    }
    char *text = text_format("pop is not on the front at all errors above %s:", from);
    for (int i = cJSON_GetArraySize(beaten); text && i-- > 0;) {
        const cJSON *b = cJSON_GetArrayItem(beaten, i);
        const cJSON *low = cJSON_GetObjectItemCaseSensitive(b, "low");
        const cJSON *high = cJSON_GetObjectItemCaseSensitive(b, "high");
        char *range = where(cJSON_IsNumber(low) ? low->valuedouble : NAN,
                            cJSON_IsNumber(high) ? high->valuedouble : INFINITY);
        char *longer = text_format("%s %s wins %s%s", text, json_text(b, "method"),
                                   range ? range : "", i > 0 ? ";" : "");
        free(range);
        free(text);
        text = longer;
    }
    return text;
}

cJSON *plane_promise(const plane *p)
{
    const int64_t own = find_line(p, tyn_method_default());
    const double floor = own < 0 ? NAN : least_error(p, own);
    if (isnan(floor)) {
        return cJSON_CreateNull();
    }
    const double above = fmax(promised_error, promised_floors * floor);
    front_range ranges[MAX_RANGES];
    const uint32_t num = front_ranges(p->points, p->count, ranges, MAX_RANGES);
    cJSON *promise = cJSON_CreateObject(), *beaten = cJSON_CreateArray();
    for (uint32_t i = 0; i < num; i++) {
        const front_range *r = &ranges[i];
        const double low = fmax(r->low, above), high = r->highest ? INFINITY : r->high;
        // As with ranges: what is narrower than 5 % is noise of times.
        if (r->line != own && high > 1.05 * low) {
            cJSON *other = cJSON_CreateObject();
            cJSON_AddStringToObject(other, "method", p->lines[r->line].name);
            cJSON_AddNumberToObject(other, "low", low);
            cJSON_AddItemToObject(other, "high",
                                  r->highest ? cJSON_CreateNull() : cJSON_CreateNumber(high));
            cJSON_AddItemToArray(beaten, other);
        }
    }
    char *text = promise_text(above, beaten);
    cJSON_AddNumberToObject(promise, "block", p->block);
    cJSON_AddStringToObject(promise, "method", tyn_method_default());
    json_add_float(promise, "floor", floor);
    json_add_float(promise, "above", above);
    cJSON_AddBoolToObject(promise, "holds", cJSON_GetArraySize(beaten) == 0);
    cJSON_AddItemToObject(promise, "beaten", beaten);
    cJSON_AddStringToObject(promise, "text", text ? text : "");
    free(text);
    return promise;
}

// "pop is on the front above 2.7 %"
static char *verdict(const plane *p, const front_range *r, bool first)
{
    const char *name = p->lines[r->line].name;
    const char *does = strcmp(name, tyn_method_default()) == 0 ? "is on the front" : "wins";
    // The first of all begins where the noise of the reference ends what is known.
    const char *noise = first && !r->lowest ? ", the noise of the reference" : "";
    char low[16], high[16];
    percent(r->low, low);
    percent(r->high, high);
    if (r->lowest && r->highest) {
        return text_format("%s %s at all errors", name, does);
    }
    return r->highest  ? text_format("%s %s above %s%s", name, does, low, noise)
           : r->lowest ? text_format("%s %s below %s", name, does, high)
                       : text_format("%s %s from %s%s%s to %s", name, does, low, noise,
                                     noise[0] ? "," : "", high);
}

cJSON *plane_verdicts(const plane *p)
{
    front_range ranges[MAX_RANGES];
    const uint32_t num = front_ranges(p->points, p->count, ranges, MAX_RANGES);
    cJSON *verdicts = cJSON_CreateArray();
    const char *own = tyn_method_default();
    bool wins = false;
    for (uint32_t i = num; i-- > 0;) { // from what is asked for most
        wins = wins || strcmp(p->lines[ranges[i].line].name, own) == 0;
        add_verdict(verdicts, verdict(p, &ranges[i], i == 0));
    }
    if (find_line(p, own) >= 0 && num > 0 && !wins) {
        char low[16];
        add_verdict(verdicts, ranges[0].lowest ? text_format("%s is nowhere the fastest", own)
                                               : text_format("%s is nowhere the fastest above %s",
                                                             own, percent(ranges[0].low, low)));
    }
    return verdicts;
}
