// suite.c -- what to measure: reads and checks a suite file (docs/bench.md).
#include "suite.h"
#include "bench/suite_default.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>
#include <unistd.h>

// Where a fault is, for the message.
typedef struct reader {
    app *a;
    const char *file;
    char where[128]; // "scenes[2]"
    bool ok;         // false from the first fault on
} reader;

static void fault(reader *r, const char *key, const char *right)
{
    if (r->ok) {
        app_error(r->a, "%s: %s%s%s: %s", r->file, r->where, r->where[0] && key[0] ? "." : "", key,
                  right);
    }
    r->ok = false;
}

// ---- values -----------------------------------------------------------------------------------

static const char *get_text(reader *r, const cJSON *object, const char *key, bool required)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (cJSON_IsString(item)) {
        return item->valuestring;
    }
    if (item || required) {
        fault(r, key, "must be a string");
    }
    return NULL;
}

static double get_number(reader *r, const cJSON *object, const char *key, double def, double min,
                         double max)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (!item) {
        return def;
    }
    // written so that NaN is refused
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= min && item->valuedouble <= max)) {
        char right[96];
        snprintf(right, sizeof right, "must be a number from %g to %g", min, max);
        fault(r, key, right);
        return def;
    }
    return item->valuedouble;
}

static void get_vector(reader *r, const cJSON *object, const char *key, bool spread, opt_vector *v)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (!item) {
        return;
    }
    v->given = true;
    bool number = spread && cJSON_IsNumber(item), array = cJSON_GetArraySize(item) == 3;
    for (int i = 0; i < 3; i++) {
        const cJSON *element = number ? item : cJSON_GetArrayItem(item, i);
        if (!(number || array) || !cJSON_IsNumber(element)) {
            fault(r, key, spread ? "must be three numbers or one" : "must be three numbers");
            return;
        }
        v->v[i] = (float)element->valuedouble;
    }
}

static void get_size(reader *r, const cJSON *object, opt_size *size)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, "size");
    if (!item) {
        return;
    }
    uint32_t *const to[2] = {&size->width, &size->height};
    for (int i = 0; i < 2; i++) {
        const cJSON *element = cJSON_GetArrayItem(item, i);
        if (cJSON_GetArraySize(item) != 2 || !cJSON_IsNumber(element) ||
            !(element->valuedouble >= 1 && element->valuedouble <= 16384)) {
            fault(r, "size", "must be [width, height], 1 to 16384 each");
            return;
        }
        *to[i] = (uint32_t)element->valuedouble;
    }
}

// A mistyped key would be a setting that silently does nothing.
static void check_keys(reader *r, const cJSON *object, const char *const *known)
{
    if (!cJSON_IsObject(object)) {
        fault(r, "", "must be an object");
        return;
    }
    const cJSON *item;
    cJSON_ArrayForEach(item, object)
    {
        const char *const *k = known;
        while (*k && strcmp(*k, item->string) != 0) {
            k++;
        }
        if (!*k) {
            fault(r, item->string, "is not a known key (docs/bench.md lists them)");
        }
    }
}

// ---- scenes -----------------------------------------------------------------------------------

static char *find_file(reader *r, const char *key, const char *name, const char *folder)
{
    const char *slash = strrchr(r->file, '/');
    char *beside = name[0] == '/' ? text_format("%s", name)
                   : slash        ? text_format("%.*s/%s", (int)(slash - r->file), r->file, name)
                                  : text_format("%s", name);
    if (beside && access(beside, R_OK) == 0) {
        return beside;
    }
    free(beside);
    char *sample = folder ? text_format("%s/%s", folder, name) : NULL;
    if (sample && access(sample, R_OK) == 0) {
        return sample;
    }
    free(sample);
    char right[512];
    snprintf(right, sizeof right, "'%s' is neither beside the suite nor in '%s' (--scenes)", name,
             folder ? folder : "");
    fault(r, key, right);
    return NULL;
}

// "pop, 8 cells" -> "pop-8-cells": letters, digits, dots and dashes.
static char *slug_of(const char *name)
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
    while (slug && used > 0 && slug[used - 1] == '-') {
        used--;
    }
    if (slug) {
        slug[used] = '\0';
    }
    return slug;
}

