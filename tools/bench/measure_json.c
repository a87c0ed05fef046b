// measure_json.c -- the record of a run that was measured.
#include "measuring.h"
#include "record.h"
#include "stats.h"
#include <math.h>
#include <stdlib.h>
#include <tyndall/io.h>

static cJSON *json_errors(const measuring *m)
{
    cJSON *list = cJSON_CreateArray();
    for (int i = 0; i < BENCH_BLOCKS; i++) {
        const metrics *e = &m->errors[i];
        // What the noise of the reference explains goes; a run's own noise is an error of it. Values that are not
        // finite are left out of all sums: how wrong such a picture is nobody knows.
        const double n = m->c->reference.noise[i];
        cJSON *error = cJSON_CreateObject();
        cJSON_AddNumberToObject(error, "block", m->c->blocks[i]);
        json_add_float(error, "error", e->nan ? NAN : sqrt(fmax(0, e->rel_l1 * e->rel_l1 - n * n)));
        json_add_float(error, "rel_l1", e->rel_l1);
        json_add_float(error, "n", m->c->reference.known_noise ? n : NAN);
        json_add_float(error, "rmse", e->rmse);
        json_add_float(error, "rel_rmse", e->rel_rmse);
        json_add_float(error, "rel_mse", e->rel_mse);
        json_add_float(error, "smape", e->smape);
        json_add_float(error, "bias", e->bias);
        json_add_float(error, "bias_se",
                       m->c->reference.known_noise ? m->c->reference.bias_se : NAN);
        json_add_float(error, "p95", e->p95);
        cJSON_AddNumberToObject(error, "nan", (double)e->nan);
        cJSON_AddItemToArray(list, error);
    }
    // FLIP has no parts that could be taken away: what the noise of the reference gives alone stands beside it.
    cJSON *flip = cJSON_CreateObject();
    cJSON_AddNumberToObject(flip, "block", 0);
    json_add_float(flip, "error", m->flip);
    json_add_float(flip, "n", m->c->reference.known_noise ? m->c->reference.flip_noise : NAN);
    cJSON_AddItemToArray(list, flip);
    return list;
}

// In the picture and, as nodes count such values and put 0 in their place, on the way to it.
static void count_values(const measuring *m, double *non_finite, double *negative)
{
    const size_t num = (size_t)m->view.width * m->view.height;
    *non_finite = *negative = 0;
    for (size_t i = 0; i < 3 * num; i++) {
        *non_finite += !isfinite(m->planes[i]);
        *negative += m->planes[i] < 0;
    }
    const cJSON *node;
    cJSON_ArrayForEach(node, m->nodes)
    {
        const double counted = json_figure(node, "work.non_finite");
        *non_finite += counted > 0 ? counted : 0;
    }
}

static cJSON *json_settings(const measuring *m)
{
    cJSON *settings = cJSON_CreateObject();
    const cJSON *item, *given = cJSON_GetObjectItemCaseSensitive(m->run->spec, "settings");
    cJSON_ArrayForEach(item, given)
    {
        cJSON_AddItemToObject(settings, item->string, cJSON_Duplicate(item, true));
    }
    if (m->run->method.quality) {
        cJSON_AddStringToObject(settings, "quality", m->run->method.quality);
    }
    if (m->method.info.progressive) {
        cJSON_AddNumberToObject(settings, "spp", m->run->method.spp);
    }
    return settings;
}

static cJSON *doubles_or_null(const double *values, bool known)
{
    return known ? cJSON_CreateDoubleArray(values, 3) : cJSON_CreateNull();
}

static void warn_of_nan(measuring *m)
{
    const uint64_t count = m->errors[BENCH_BLOCKS - 1].nan;
    char *text = count ? text_format("%llu values of the picture are not finite: its error is not "
                                     "known, and it is on no front",
                                     (unsigned long long)count)
                       : NULL;
    if (text) {
        app_warn(m->c->a, "%s: %s: %s", m->c->spec->name, m->run->name, text);
        cJSON_AddItemToArray(m->warnings, cJSON_CreateString(text));
    }
    free(text);
}

static int write_picture(measuring *m, cJSON *json)
{
    if (!m->c->folder) {
        cJSON_AddNullToObject(json, "picture");
        return EXIT_DONE;
    }
    char *name = bench_picture(m->c->spec, m->run->slug);
    char *path = name ? text_format("%s/%s", m->c->folder, name) : NULL;
    int code = path ? bench_picture_write(m->c->a, &m->image, false, path)
                    : app_exit_code(m->c->a, TYN_ERR_MEMORY, false);
    cJSON_AddStringToObject(json, "picture", name ? name : "");
    free(name);
    free(path);
    return code;
}

// What is known of every run; `reason` NULL: it was measured.
static cJSON *json_run(const measuring *m, const char *key, const char *reason)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "key", key);
    cJSON_AddStringToObject(json, "method", m->run->method.method);
    cJSON_AddBoolToObject(json, "sampling", m->method.info.progressive);
    record_name_run(json, m->run);
    const char *preset = m->method.info.progressive ? NULL : bench_preset(m->run);
    cJSON_AddItemToObject(json, "preset", preset ? cJSON_CreateString(preset) : cJSON_CreateNull());
    cJSON_AddItemToObject(json, "settings", json_settings(m));
    cJSON_AddItemToObject(json, "all_settings",
                          m->method.settings ? stats_settings(&m->method, &m->view)
                                             : cJSON_CreateObject());
    cJSON_AddNumberToObject(json, "seed", m->view.seed);
    cJSON_AddItemToObject(json, "failed", reason ? cJSON_CreateString(reason) : cJSON_CreateNull());
    return json;
}

