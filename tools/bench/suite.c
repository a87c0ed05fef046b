// suite.c -- what to measure: reads and checks a suite file (docs/bench.md).
#include "suite.h"
#include "peers.h"
#include "suite_reader.h"
#include "bench/suite_default.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/registry.h>
#include <tyndall/io.h>

// ---- scenes -----------------------------------------------------------------------------------

enum { DEFAULT_SPP = 1024, MAX_SPP = 1 << 24 };

// What a scene has of the suite where it says nothing itself.
typedef struct scene_defaults {
    opt_size size;
    bench_goal goal;
} scene_defaults;

// Without a limit of samples those of noise and time end a reference, and the other way round.
static bench_goal read_goal(suite_reader *r, const cJSON *json, const bench_goal *defaults)
{
    bench_goal goal = {.noise = suite_number(r, json, "reference_noise", defaults->noise, 0, 1),
                       .seconds =
                           suite_number(r, json, "reference_seconds", defaults->seconds, 0, 1e9)};
    const double spp = goal.noise > 0 && defaults->spp == DEFAULT_SPP ? MAX_SPP : defaults->spp;
    goal.spp = suite_whole(r, json, "reference_spp", spp, 2, MAX_SPP);
    return goal;
}

static void read_scene(suite_reader *r, const cJSON *json, const scene_defaults *defaults,
                       const char *folder, bench_scene *s)
{
    static const char *const keys[] = {"name",
                                       "scene",
                                       "environment",
                                       "camera",
                                       "size",
                                       "fov",
                                       "look_from",
                                       "look_at",
                                       "sigma_s",
                                       "sigma_a",
                                       "g",
                                       "albedo",
                                       "density_scale",
                                       "env_rotate",
                                       "reference_spp",
                                       "reference_noise",
                                       "reference_seconds",
                                       "lights",
                                       "reference",
                                       NULL};
    *s = (bench_scene){.json = json,
                       .scene.env_strength = 1,
                       .scene.frame = NAN,
                       .scene.time = NAN,
                       .scene.fps = 24,
                       .view.size = defaults->size};
    suite_check_keys(r, json, keys);
    const char *file = suite_text(r, json, "scene", true);
    if (!file) {
        return;
    }
    s->name = suite_text(r, json, "name", false);
    s->name = s->name ? s->name : file;
    s->path = suite_file(r, json, "scene", folder);
    s->scene.scene = s->path;
    s->environment = suite_file(r, json, "environment", folder);
    s->scene.env = s->environment;
    s->scene.env_rotate = (float)suite_number(r, json, "env_rotate", 0, -1e6, 1e6);
    s->scene.density_scale = (float)suite_number(r, json, "density_scale", NAN, 0, 1e30);
    suite_vector(r, json, "sigma_s", true, &s->scene.sigma_s);
    suite_vector(r, json, "sigma_a", true, &s->scene.sigma_a);
    suite_vector(r, json, "g", true, &s->scene.g);
    suite_vector(r, json, "albedo", true, &s->scene.albedo);
    s->lights = suite_whole(r, json, "lights", 0, 0, TYN_MAX_LIGHTS);
    s->view.camera = suite_text(r, json, "camera", false);
    s->view.fov = (float)suite_number(r, json, "fov", NAN, 1e-3, 179.9);
    suite_vector(r, json, "look_from", false, &s->view.look_from);
    suite_vector(r, json, "look_at", false, &s->view.look_at);
    suite_size(r, json, &s->view.size);
    s->goal = read_goal(r, json, &defaults->goal);
    s->reference = suite_file(r, json, "reference", folder);
}

// ---- runs -------------------------------------------------------------------------------------