static void read_scene(reader *r, const cJSON *json, const cJSON *defaults, const char *folder,
                       bench_scene *s)
{
    static const char *const keys[] = {
        "name",          "scene",      "environment",   "camera",  "size",      "fov",
        "look_from",     "look_at",    "sigma_s",       "sigma_a", "g",         "albedo",
        "density_scale", "env_rotate", "reference_spp", "lights",  "reference", NULL};
    *s = (bench_scene){.json = json, .scene.env_strength = 1, .scene.frame = NAN};
    check_keys(r, json, keys);
    const char *file = get_text(r, json, "scene", true);
    if (!file) {
        return;
    }
    s->name = get_text(r, json, "name", false);
    s->name = s->name ? s->name : file;
    s->slug = slug_of(s->name);
    s->path = find_file(r, "scene", file, folder);
    s->scene.scene = s->path;
    s->scene.env = get_text(r, json, "environment", false);
    s->scene.env_rotate = (float)get_number(r, json, "env_rotate", 0, -1e6, 1e6);
    s->scene.density_scale = (float)get_number(r, json, "density_scale", NAN, 0, 1e30);
    get_vector(r, json, "sigma_s", true, &s->scene.sigma_s);
    get_vector(r, json, "sigma_a", true, &s->scene.sigma_a);
    get_vector(r, json, "g", true, &s->scene.g);
    get_vector(r, json, "albedo", true, &s->scene.albedo);
    s->lights = (uint32_t)get_number(r, json, "lights", 0, 0, TYN_MAX_LIGHTS);
    s->view.camera = get_text(r, json, "camera", false);
    s->view.fov = (float)get_number(r, json, "fov", NAN, 1e-3, 179.9);
    get_vector(r, json, "look_from", false, &s->view.look_from);
    get_vector(r, json, "look_at", false, &s->view.look_at);
    get_size(r, defaults, &s->view.size);
    get_size(r, json, &s->view.size);
    double spp = get_number(r, defaults, "reference_spp", 1024, 2, 1 << 24);
    s->reference_spp = (uint32_t)get_number(r, json, "reference_spp", spp, 2, 1 << 24);
    const char *reference = get_text(r, json, "reference", false);
    s->reference = reference ? find_file(r, "reference", reference, folder) : NULL;
}

// ---- runs -------------------------------------------------------------------------------------

// {"pass.param": value} -> "pass.param=value" for each, one after the other in run->defines.
static void read_settings(reader *r, const cJSON *settings, bench_run *run)
{
    char *text = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&text, &size);
    if (!memory) {
        fault(r, "settings", "out of memory");
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
            fault(r, item->string, "must be a number, a string or true or false");
        }
        count++;
    }
    fclose(memory);
    run->defines = text;
    if (count > OPT_MAX_LIST) {
        fault(r, "settings", "holds too many parameters");
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
static void apply_value(reader *r, bench_run *run, const char *key, const cJSON *value)
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
        fault(r, "sweep", "out of memory");
    }
}

// The run that `spec` describes; spec has no sweep any more.
static void read_one(reader *r, bench_run *run)
{
    const cJSON *json = run->spec;
    run->method.quality = get_text(r, json, "quality", false);
    run->method.spp = (uint32_t)get_number(r, json, "spp", 64, 1, 1 << 24);
    run->method.seed = (uint32_t)get_number(r, json, "seed", 0, 0, 4294967295.0);
    const cJSON *settings = cJSON_GetObjectItemCaseSensitive(json, "settings");
    if (settings && !cJSON_IsObject(settings)) {
        fault(r, "settings", "must be an object of \"pass.param\": value");
    } else if (settings) {
        read_settings(r, settings, run);
    }
    run->slug = run->name ? slug_of(run->name) : NULL;
}