static void add_file_hash(cJSON *inputs, const char *name, const char *path)
{
    void *data = NULL;
    size_t size = 0;
    if (path && tyn_file_read(path, UINT64_C(1) << 32, &data, &size, NULL) == TYN_OK) {
        json_add_hash(inputs, name, text_hash(data, size, 0));
    }
    free(data);
}

// All figures, and the picture.
static int add_figures(measuring *m, cJSON *json)
{
    double non_finite = 0, negative = 0;
    count_values(m, &non_finite, &negative);
    json_add_float(json, "fill", m->fill);
    cJSON_AddItemToObject(json, "errors", json_errors(m));
    json_add_float(json, "setup_ms", m->setup_ms);
    cJSON *frame = cJSON_AddObjectToObject(json, "frame_ms");
    cJSON *frames = cJSON_AddObjectToObject(json, "frames");
    for (int i = 0; i < NUM_TIMES; i++) {
        json_add_float(frame, bench_time_names[i], m->ms[i]);
        cJSON_AddNumberToObject(frames, bench_time_names[i], m->frames[i]);
    }
    cJSON *memory = cJSON_AddObjectToObject(json, "memory");
    cJSON_AddNumberToObject(memory, "persistent", (double)m->persistent);
    cJSON_AddNumberToObject(memory, "transient", (double)m->transient);
    cJSON_AddItemToObject(json, "nodes", m->nodes);
    cJSON_AddItemToObject(json, "imbalance", doubles_or_null(m->imbalance, m->has_balance));
    cJSON_AddItemToObject(json, "imbalance_se", doubles_or_null(m->imbalance_se, m->has_balance));
    json_add_float(json, "flicker", m->flicker);
    cJSON_AddNumberToObject(json, "non_finite", non_finite);
    cJSON_AddNumberToObject(json, "negative", negative);
    warn_of_nan(m);
    cJSON_AddItemToObject(json, "warnings", m->warnings);
    m->nodes = m->warnings = NULL;
    // by the names that the suite calls them, wherever they lie
    cJSON *inputs = stats_inputs(&m->c->scene, NULL, 0);
    const cJSON *spec = m->c->spec->json;
    add_file_hash(inputs, json_text(spec, "scene"), m->c->spec->path);
    add_file_hash(inputs, json_text(spec, "environment"), m->c->spec->scene.env);
    add_file_hash(inputs, json_text(spec, "reference"), m->c->spec->reference);
    json_add_hash(inputs, "scene", m->c->hash);
    cJSON_AddItemToObject(json, "inputs", inputs);
    return write_picture(m, json);
}

// The run with what it was measured on and against: all that a citation needs.
static cJSON *make_record(const bench_case *c, const char *key, cJSON *run)
{
    cJSON *record = cJSON_CreateObject();
    cJSON_AddStringToObject(record, "schema", "tyndall-record");
    cJSON_AddNumberToObject(record, "version", BENCH_RECORD_VERSION);
    cJSON_AddStringToObject(record, "key", key);
    cJSON_AddStringToObject(record, "tyndall", tyn_version_string());
    json_add_hash(record, "library", c->machine->library);
    json_add_date(record);
    cJSON_AddStringToObject(record, "suite", c->suite->name);
    cJSON *device = cJSON_AddObjectToObject(record, "device");
    cJSON_AddStringToObject(device, "name", c->machine->name);
    cJSON_AddStringToObject(device, "driver", c->machine->driver);
    cJSON_AddStringToObject(device, "type", c->machine->type);
    cJSON *scene = cJSON_AddObjectToObject(record, "scene");
    cJSON_AddStringToObject(scene, "name", c->spec->name);
    cJSON_AddStringToObject(scene, "file", json_text(c->spec->json, "scene"));
    json_add_hash(scene, "hash", c->hash);
    const int size[2] = {(int)c->view.width, (int)c->view.height};
    cJSON_AddItemToObject(scene, "size", cJSON_CreateIntArray(size, 2));
    cJSON *reference = cJSON_AddObjectToObject(record, "reference");
    cJSON_AddStringToObject(reference, "method",
                            c->spec->reference ? "file" : tyn_method_reference());
    cJSON_AddStringToObject(reference, "key", c->reference.key);
    if (!c->spec->reference) {
        cJSON_AddNumberToObject(reference, "spp", c->reference.spp);
        cJSON_AddNumberToObject(reference, "seed", BENCH_REFERENCE_SEED);
    }
    cJSON_AddItemToObject(record, "run", run);
    return record;
}

int measuring_record(measuring *m, const char *key, const char *reason, cJSON **record)
{
    cJSON *run = json_run(m, key, reason);
    const int code = reason ? EXIT_DONE : add_figures(m, run);
    *record = code == EXIT_DONE ? make_record(m->c, key, run) : NULL;
    if (!*record) {
        cJSON_Delete(run);
    }
    return code;
}