// {"pass.param": value} -> "pass.param=value" for each, one after the other in run->defines.
static void read_settings(suite_reader *r, const cJSON *settings, bench_run *run)
{
    char *text = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&text, &size);
    if (!memory) {
        suite_fault(r, "settings", "out of memory");
        return;
    }
    uint32_t count = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, settings)
    {
        if (cJSON_IsString(item)) {
            fprintf(memory, "%s=%s%c", item->string, item->valuestring, '\0');
        } else if (cJSON_IsNumber(item) || cJSON_IsBool(item)) {
            double value = cJSON_IsNumber(item) ? item->valuedouble : cJSON_IsTrue(item);
            fprintf(memory, "%s=%.9g%c", item->string, value, '\0');
        } else {
            suite_fault(r, item->string, "must be a number, a string or true or false");
        }
        count++;
    }
    fclose(memory);
    run->defines = text;
    if (count > OPT_MAX_LIST) {
        suite_fault(r, "settings", "holds too many parameters");
        return;
    }
    for (char *define = text; r->ok && run->method.defines.count < count;
         define += strlen(define) + 1) {
        run->method.defines.items[run->method.defines.count++] = define;
    }
}

// What the suite calls "spp" is one of a sampling method; the others are parameters of passes or "quality".
static bool is_setting(const char *key)
{
    return strcmp(key, "spp") != 0 && strcmp(key, "quality") != 0;
}

// ", cells 32" for "lattice.cells", ", 64 spp": what tells the runs of a sweep apart.
static char *with_value(const char *name, const char *key, const cJSON *value)
{
    const char *dot = strrchr(key, '.'), *tail = dot ? dot + 1 : key;
    if (cJSON_IsString(value)) {
        return is_setting(key) ? text_format("%s, %s %s", name, tail, value->valuestring)
                               : text_format("%s, %s", name, value->valuestring);
    }
    double number = cJSON_IsNumber(value) ? value->valuedouble : cJSON_IsTrue(value);
    return strcmp(key, "spp") == 0 ? text_format("%s, %.9g spp", name, number)
                                   : text_format("%s, %s %.9g", name, tail, number);
}

// Puts a value of a sweep into the entry, and into the run's name.
static void apply_value(suite_reader *r, bench_run *run, const char *key, const cJSON *value)
{
    cJSON *copy = cJSON_Duplicate(value, true);
    if (is_setting(key)) {
        cJSON *settings = cJSON_GetObjectItemCaseSensitive(run->spec, "settings");
        settings = settings ? settings : cJSON_AddObjectToObject(run->spec, "settings");
        cJSON_DeleteItemFromObjectCaseSensitive(settings, key);
        cJSON_AddItemToObject(settings, key, copy);
    } else {
        cJSON_DeleteItemFromObjectCaseSensitive(run->spec, key);
        cJSON_AddItemToObject(run->spec, key, copy);
    }
    char *name = with_value(run->name, key, value);
    free(run->name);
    run->name = name;
    if (!name) {
        suite_fault(r, "sweep", "out of memory");
    }
}

// The run that `spec` describes; spec has no sweep any more.
static void read_one(suite_reader *r, bench_run *run)
{
    const cJSON *json = run->spec;
    run->method.quality = suite_text(r, json, "quality", false);
    run->method.spp = suite_whole(r, json, "spp", 64, 1, 1 << 24);
    run->method.seed = suite_whole(r, json, "seed", 0, 0, 4294967295.0);
    const cJSON *settings = cJSON_GetObjectItemCaseSensitive(json, "settings");
    if (settings && !cJSON_IsObject(settings)) {
        suite_fault(r, "settings", "must be an object of \"pass.param\": value");
    } else if (settings) {
        read_settings(r, settings, run);
    }
}