// One entry of `runs` or `baselines`: as many runs as its sweep has combinations of values.
static void read_entry(reader *r, const cJSON *json, bool baseline, uint32_t entry, bench_suite *s)
{
    static const char *const keys[] = {"name", "method", "quality", "settings", "spp",
                                       "seed", "group",  "sweep",   "only",     NULL};
    check_keys(r, json, keys);
    const char *how = get_text(r, json, "method", false);
    how = how ? how : baseline ? "path" : "pop";
    const char *name = get_text(r, json, "name", false);
    name = name ? name : how;
    const char *group = get_text(r, json, "group", false);
    const cJSON *only = cJSON_GetObjectItemCaseSensitive(json, "only");
    const cJSON *sweep = cJSON_GetObjectItemCaseSensitive(json, "sweep"), *axis;
    cJSON *own = NULL;
    if (baseline && !sweep && !cJSON_GetObjectItemCaseSensitive(json, "spp")) {
        sweep = own = cJSON_Parse("{\"spp\": [1, 4, 16, 64, 256, 1024, 4096]}");
    }
    uint32_t count = 1, num_axes = 0;
    if (sweep && !cJSON_IsObject(sweep)) {
        fault(r, "sweep", "must be an object of \"pass.param\": [values]");
        sweep = NULL;
    }
    cJSON_ArrayForEach(axis, sweep)
    {
        int values = cJSON_IsArray(axis) ? cJSON_GetArraySize(axis) : 0;
        if (values < 1 || values > BENCH_MAX_RUNS || ++num_axes > BENCH_MAX_SWEEP) {
            fault(r, "sweep", "must hold up to 4 lists of values");
            break;
        }
        count *= (uint32_t)values;
        count = count > BENCH_MAX_RUNS ? BENCH_MAX_RUNS + 1 : count;
    }
    if (s->num_runs + count > BENCH_MAX_RUNS) {
        fault(r, "sweep", "gives more than 256 runs in all");
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

static uint32_t array_size(reader *r, const cJSON *root, const char *key, uint32_t min,
                           uint32_t max)
{
    const cJSON *array = cJSON_GetObjectItemCaseSensitive(root, key);
    int count = cJSON_GetArraySize(array);
    if ((array && !cJSON_IsArray(array)) || count < (int)min || count > (int)max) {
        char right[64];
        snprintf(right, sizeof right, "must be a list of %u to %u objects", min, max);
        fault(r, key, right);
        return 0;
    }
    return (uint32_t)count;
}

static const cJSON *element(reader *r, const cJSON *root, const char *key, uint32_t index)
{
    snprintf(r->where, sizeof r->where, "%s[%u]", key, index);
    return cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(root, key), (int)index);
}

// ---- the suite --------------------------------------------------------------------------------

static const char *scene_name(reader *r, const cJSON *json, const char *key, const bench_suite *s)
{
    const char *name = get_text(r, json, key, true);
    for (uint32_t i = 0; name && i < s->num_scenes; i++) {
        if (s->scenes[i].name && strcmp(s->scenes[i].name, name) == 0) {
            return name;
        }
    }
    fault(r, key, "must be the name of a scene of this suite");
    return NULL;
}

static void read_ratio(reader *r, const cJSON *json, const bench_suite *s, bench_ratio *ratio)
{
    static const char *const keys[] = {"name", "of", "to", NULL};
    check_keys(r, json, keys);
    ratio->name = get_text(r, json, "name", true);
    ratio->of = scene_name(r, json, "of", s);
    ratio->to = scene_name(r, json, "to", s);
}

static void check_only(reader *r, const bench_suite *s)
{
    for (uint32_t i = 0; r->ok && i < s->num_runs; i++) {
        const cJSON *name;
        bool list = !s->runs[i].only || cJSON_IsArray(s->runs[i].only);
        cJSON_ArrayForEach(name, s->runs[i].only)
        {
            bool known = false;
            for (uint32_t k = 0; k < s->num_scenes && cJSON_IsString(name); k++) {
                known = known || strcmp(s->scenes[k].name, name->valuestring) == 0;
            }
            list = list && known;
        }
        if (!list) {
            snprintf(r->where, sizeof r->where, "runs: '%.60s'", s->runs[i].name);
            fault(r, "only", "must be a list of names of scenes of this suite");
        }
    }
}

// Names are what figures are found by, slugs what pictures are.
static void check_names(reader *r, const bench_suite *s)
{
    r->where[0] = '\0';
    for (uint32_t i = 0; r->ok && i < s->num_scenes; i++) {
        for (uint32_t k = 0; r->ok && k < i; k++) {
            if (!s->scenes[i].slug || strcmp(s->scenes[i].slug, s->scenes[k].slug) == 0) {
                char right[192];
                snprintf(right, sizeof right, "two have the name '%.80s'; give each a \"name\"",
                         s->scenes[i].name);
                fault(r, "scenes", right);
            }
        }
    }
    for (uint32_t i = 0; r->ok && i < s->num_runs; i++) {
        for (uint32_t k = 0; r->ok && k < i; k++) {
            if (!s->runs[i].slug || strcmp(s->runs[i].slug, s->runs[k].slug) == 0) {
                char right[192];
                snprintf(right, sizeof right, "two have the name '%.80s'; give each a \"name\"",
                         s->runs[i].name);
                fault(r, "runs", right);
            }
        }
    }
}

static void read_suite(reader *r, const char *folder, bench_suite *s)
{
    static const char *const keys[] = {
        "name",   "about",       "scenes",         "runs", "baselines", "block",    "reference_spp",
        "frames", "max_seconds", "timing_seconds", "size", "ratios",    "ceilings", NULL};
    const cJSON *root = s->root;
    check_keys(r, root, keys);
    s->name = get_text(r, root, "name", true);
    s->about = get_text(r, root, "about", false);
    s->block = (uint32_t)get_number(r, root, "block", 8, 1, 1024);
    s->frames = (uint32_t)get_number(r, root, "frames", 5, 1, 1000);
    s->timing_seconds = (float)get_number(r, root, "timing_seconds", 5, 0, 86400);
    s->max_seconds = (float)get_number(r, root, "max_seconds", 60, 0, 86400);
    const cJSON *ceilings = cJSON_GetObjectItemCaseSensitive(root, "ceilings");
    s->ceilings = !ceilings || cJSON_IsTrue(ceilings);
    if (ceilings && !cJSON_IsBool(ceilings)) {
        fault(r, "ceilings", "must be true or false");
    }
    s->num_scenes = array_size(r, root, "scenes", 1, BENCH_MAX_SCENES);
    for (uint32_t i = 0; i < s->num_scenes; i++) {
        read_scene(r, element(r, root, "scenes", i), root, folder, &s->scenes[i]);
    }
    r->where[0] = '\0';
    const uint32_t runs = array_size(r, root, "runs", 1, BENCH_MAX_RUNS);
    for (uint32_t i = 0; r->ok && i < runs; i++) {
        read_entry(r, element(r, root, "runs", i), false, i, s);
    }
    r->where[0] = '\0';
    const uint32_t baselines = array_size(r, root, "baselines", 0, BENCH_MAX_RUNS);
    for (uint32_t i = 0; r->ok && i < baselines; i++) {
        read_entry(r, element(r, root, "baselines", i), true, runs + i, s);
    }
    r->where[0] = '\0';
    s->num_ratios = array_size(r, root, "ratios", 0, BENCH_MAX_RATIOS);
    for (uint32_t i = 0; i < s->num_ratios; i++) {
        read_ratio(r, element(r, root, "ratios", i), s, &s->ratios[i]);
    }
    check_only(r, s);
    check_names(r, s);
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
    reader r = {.a = a, .file = path ? path : "the suite that is built in", .ok = true};
    suite->hash = text_hash(text, size, 0);
    suite->root = cJSON_ParseWithLength(text, size);
    if (suite->root) {
        read_suite(&r, scenes, suite);
    } else {
        const char *at = cJSON_GetErrorPtr();
        int line = 1;
        for (const char *c = text; at && c < at && c < text + size; c++) {
            line += *c == '\n';
        }
        app_error(a, "%s:%d: is not JSON from here on", r.file, line);
        r.ok = false;
    }
    free(data);
    return r.ok ? EXIT_DONE : EXIT_WRONG;
}

void bench_suite_finish(bench_suite *suite)
{
    for (uint32_t i = 0; i < BENCH_MAX_SCENES; i++) {
        free(suite->scenes[i].path);
        free(suite->scenes[i].slug);
        free(suite->scenes[i].reference);
    }
    for (uint32_t i = 0; i < suite->num_runs; i++) {
        free(suite->runs[i].name);
        free(suite->runs[i].slug);
        free(suite->runs[i].defines);
        cJSON_Delete(suite->runs[i].spec);
    }
    cJSON_Delete(suite->root);
    *suite = (bench_suite){0};
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
