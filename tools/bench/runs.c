// runs.c -- all runs of a suite on one scene: taken over from records, or measured.
#include "runs.h"
#include "record.h"
#include <stdlib.h>
#include <string.h>

// ---- before the first -------------------------------------------------------------------------

// A key that does nothing would be taken for one that does. False: said.
static bool check_samples(app *a, const bench_run *run, const tyn_method_info *info)
{
    static const char *const keys[] = {"spp", "seed"};
    if (run->baseline && !info->progressive) {
        app_error(a, "method '%s' does not sample; its error does not fall with time", info->name);
        return false;
    }
    for (size_t i = 0; i < ARRAY_SIZE(keys) && !info->progressive; i++) {
        if (cJSON_GetObjectItemCaseSensitive(run->spec, keys[i])) {
            app_error(a, "%s: method '%s' does not sample and would ignore it", keys[i],
                      info->name);
            return false;
        }
    }
    if (info->progressive && run->method.seed >= BENCH_REFERENCE_SEED) {
        app_error(a,
                  "seed %u: those from %d on are of references: samples compared with themselves "
                  "have no error",
                  run->method.seed, BENCH_REFERENCE_SEED);
        return false;
    }
    return true;
}

static int check_run(app *a, const bench_suite *suite, const bench_run *run, bool *samples)
{
    char *place = bench_run_place(suite, run);
    a->within = place;
    method m;
    int code = method_open(a, &run->method, &m);
    if (code == EXIT_DONE && !check_samples(a, run, &m.info)) {
        code = EXIT_WRONG;
    }
    *samples = m.info.progressive;
    method_finish(&m);
    a->within = NULL;
    free(place);
    return code;
}

// A group is one line of error against time: either a moved camera costs all of its runs a cold frame, or none.
static int check_groups(app *a, const bench_suite *suite, const bool *samples)
{
    for (uint32_t i = 0; i < suite->num_runs; i++) {
        for (uint32_t k = 0; k < i; k++) {
            const bench_run *one = &suite->runs[i], *other = &suite->runs[k];
            if (samples[i] != samples[k] && strcmp(one->group, other->group) == 0) {
                app_error(a,
                          "%s: group '%s': '%s' samples and '%s' does not; give one of them "
                          "another \"group\"",
                          suite->file, one->group, samples[i] ? one->name : other->name,
                          samples[i] ? other->name : one->name);
                return EXIT_WRONG;
            }
        }
    }
    return EXIT_DONE;
}

static int check_scene(app *a, const bench_suite *suite, const bench_scene *scene)
{
    char *place = bench_scene_place(suite, scene);
    a->within = place;
    int code = bench_case_check(a, suite, scene);
    a->within = NULL;
    free(place);
    return code;
}

int bench_check(app *a, const bench_suite *suite)
{
    bool samples[BENCH_MAX_RUNS] = {false};
    int code = EXIT_DONE;
    for (uint32_t i = 0; i < suite->num_runs && code == EXIT_DONE; i++) {
        code = check_run(a, suite, &suite->runs[i], &samples[i]);
    }
    if (code == EXIT_DONE) {
        code = check_groups(a, suite, samples);
    }
    for (uint32_t i = 0; i < suite->num_scenes && code == EXIT_DONE; i++) {
        code = check_scene(a, suite, &suite->scenes[i]);
    }
    if (code == EXIT_DONE && suite->num_left_out) {
        app_note(a, "%s: %u of its runs are left out; not in this build: %s", suite->file,
                 suite->num_left_out, tyn_methods_left_out());
    }
    return code;
}

// ---- in which order ---------------------------------------------------------------------------

typedef struct turn {
    uint32_t index; // of the suite's runs
    uint32_t group; // the first run of its group
} turn;