// The number of combinations that a sweep has; BENCH_MAX_RUNS + 1: more than there may be.
static uint32_t count_sweep(suite_reader *r, const cJSON *sweep)
{
    uint32_t count = 1, num_axes = 0;
    const cJSON *axis;
    cJSON_ArrayForEach(axis, sweep)
    {
        const int values = cJSON_IsArray(axis) ? cJSON_GetArraySize(axis) : 0;
        char key[96], right[64];
        snprintf(key, sizeof key, "sweep.%.80s", axis->string);
        if (++num_axes > BENCH_MAX_SWEEP) {
            snprintf(right, sizeof right, "must hold up to %d lists of values", BENCH_MAX_SWEEP);
            suite_fault(r, "sweep", right);
        } else if (values < 1) {
            suite_fault(r, key, "must be a list of values, one at least");
        } else if (values > BENCH_MAX_RUNS) {
            snprintf(right, sizeof right, "%d values give more than %d runs", values,
                     BENCH_MAX_RUNS);
            suite_fault(r, key, right);
        }
        if (!r->ok) {
            return 1;
        }
        count *= (uint32_t)values;
        count = count > BENCH_MAX_RUNS ? BENCH_MAX_RUNS + 1 : count;
    }
    return count;
}

// Is it one of the library's methods that this build leaves out?
static bool is_left_out(const char *name)
{
    tyn_method_info info;
    const char *list = tyn_methods_left_out(), *at = strstr(list, name);
    const char end = at ? at[strlen(name)] : 'x';
    return at && (at == list || at[-1] == ' ') && (end == ',' || end == '\0') && name[0] &&
           !tyn_method_named(name, &info);
}

// One entry of `runs` or `baselines`: as many runs as its sweep has combinations of values.
static void read_entry(suite_reader *r, const cJSON *json, bool baseline, uint32_t entry,
                       bench_suite *s)
{
    static const char *const keys[] = {"name", "method", "quality", "settings", "spp",
                                       "seed", "group",  "sweep",   "only",     NULL};
    suite_check_keys(r, json, keys);
    const char *how = suite_text(r, json, "method", false);
    how = how ? how : baseline ? tyn_method_reference() : tyn_method_default();
    if (is_left_out(how)) {
        s->num_left_out++;
        return;
    }
    const char *name = suite_text(r, json, "name", false);
    name = name ? name : how;
    const char *group = suite_text(r, json, "group", false);
    const cJSON *only = cJSON_GetObjectItemCaseSensitive(json, "only");
    const cJSON *sweep = cJSON_GetObjectItemCaseSensitive(json, "sweep"), *axis;
    cJSON *own = NULL;
    if (baseline && !sweep && !cJSON_GetObjectItemCaseSensitive(json, "spp")) {
        sweep = own = cJSON_Parse("{\"spp\": [1, 4, 16, 64, 256, 1024, 4096]}");
    }
    if (sweep && !cJSON_IsObject(sweep)) {
        suite_fault(r, "sweep", "must be an object of \"pass.param\": [values]");
        sweep = NULL;
    }
    const uint32_t count = count_sweep(r, sweep);
    if (s->num_runs + count > BENCH_MAX_RUNS) {
        suite_fault(r, "sweep", "gives more than 256 runs in all");
    }
    for (uint32_t i = 0; r->ok && i < count; i++) {
        bench_run *run = &s->runs[s->num_runs++];
        *run = (bench_run){.entry = entry,
                           .swept = count > 1,
                           .baseline = baseline,
                           .group = group      ? group
                                    : baseline ? name
                                               : how,
                           .method.method = how,
                           .only = only,
                           .name = text_format("%s", name),
                           .spec = cJSON_Duplicate(json, true)};
        cJSON_DeleteItemFromObjectCaseSensitive(run->spec, "sweep");
        uint32_t place = i, rest = count;
        cJSON_ArrayForEach(axis, sweep)
        {
            rest /= (uint32_t)cJSON_GetArraySize(axis);
            apply_value(r, run, axis->string, cJSON_GetArrayItem(axis, (int)(place / rest)));
            place %= rest;
        }
        read_one(r, run);
    }
    cJSON_Delete(own);
}

// ---- the suite --------------------------------------------------------------------------------

static const char *scene_name(suite_reader *r, const cJSON *json, const char *key,
                              const bench_suite *s)
{
    const char *name = suite_text(r, json, key, true);
    for (uint32_t i = 0; name && i < s->num_scenes; i++) {
        if (s->scenes[i].name && strcmp(s->scenes[i].name, name) == 0) {
            return name;
        }
    }
    suite_fault(r, key, "must be the name of a scene of this suite");
    return NULL;
}

