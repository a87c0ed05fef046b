// stress.c -- runs the stress suite: answers, methods, cells of the heat table.
#include "stress.h"
#include "json.h"
#include "stats.h"
#include "stress_render.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/registry.h>

static const char *const answers[] = {NULL, "furnace", "table",
                                      "imbalance"}; // NULL: the reference method

// Reference pictures may take this long each, and the reference method as one that is judged.
static const stress_effort reference_effort = {.noise = 0.005, .seconds = 3, .seed = 7};
static const stress_effort quick_reference_effort = {.noise = 0.01, .seconds = 0.8, .seed = 7};
static const stress_effort run_effort = {.noise = 0.02, .seconds = 0.6, .seed = 1};

static const double most_cut = 0.01; // share of a reference's paths that its cap may have ended

typedef struct suite {
    app *a;
    tyn_device *device;
    const stress_options *options;
    bool table;
    cJSON *cells;
    // The last reference that was rendered, of light scattered any number of times, and once.
    const stress_case *made_of[2];
    stress_picture made[2];
    double cut[2]; // share of its paths that were ended by their cap
} suite;

// ---- answers ----------------------------------------------------------------------------------

static void fill(stress_picture *p, double value)
{
    *p = (stress_picture){0};
    for (int i = 0; i < 3 * STRESS_PIXELS; i++) {
        p->rgb[i % 3][i / 3] = (float)value;
    }
}

// Whose picture is the reference.
static const stress_case *reference_case(const stress_case *c)
{
    return c->like ? c->like : c;
}

// `once`: light that scattered once alone.
static int answer(suite *s, const stress_case *c, bool once, stress_picture *p)
{
    if (!once && c->answer == STRESS_BY_FURNACE) {
        fill(p, 1);
        return EXIT_DONE;
    }
    if (!once && c->answer == STRESS_BY_TABLE) {
        fill(p, stress_half_space(c->albedo, 1, -stress_sun[1]));
        return EXIT_DONE;
    }
    const stress_case *of = reference_case(c);
    int code = EXIT_DONE;
    if (s->made_of[once] != of) {
        stress_effort effort = s->options->quick ? quick_reference_effort : reference_effort;
        effort.max_depth = once ? 1 : 0;
        stress_counts counts = {.warnings = cJSON_CreateArray()};
        s->made_of[once] = NULL;
        code = stress_render(s->a, s->device, tyn_method_reference(), of, &effort, &s->made[once],
                             &counts);
        if (code == EXIT_DONE && counts.failure) {
            app_error(s->a, "stress: the reference was %s", counts.failure);
            code = EXIT_FAILED;
        }
        s->cut[once] = counts.paths > 0 ? counts.cut / counts.paths : 0;
        free(counts.failure);
        cJSON_Delete(counts.warnings);
        s->made_of[once] = code == EXIT_DONE ? of : NULL;
    }
    *p = s->made[once];
    p->cut = s->cut[once];
    return code;
}

// ---- cells ------------------------------------------------------------------------------------

typedef struct cell {
    const stress_case *c;
    const char *method;
    char against[64];
    double error, se; // NAN: not known
    stress_counts counts;
} cell;

static void case_name(const stress_case *c, char name[48])
{
    if (c->name) {
        snprintf(name, 48, "%s", c->name);
    } else {
        snprintf(name, 48, "%g", c->x);
    }
}