// Runs of the suite for a scene as they are measured: samples of a group ascend, so that what the few have taken tells
// what the many would, however the suite lists them. Gives their number.
static uint32_t turns_of(const bench_case *c, turn *turns)
{
    const bench_run *runs = c->suite->runs;
    uint32_t num = 0;
    for (uint32_t i = 0; i < c->suite->num_runs; i++) {
        if (!bench_run_is_for(&runs[i], c->spec)) {
            continue;
        }
        turn own = {i, i};
        for (uint32_t k = 0; k < num; k++) {
            if (strcmp(runs[turns[k].index].group, runs[i].group) == 0) {
                own.group = turns[k].group;
                break;
            }
        }
        uint32_t at = num++;
        for (; at > 0; at--) {
            const turn *before = &turns[at - 1];
            if (before->group < own.group ||
                (before->group == own.group &&
                 runs[before->index].method.spp <= runs[i].method.spp)) {
                break;
            }
            turns[at] = *before;
        }
        turns[at] = own;
    }
    return num;
}

// What the most samples of the group so far have taken tells what more will take.
static double expected_seconds(const bench_run *run, cJSON *const *done, uint32_t count)
{
    double seconds = 0, most = 0;
    for (uint32_t i = 0; i < count; i++) {
        const double spp = json_figure(done[i], "settings.spp");
        const double own =
            1e-3 * json_figure(done[i], "frame_ms.animated_light") * run->method.spp / spp;
        if (done[i] && strcmp(json_text(done[i], "group"), run->group) == 0 &&
            spp < run->method.spp && (spp > most || (spp == most && own > seconds))) {
            most = spp;
            seconds = own;
        }
    }
    return seconds;
}

// ---- measuring --------------------------------------------------------------------------------

// The record of a run, from the folder or measured now.
static int get_record(bench_case *c, const bench_run *run, bool fresh, cJSON **record)
{
    char key[17];
    int code = bench_key(c, run, key);
    *record = code == EXIT_DONE && !fresh ? record_load(c->folder, key, c->spec, run) : NULL;
    if (*record || code != EXIT_DONE) {
        return code;
    }
    code = bench_measure(c, run, key, record);
    if (*record && code == EXIT_DONE) {
        code = record_store(c->a, c->folder, key, record);
    } else if (
        *record) { // it failed for want of memory or of the device, which is no property of it
        code = record_store(c->a, NULL, key, record);
    }
    return code;
}

static void leave_out(const bench_run *run, double seconds, double most, cJSON *left_out)
{
    char *why = text_format("would take about %.0f s; max_seconds is %g", seconds, most);
    cJSON *entry = cJSON_CreateObject();
    cJSON_AddStringToObject(entry, "run", run->name);
    cJSON_AddStringToObject(entry, "group", run->group);
    cJSON_AddStringToObject(entry, "why", why ? why : "");
    cJSON_AddItemToArray(left_out, entry);
    free(why);
}

int bench_runs(bench_case *c, bool fresh, cJSON *runs, cJSON *left_out)
{
    turn turns[BENCH_MAX_RUNS];
    cJSON *done[BENCH_MAX_RUNS] = {NULL}; // by place in the suite
    const uint32_t num = turns_of(c, turns);
    int code = EXIT_DONE;
    for (uint32_t i = 0; i < num && code == EXIT_DONE; i++) {
        const bench_run *run = &c->suite->runs[turns[i].index];
        const double seconds = expected_seconds(run, done, c->suite->num_runs);
        if (seconds > c->suite->max_seconds) {
            leave_out(run, seconds, c->suite->max_seconds, left_out);
            continue;
        }
        cJSON *record = NULL;
        code = get_record(c, run, fresh, &record);
        if (code == EXIT_DONE) {
            cJSON *measured = cJSON_DetachItemFromObjectCaseSensitive(record, "run");
            cJSON_AddStringToObject(measured, "date", json_text(record, "date"));
            done[turns[i].index] = measured;
        }
        cJSON_Delete(record);
    }
    for (uint32_t i = 0; i < c->suite->num_runs; i++) {
        if (done[i]) {
            cJSON_AddItemToArray(runs, done[i]);
        }
    }
    return code;
}