static void read_ratio(suite_reader *r, const cJSON *json, const bench_suite *s, bench_ratio *ratio)
{
    static const char *const keys[] = {"name", "of", "to", NULL};
    suite_check_keys(r, json, keys);
    ratio->name = suite_text(r, json, "name", true);
    ratio->of = scene_name(r, json, "of", s);
    ratio->to = scene_name(r, json, "to", s);
}

static void check_only(suite_reader *r, const bench_suite *s)
{
    for (uint32_t i = 0; r->ok && i < s->num_runs; i++) {
        const cJSON *name, *only = s->runs[i].only;
        bool list = !only || (cJSON_IsArray(only) && cJSON_GetArraySize(only) > 0);
        cJSON_ArrayForEach(name, only)
        {
            bool known = false;
            for (uint32_t k = 0; k < s->num_scenes && cJSON_IsString(name); k++) {
                known = known || strcmp(s->scenes[k].name, name->valuestring) == 0;
            }
            list = list && known;
        }
        if (!list) {
            snprintf(r->where, sizeof r->where, "runs: '%.60s'", s->runs[i].name);
            suite_fault(r, "only", "must be a list of names of scenes of this suite, one at least");
        }
    }
    for (uint32_t k = 0; r->ok && k < s->num_scenes; k++) {
        bool any = false;
        for (uint32_t i = 0; i < s->num_runs; i++) {
            any = any || bench_run_is_for(&s->runs[i], &s->scenes[k]);
        }
        if (!any) {
            snprintf(r->where, sizeof r->where, "scenes[%u]", k);
            suite_fault(r, "", "no run is for it");
        }
    }
}

// ---- names ------------------------------------------------------------------------------------

typedef struct bench_name {
    const char *name;
    char **slug;
} bench_name;

enum { MAX_SLUG = 100 };

// "pop, 8 cells" -> "pop-8-cells": letters, digits, dots and dashes. NULL: out of memory.
static char *plain_name(const char *name)
{
    char *slug = text_format("%s", name);
    size_t used = 0;
    for (const char *c = name; slug && *c; c++) {
        bool plain = isalnum((unsigned char)*c) || (*c == '.' && used > 0);
        if (plain) {
            slug[used++] = (char)tolower((unsigned char)*c);
        } else if (used > 0 && slug[used - 1] != '-') {
            slug[used++] = '-';
        }
    }
    used = used < MAX_SLUG ? used : MAX_SLUG; // a file's name may have 255 bytes
    while (slug && used > 0 && slug[used - 1] == '-') {
        used--;
    }
    if (slug) {
        slug[used] = '\0';
    }
    return slug;
}

static bool is_taken(const bench_name *names, uint32_t count, const char *slug)
{
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(*names[i].slug, slug) == 0) {
            return true;
        }
    }
    return false;
}

// "a-b" for "a b", "a-b-2" for "a, b" after it. `kept`: a slug that none may have; `other`: what those are
// called of which nothing plain is left.
static char *slug_of(const bench_name *names, uint32_t index, const char *kept, const char *other)
{
    char *base = plain_name(names[index].name);
    const char *stem = base && base[0] ? base : other;
    char *slug = base ? text_format("%s", stem) : NULL;
    for (uint32_t n = 2; slug && (strcmp(slug, kept) == 0 || is_taken(names, index, slug)); n++) {
        free(slug);
        slug = text_format("%s-%u", stem, n);
    }
    free(base);
    return slug;
}

// Names are what figures are found by, slugs what pictures are: no two share one.
static void name_all(suite_reader *r, const char *list, const bench_name *names, uint32_t count,
                     const char *kept, const char *other)
{
    for (uint32_t i = 0; r->ok && i < count; i++) {
        for (uint32_t k = 0; r->ok && k < i; k++) {
            if (strcmp(names[i].name, names[k].name) == 0) {
                char right[192];
                snprintf(right, sizeof right, "two have the name '%.80s'; give each a \"name\"",
                         names[i].name);
                suite_fault(r, list, right);
            }
        }
        *names[i].slug = slug_of(names, i, kept, other);
        if (!*names[i].slug) {
            suite_fault(r, list, "out of memory");
        }
    }
}