static void add_cell(suite *s, const cell *k)
{
    cJSON *o = cJSON_CreateObject();
    cJSON_AddStringToObject(o, "method", k->method);
    cJSON_AddStringToObject(o, "axis", k->c->axis);
    char name[48];
    case_name(k->c, name);
    cJSON_AddStringToObject(o, "case", name);
    json_add_float(o, "x", k->c->x);
    json_add_float(o, "sigma_t", k->c->sigma);
    json_add_float(o, "albedo", k->c->albedo);
    json_add_float(o, "g", k->c->g);
    json_add_float(o, "error", k->error);
    json_add_float(o, "se", k->se);
    cJSON_AddStringToObject(o, "against", k->against);
    cJSON_AddNumberToObject(o, "non_finite", k->counts.non_finite);
    cJSON_AddNumberToObject(o, "negative", k->counts.negative);
    cJSON_AddNumberToObject(o, "clamped", k->counts.clamped);
    json_add_float(o, "hidden", k->counts.hidden);
    cJSON_AddItemToObject(o, "warnings", k->counts.warnings);
    json_add_float(o, "ms", round(100 * k->counts.ms) / 100);
    if (k->counts.failure) {
        cJSON_AddStringToObject(o, "failure", k->counts.failure);
    }
    cJSON_AddItemToArray(s->cells, o);
    if (s->table) {
        const cJSON *warning = cJSON_GetArrayItem(k->counts.warnings, 0);
        char label[64], error[32] = "       -", hidden[32] = "";
        snprintf(label, sizeof label, "%s%s%g", k->c->name ? k->c->name : "",
                 k->c->name ? ", " : "", k->c->x);
        if (isfinite(k->error)) {
            snprintf(error, sizeof error, "%7.2f%%", 100 * k->error);
        }
        if (k->counts.hidden > 0) {
            snprintf(hidden, sizeof hidden, "hidden %.2g%%", 100 * k->counts.hidden);
        }
        printf("%-20s %-26s %-10s %s +- %.2f%% %-14s %s\n", k->c->axis, label, k->method, error,
               100 * (isfinite(k->se) ? k->se : 0), hidden,
               k->counts.failure ? k->counts.failure
               : warning         ? warning->valuestring
                                 : "");
        fflush(stdout);
    }
}

// Relative error of block means without what noise explains. What the paths that were ended would still have brought is
// at most about their share twice: they may be of the bright pixels.
static double compare(const stress_picture *p, const stress_picture *reference, double *se)
{
    metrics_image image, ref;
    metrics m = {0};
    stress_image(p, &image);
    stress_image(reference, &ref);
    *se = hypot(hypot(p->noise, reference->noise), 2 * reference->cut);
    metrics_status status = metrics_compare(&image, &ref, STRESS_BLOCK, &m);
    if (status == METRICS_ZERO_REFERENCE) { // black: right if it is black
        double sum = 0;
        for (int i = 0; i < 3 * STRESS_PIXELS; i++) {
            sum += fabs(p->rgb[i % 3][i / 3]);
        }
        return isfinite(sum) ? sum > 0 : NAN;
    }
    return status == METRICS_OK ? m.error : NAN;
}

static int run_cell(suite *s, const stress_case *c, const tyn_method_info *with)
{
    const bool once = with->single_only && c->answer != STRESS_BY_IMBALANCE;
    cell k = {.c = c, .method = with->name, .error = NAN, .se = NAN};
    const char *by = once || !answers[c->answer] ? tyn_method_reference() : answers[c->answer];
    snprintf(k.against, sizeof k.against, "%s%s%s", by, once ? ", " : "", once ? with->name : "");
    k.counts.warnings = cJSON_CreateArray();
    stress_picture *p = malloc(2 * sizeof *p);
    int code = p ? EXIT_DONE : app_exit_code(s->a, TYN_ERR_MEMORY, false);
    if (code == EXIT_DONE && c->answer == STRESS_BY_IMBALANCE) {
        code =
            stress_balance(s->a, s->device, with->name, c, &run_effort, &k.error, &k.se, &k.counts);
        k.error = fabs(k.error);
    } else if (code == EXIT_DONE) {
        code = stress_render(s->a, s->device, with->name, c, &run_effort, &p[0], &k.counts);
        // Nobody is judged by himself.
        bool judged = !with->reference || c->like || c->answer != STRESS_BY_PATH;
        if (code == EXIT_DONE && !k.counts.failure && judged) {
            code = answer(s, c, once, &p[1]);
            k.error =
                code == EXIT_DONE && p[1].cut <= most_cut ? compare(&p[0], &p[1], &k.se) : NAN;
        } else if (code == EXIT_DONE) {
            k.se = p[0].noise;
        }
    }
    free(p);
    if (code == EXIT_DONE) {
        add_cell(s, &k);
    } else {
        cJSON_Delete(k.counts.warnings);
    }
    free(k.counts.failure);
    return code;
}

// Imbalance is told by the methods that have a balance; samples would need days where nothing is absorbed.
static bool belongs(const stress_options *o, const stress_case *c, const tyn_method_info *with)
{
    const bool tells = with->outputs & TYN_OUTPUT_BALANCE && !with->progressive;
    return (!o->quick || c->quick) && (c->answer != STRESS_BY_IMBALANCE || tells);
}

