// suite.c -- what to measure: reads and checks a suite file (docs/bench.md).
#include "suite.h"
#include "bench/suite_default.h"
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

static char *find_scene(reader *r, const char *name, const char *folder)
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
    fault(r, "scene", right);
    return NULL;
}

static void read_scene(reader *r, const cJSON *json, const cJSON *defaults, const char *folder,
                       bench_scene *s)
{
    static const char *const keys[] = {
        "name",          "scene",      "environment",   "camera",  "size", "fov",
        "look_from",     "look_at",    "sigma_s",       "sigma_a", "g",    "albedo",
        "density_scale", "env_rotate", "reference_spp", "lights",  NULL};
    *s = (bench_scene){.json = json, .scene.env_strength = 1};
    check_keys(r, json, keys);
    const char *file = get_text(r, json, "scene", true);
    if (!file) {
        return;
    }
    s->name = get_text(r, json, "name", false);
    s->name = s->name ? s->name : file;
    s->path = find_scene(r, file, folder);
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

static void read_run(reader *r, const cJSON *json, const char *def_method, bench_run *run)
{
    static const char *const keys[] = {"name", "method", "quality", "settings", "spp", NULL};
    *run = (bench_run){.json = json};
    check_keys(r, json, keys);
    run->method.method = get_text(r, json, "method", false);
    run->method.method = run->method.method ? run->method.method : def_method;
    run->method.quality = get_text(r, json, "quality", false);
    run->method.spp = (uint32_t)get_number(r, json, "spp", 64, 1, 1 << 24);
    run->name = get_text(r, json, "name", false);
    run->name = run->name ? run->name : run->method.method;
    const cJSON *settings = cJSON_GetObjectItemCaseSensitive(json, "settings");
    if (settings && !cJSON_IsObject(settings)) {
        fault(r, "settings", "must be an object of \"pass.param\": value");
    } else if (settings) {
        read_settings(r, settings, run);
    }
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

static void read_suite(reader *r, const char *folder, bench_suite *s)
{
    static const char *const keys[] = {
        "name",   "about",     "scenes",      "runs", "baselines", "block", "reference_spp",
        "frames", "pilot_spp", "max_seconds", "size", "ratios",    NULL};
    const cJSON *root = s->root;
    check_keys(r, root, keys);
    s->name = get_text(r, root, "name", true);
    s->block = (uint32_t)get_number(r, root, "block", 8, 1, 1024);
    s->frames = (uint32_t)get_number(r, root, "frames", 5, 1, 1000);
    s->pilot_spp = (uint32_t)get_number(r, root, "pilot_spp", 16, 2, 65536);
    s->max_seconds = (float)get_number(r, root, "max_seconds", 60, 0, 86400);
    s->num_scenes = array_size(r, root, "scenes", 1, BENCH_MAX_SCENES);
    for (uint32_t i = 0; i < s->num_scenes; i++) {
        read_scene(r, element(r, root, "scenes", i), root, folder, &s->scenes[i]);
    }
    r->where[0] = '\0';
    s->num_runs = array_size(r, root, "runs", 1, BENCH_MAX_RUNS);
    for (uint32_t i = 0; i < s->num_runs; i++) {
        read_run(r, element(r, root, "runs", i), "pop", &s->runs[i]);
    }
    r->where[0] = '\0';
    s->num_baselines = array_size(r, root, "baselines", 0, BENCH_MAX_BASELINES);
    for (uint32_t i = 0; i < s->num_baselines; i++) {
        read_run(r, element(r, root, "baselines", i), "path", &s->baselines[i]);
    }
    r->where[0] = '\0';
    s->num_ratios = array_size(r, root, "ratios", 0, BENCH_MAX_RATIOS);
    for (uint32_t i = 0; i < s->num_ratios; i++) {
        read_ratio(r, element(r, root, "ratios", i), s, &s->ratios[i]);
    }
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
    for (uint32_t i = 0; i < suite->num_scenes; i++) {
        free(suite->scenes[i].path);
    }
    for (uint32_t i = 0; i < suite->num_runs; i++) {
        free(suite->runs[i].defines);
    }
    for (uint32_t i = 0; i < suite->num_baselines; i++) {
        free(suite->baselines[i].defines);
    }
    cJSON_Delete(suite->root);
    *suite = (bench_suite){0};
}