static void name_scenes_and_runs(suite_reader *r, bench_suite *s)
{
    bench_name names[BENCH_MAX_RUNS];
    for (uint32_t i = 0; i < s->num_scenes; i++) {
        names[i] = (bench_name){s->scenes[i].name, &s->scenes[i].slug};
    }
    name_all(r, "scenes", names, s->num_scenes, "", "scene");
    for (uint32_t i = 0; i < s->num_runs; i++) {
        names[i] = (bench_name){s->runs[i].name, &s->runs[i].slug};
    }
    name_all(r, "runs", names, s->num_runs, BENCH_REFERENCE_SLUG, "run");
}

// ---- the suite --------------------------------------------------------------------------------

static void read_peers(suite_reader *r, const char *folder, bench_suite *s)
{
    const cJSON *files = cJSON_GetObjectItemCaseSensitive(s->root, "peers"), *file;
    const int count = cJSON_GetArraySize(files);
    if (files && (!cJSON_IsArray(files) || count > BENCH_MAX_PEERS)) {
        suite_fault(r, "peers", "must be a list of up to 8 names of files");
    }
    cJSON_ArrayForEach(file, files)
    {
        if (r->ok && !cJSON_IsString(file)) {
            suite_fault(r, "peers", "must be a list of up to 8 names of files");
        }
        char *path = r->ok ? suite_find(r, "peers", file->valuestring, folder) : NULL;
        if (path) {
            r->ok = peers_load(r->a, path, s, &s->peers[s->num_peers++]);
        }
    }
}

static void read_suite(suite_reader *r, const char *folder, bench_suite *s)
{
    static const char *const keys[] = {"name",
                                       "about",
                                       "scenes",
                                       "runs",
                                       "baselines",
                                       "block",
                                       "reference_spp",
                                       "frames",
                                       "max_seconds",
                                       "timing_seconds",
                                       "warm_seconds",
                                       "size",
                                       "ratios",
                                       "ceilings",
                                       "references",
                                       "reference_noise",
                                       "reference_seconds",
                                       "peers",
                                       NULL};
    const cJSON *root = s->root;
    suite_check_keys(r, root, keys);
    s->name = suite_text(r, root, "name", true);
    s->about = suite_text(r, root, "about", false);
    s->block = suite_whole(r, root, "block", 8, 2, 1024); // single pixels come beside it
    s->frames = suite_whole(r, root, "frames", 5, 1, 1000);
    s->timing_seconds = (float)suite_number(r, root, "timing_seconds", 5, 0, 86400);
    s->warm_seconds = (float)suite_number(r, root, "warm_seconds", 0, 0, 3600);
    s->max_seconds = (float)suite_number(r, root, "max_seconds", 60, 0, 86400);
    const cJSON *ceilings = cJSON_GetObjectItemCaseSensitive(root, "ceilings");
    s->ceilings = !ceilings || cJSON_IsTrue(ceilings);
    if (ceilings && !cJSON_IsBool(ceilings)) {
        suite_fault(r, "ceilings", "must be true or false");
    }
    s->references = suite_folder(r, root, "references");
    const bench_goal usual = {.spp = DEFAULT_SPP, .seconds = INFINITY};
    scene_defaults defaults = {.goal = read_goal(r, root, &usual)};
    suite_size(r, root, &defaults.size);
    s->num_scenes = suite_list(r, root, "scenes", 1, BENCH_MAX_SCENES);
    for (uint32_t i = 0; i < s->num_scenes; i++) {
        read_scene(r, suite_element(r, root, "scenes", i), &defaults, folder, &s->scenes[i]);
    }
    r->where[0] = '\0';
    const uint32_t runs = suite_list(r, root, "runs", 1, BENCH_MAX_RUNS);
    for (uint32_t i = 0; r->ok && i < runs; i++) {
        read_entry(r, suite_element(r, root, "runs", i), false, i, s);
    }
    r->where[0] = '\0';
    const uint32_t baselines = suite_list(r, root, "baselines", 0, BENCH_MAX_RUNS);
    for (uint32_t i = 0; r->ok && i < baselines; i++) {
        read_entry(r, suite_element(r, root, "baselines", i), true, runs + i, s);
    }
    r->where[0] = '\0';
    s->num_ratios = suite_list(r, root, "ratios", 0, BENCH_MAX_RATIOS);
    for (uint32_t i = 0; i < s->num_ratios; i++) {
        read_ratio(r, suite_element(r, root, "ratios", i), s, &s->ratios[i]);
    }
    r->where[0] = '\0';
    if (r->ok) {
        name_scenes_and_runs(r, s);
        check_only(r, s);
    }
    read_peers(r, folder, s);
}