// The next of names with commas between; false: there are no more. `*at` begins as the list, or as NULL.
static bool next_name(const char **at, char name[64])
{
    if (!*at) {
        return false;
    }
    const size_t length = strcspn(*at, ",");
    snprintf(name, 64, "%.*s", (int)length, *at);
    *at = (*at)[length] ? *at + length + 1 : NULL;
    return true;
}

static bool is_asked(const stress_options *o, const stress_case *c, const char *with)
{
    char name[64];
    bool listed = !o->methods;
    for (const char *at = o->methods; next_name(&at, name);) {
        listed = listed || strcmp(name, with) == 0;
    }
    return listed && (!o->axis || strstr(c->axis, o->axis));
}

bool stress_has_methods(const char *methods, char name[64])
{
    tyn_method_info info;
    for (const char *at = methods; next_name(&at, name);) {
        if (!tyn_method_named(name, &info)) {
            return false;
        }
    }
    return true;
}

bool stress_has_axis(const char *part)
{
    for (uint32_t i = 0; i < stress_num_cases; i++) {
        if (strstr(stress_cases[i].axis, part)) {
            return true;
        }
    }
    return false;
}

// The cell of an earlier run, or NULL.
static const cJSON *find_cell(const cJSON *before, const stress_case *c, const char *with)
{
    char name[48];
    case_name(c, name);
    const cJSON *known;
    cJSON_ArrayForEach(known, cJSON_GetObjectItemCaseSensitive(before, "cells"))
    {
        if (strcmp(json_text(known, "axis"), c->axis) == 0 &&
            strcmp(json_text(known, "case"), name) == 0 &&
            strcmp(json_text(known, "method"), with) == 0 &&
            (float)json_figure(known, "x") == (float)c->x) {
            return known;
        }
    }
    return NULL;
}

// A cell of the suite: run, or kept, or neither.
static int take_cell(suite *s, const stress_case *c, const tyn_method_info *with,
                     const cJSON *before)
{
    if (is_asked(s->options, c, with->name)) {
        return run_cell(s, c, with);
    }
    const cJSON *kept = find_cell(before, c, with->name);
    if (kept) {
        cJSON_AddItemToArray(s->cells, cJSON_Duplicate(kept, true));
    }
    return EXIT_DONE;
}

int stress_run(app *a, tyn_device *device, const stress_options *options, bool table,
               const cJSON *before, cJSON *stress)
{
    suite *s = calloc(1, sizeof *s);
    if (!s) {
        return app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    *s = (suite){.a = a, .device = device, .options = options, .table = table};
    cJSON *axes = cJSON_AddArrayToObject(stress, "axes");
    cJSON *names = cJSON_AddArrayToObject(stress, "methods");
    tyn_method_info with;
    for (uint32_t m = 0; m < tyn_num_methods(); m++) {
        tyn_method_at(m, &with);
        cJSON_AddItemToArray(names, cJSON_CreateString(with.name));
    }
    s->cells = cJSON_AddArrayToObject(stress, "cells");
    const bool quiet = a->quiet;
    a->quiet = true; // warnings are in the cells
    const char *axis = "";
    const double start = app_seconds();
    int code = EXIT_DONE, expected = 0;
    for (uint32_t i = 0; i < stress_num_cases && code == EXIT_DONE; i++) {
        const stress_case *c = &stress_cases[i];
        const int there = cJSON_GetArraySize(s->cells);
        for (uint32_t m = 0; m < tyn_num_methods() && code == EXIT_DONE; m++) {
            tyn_method_at(m, &with);
            if (belongs(options, c, &with)) {
                code = take_cell(s, c, &with, before);
                expected++;
            }
        }
        if (cJSON_GetArraySize(s->cells) > there && strcmp(axis, c->axis)) {
            cJSON_AddItemToArray(axes, cJSON_CreateString(c->axis));
            axis = c->axis;
        }
    }
    cJSON_AddNumberToObject(stress, "expected", expected);
    json_add_float(stress, "seconds", app_seconds() - start);
    a->quiet = quiet;
    free(s);
    return code;
}