int bench_suite_load(app *a, const char *path, const char *scenes, bench_suite *suite)
{
    *suite = (bench_suite){0};
    void *data = NULL;
    size_t size = 0;
    if (path) {
        tyn_result result = tyn_file_read(path, 16u << 20, &data, &size, &a->log);
        if (result != TYN_OK) {
            return app_exit_code(a, result, true);
        }
    }
    const char *text = path ? data : bench_default_suite;
    size = path ? size : strlen(bench_default_suite);
    suite_reader r = {.a = a, .file = path ? path : "the suite that is built in", .ok = true};
    suite->file = r.file;
    suite->hash = text_hash(text, size, 0);
    suite->root = suite_parse(&r, text, size);
    if (suite->root) {
        read_suite(&r, scenes, suite);
    }
    free(data);
    return r.ok ? EXIT_DONE : EXIT_WRONG;
}

void bench_suite_finish(bench_suite *suite)
{
    for (uint32_t i = 0; i < BENCH_MAX_SCENES; i++) {
        free(suite->scenes[i].path);
        free(suite->scenes[i].environment);
        free(suite->scenes[i].slug);
        free(suite->scenes[i].reference);
    }
    for (uint32_t i = 0; i < suite->num_runs; i++) {
        free(suite->runs[i].name);
        free(suite->runs[i].slug);
        free(suite->runs[i].defines);
        cJSON_Delete(suite->runs[i].spec);
    }
    for (uint32_t i = 0; i < suite->num_peers; i++) {
        free(suite->peers[i].file);
        cJSON_Delete(suite->peers[i].root);
    }
    free(suite->references);
    cJSON_Delete(suite->root);
    *suite = (bench_suite){0};
}

char *bench_scene_place(const bench_suite *suite, const bench_scene *scene)
{
    return text_format("%s: scenes[%d] '%s'", suite->file, (int)(scene - suite->scenes),
                       scene->name);
}

char *bench_run_place(const bench_suite *suite, const bench_run *run)
{
    const cJSON *runs = cJSON_GetObjectItemCaseSensitive(suite->root, "runs");
    const uint32_t before = run->baseline ? (uint32_t)cJSON_GetArraySize(runs) : 0;
    return text_format("%s: %s[%u] '%s'", suite->file, run->baseline ? "baselines" : "runs",
                       run->entry - before, run->name);
}

char *bench_picture(const bench_scene *scene, const char *slug)
{
    return text_format("pictures/%s/%s.exr", scene->slug, slug);
}

const char *bench_preset(const bench_run *run)
{
    const bool sets =
        cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(run->spec, "settings")) > 0;
    const char *quality = run->method.quality ? run->method.quality : "normal";
    return sets || run->baseline ? NULL : quality;
}

bool bench_run_is_for(const bench_run *run, const bench_scene *scene)
{
    const cJSON *name;
    cJSON_ArrayForEach(name, run->only)
    {
        if (strcmp(name->valuestring, scene->name) == 0) {
            return true;
        }
    }
    return !run->only;
}
