// measure.c -- one run on one scene: errors, times, nodes, memory, imbalance, flicker, as a record.
#include "measure.h"
#include "flicker.h"
#include "record.h"
#include "renderer.h"
#include "stats.h"
#include "timing.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_NODES = 64, FLICKER_FRAMES = 8, BALANCE_SAMPLES = 16 };
static const double flicker_step = 0.1 * 3.14159265358979323846 / 180; // of the camera, a frame

// A run that is being measured. Times are NAN where they were not measured.
typedef struct measuring {
    bench_case *c;
    const bench_run *run;
    method method;
    renderer renderer;
    tyn_view view;
    float *planes; // 6 w h: the picture
    metrics_image image;
    metrics errors[BENCH_BLOCKS];
    double fill, setup_ms, cold_ms, camera_ms, unchanged_ms;
    uint64_t persistent, transient;
    cJSON *nodes, *warnings; // NULL until they are known
    uint32_t num_nodes;
    double node_ms[MAX_NODES];
    double flicker, imbalance[3], imbalance_se[3];
    bool has_balance;
} measuring;

// ---- the picture ------------------------------------------------------------------------------

static int take_picture(measuring *m)
{
    bench_planes(m->renderer.offline, &m->view, m->planes, &m->image);
    for (int i = 0; i < BENCH_BLOCKS; i++) {
        if (metrics_compare(&m->image, &m->c->reference.image, m->c->blocks[i], &m->errors[i]) !=
            METRICS_OK) {
            app_error(m->c->a, "%s: the reference is black; nothing can be relative to it",
                      m->c->spec->name);
            return EXIT_WRONG;
        }
    }
    // Transmittance below 0.99 is medium.
    const float *t = tyn_offline_output(m->renderer.offline, TYN_OUTPUT_TRANSMITTANCE);
    const size_t num = (size_t)m->view.width * m->view.height;
    size_t filled = 0;
    for (size_t i = 0; t && i < num; i++) {
        filled += t[4 * i] + t[4 * i + 1] + t[4 * i + 2] < 3 * 0.99f;
    }
    m->fill = t ? (double)filled / (double)num : NAN;
    return EXIT_DONE;
}

static cJSON *json_errors(const measuring *m)
{
    cJSON *list = cJSON_CreateArray();
    for (int i = 0; i < BENCH_BLOCKS; i++) {
        const metrics *e = &m->errors[i];
        // What the noise of the reference explains goes; a run's own noise is an error of it.
        const double n = m->c->reference.noise[i];
        cJSON *error = cJSON_CreateObject();
        cJSON_AddNumberToObject(error, "block", m->c->blocks[i]);
        json_add_float(error, "error", sqrt(fmax(0, e->rel_l1 * e->rel_l1 - n * n)));
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
    return list;
}

static void count_values(const measuring *m, double *non_finite, double *negative)
{
    const size_t num = (size_t)m->view.width * m->view.height;
    *non_finite = *negative = 0;
    for (size_t i = 0; i < 3 * num; i++) {
        *non_finite += !isfinite(m->planes[i]);
        *negative += m->planes[i] < 0;
    }
}

// ---- nodes ------------------------------------------------------------------------------------

static cJSON *json_node(const tyn_node_report *n)
{
    cJSON *node = cJSON_CreateObject(), *work = cJSON_CreateObject();
    const node_work w = node_work_of(n);
    cJSON_AddStringToObject(node, "name", n->name);
    cJSON_AddBoolToObject(node, "setup", n->media_only);
    cJSON_AddNumberToObject(node, "dispatches", n->dispatches);
    cJSON_AddNumberToObject(node, "memory", (double)n->bytes);
    json_add_float(node, "bytes", w.bytes > 0 ? w.bytes : NAN);
    json_add_float(node, "flops", w.flops > 0 ? w.flops : NAN);
    for (uint32_t k = 0; k < n->num_work; k++) {
        cJSON_AddNumberToObject(work, n->work[k].name, n->work[k].amount);
    }
    cJSON_AddItemToObject(node, "work", work);
    return node;
}

// Nodes, memory and warnings of the last frame; times of nodes into `times`.
static void take_report(measuring *m, double times[MAX_NODES])
{
    tyn_report report = {0};
    tyn_offline_report(m->renderer.offline, &report);
    m->persistent = report.persistent_bytes;
    m->transient = report.transient_bytes;
    m->num_nodes = report.num_nodes < MAX_NODES ? report.num_nodes : MAX_NODES;
    cJSON_Delete(m->nodes);
    cJSON_Delete(m->warnings);
    m->nodes = cJSON_CreateArray();
    m->warnings = cJSON_CreateArray();
    for (uint32_t i = 0; i < m->num_nodes; i++) {
        times[i] = report.nodes[i].gpu_ms;
        cJSON_AddItemToArray(m->nodes, json_node(&report.nodes[i]));
    }
    const tyn_scene *scene = &m->c->scene;
    for (uint32_t i = 0; i < scene->num_warnings; i++) {
        cJSON_AddItemToArray(m->warnings, cJSON_CreateString(scene->warnings[i]));
    }
    for (uint32_t i = 0; i < report.num_warnings; i++) {
        cJSON_AddItemToArray(m->warnings, cJSON_CreateString(report.warnings[i]));
    }
    for (size_t i = 0; i < ARRAY_SIZE(m->renderer.warnings); i++) {
        if (m->renderer.warnings[i]) {
            cJSON_AddItemToArray(m->warnings, cJSON_CreateString(m->renderer.warnings[i]));
        }
    }
}

// Times of nodes, and the ceilings that bind them, into what take_report has made.
static void finish_nodes(measuring *m)
{
    tyn_report report = {0};
    tyn_offline_report(m->renderer.offline, &report);
    uint32_t i = 0;
    cJSON *node;
    cJSON_ArrayForEach(node, m->nodes)
    {
        node_work work = {.gpu_ms = m->node_ms[i],
                          .flops = json_figure(node, "flops"),
                          .bytes = json_figure(node, "bytes"),
                          .dispatches = (uint32_t)json_figure(node, "dispatches")};
        if (i < report.num_nodes) {
            work = node_work_of(&report.nodes[i]);
            work.gpu_ms = m->node_ms[i];
        }
        double fraction = NAN;
        const char *ceiling = ceilings_bind(&m->c->machine->ceilings, &work, &fraction);
        json_add_float(node, "gpu_ms", m->node_ms[i]);
        cJSON_AddItemToObject(node, "ceiling",
                              ceiling ? cJSON_CreateString(ceiling) : cJSON_CreateNull());
        json_add_float(node, "fraction", fraction);
        i++;
    }
}

// Which nodes a moved camera leaves alone.
static void take_states(measuring *m)
{
    tyn_report report = {0};
    tyn_offline_report(m->renderer.offline, &report);
    uint32_t i = 0;
    cJSON *node;
    cJSON_ArrayForEach(node, m->nodes)
    {
        cJSON_AddStringToObject(node, "state_after_camera_moved",
                                i < report.num_nodes ? report.nodes[i].state : "");
        i++;
    }
}

// ---- times ------------------------------------------------------------------------------------

static bool go_on(double start, uint32_t done, uint32_t least, uint32_t most, double seconds)
{
    return done < least || (done < most && app_seconds() - start < seconds);
}

// Cold frames: medians of the whole and of every node.
static int time_cold(measuring *m)
{
    const bench_suite *suite = m->c->suite;
    const uint32_t most = suite->frames;
    double *whole = calloc(most, sizeof *whole);
    double *nodes = calloc((size_t)most * MAX_NODES, sizeof *nodes);
    int code = whole && nodes ? EXIT_DONE : app_exit_code(m->c->a, TYN_ERR_MEMORY, false);
    uint32_t done = 0;
    const double start = app_seconds();
    while (code == EXIT_DONE && go_on(start, done, 1, most, suite->timing_seconds)) {
        code = renderer_frame(m->c->a, &m->renderer, &m->c->scene, &m->view, true, NULL);
        if (code == EXIT_DONE) {
            double times[MAX_NODES] = {0};
            take_report(m, times);
            for (uint32_t k = 0; k < m->num_nodes; k++) {
                nodes[k * most + done] = times[k];
            }
            whole[done++] = m->renderer.frame_ms;
        }
    }
    if (code == EXIT_DONE) {
        m->cold_ms = timing_median(whole, done);
        for (uint32_t k = 0; k < m->num_nodes; k++) {
            m->node_ms[k] = timing_median(nodes + k * most, done);
        }
        finish_nodes(m);
    }
    free(whole);
    free(nodes);
    return code;
}

// The camera turns by a little from frame to frame: times, and flicker. Of a method that samples every frame
// has samples of its own, as it would have in a film.
static int time_camera(measuring *m, uint32_t least, double seconds)
{
    const uint32_t most =
        m->c->suite->frames > FLICKER_FRAMES ? m->c->suite->frames : FLICKER_FRAMES;
    double *times = calloc(most, sizeof *times);
    flicker f;
    int code = flicker_open(&f, m->view.width, m->view.height) && times
                   ? EXIT_DONE
                   : app_exit_code(m->c->a, TYN_ERR_MEMORY, false);
    tyn_view view = m->view;
    uint32_t done = 0;
    const double start = app_seconds();
    while (code == EXIT_DONE && go_on(start, done, least, most, seconds)) {
        timing_turn_camera(&m->c->scene, &view.camera, flicker_step);
        view.seed += m->method.info.progressive;
        code = renderer_frame(m->c->a, &m->renderer, &m->c->scene, &view, false, NULL);
        if (code == EXIT_DONE) {
            times[done++] = m->renderer.frame_ms;
            flicker_add(&f, tyn_offline_output(m->renderer.offline, TYN_OUTPUT_RADIANCE));
        }
    }
    if (code == EXIT_DONE) {
        m->camera_ms = timing_median(times, done);
        m->flicker = flicker_value(&f);
    }
    flicker_close(&f);
    free(times);
    return code;
}

static int time_unchanged(measuring *m)
{
    const bench_suite *suite = m->c->suite;
    double *times = calloc(suite->frames, sizeof *times);
    int code = times ? EXIT_DONE : app_exit_code(m->c->a, TYN_ERR_MEMORY, false);
    // what the camera left is put right first
    code = code == EXIT_DONE
               ? renderer_frame(m->c->a, &m->renderer, &m->c->scene, &m->view, false, NULL)
               : code;
    uint32_t done = 0;
    const double start = app_seconds();
    while (code == EXIT_DONE && go_on(start, done, 1, suite->frames, suite->timing_seconds)) {
        code = renderer_frame(m->c->a, &m->renderer, &m->c->scene, &m->view, false, NULL);
        times[done] = m->renderer.frame_ms;
        done += code == EXIT_DONE;
    }
    if (code == EXIT_DONE) {
        m->unchanged_ms = timing_median(times, done);
    }
    free(times);
    return code;
}

// ---- the energy -------------------------------------------------------------------------------

// As `tyndall balance`: a frame of its own. A sample of `path` is some ten thousand paths there, so that as many
// are taken as time allows.
static int measure_balance(measuring *m)
{
    tyn_view view = {.width = 1, .height = 1, .outputs = TYN_OUTPUT_BALANCE};
    if (!(m->method.info.outputs & TYN_OUTPUT_BALANCE)) {
        return EXIT_DONE;
    }
    tyn_camera_frame_scene(&view.camera, &m->c->scene);
    method_view(&m->run->method, &view);
    if (m->method.info.progressive) {
        const double paths = (double)m->view.width * m->view.height * m->view.num_samples;
        const double sample_ms = 2e4 * m->cold_ms / paths;
        const double affordable = 1e3 * m->c->suite->timing_seconds / sample_ms;
        view.num_samples = (uint32_t)fmin(fmin(view.num_samples, BALANCE_SAMPLES), affordable);
        if (view.num_samples < 1) {
            return EXIT_DONE;
        }
    }
    renderer r = {0};
    int code = renderer_open(m->c->a, m->c->machine->device, &m->method, &r);
    if (code == EXIT_DONE) {
        code = renderer_frame(m->c->a, &r, &m->c->scene, &view, false, NULL);
    }
    const tyn_balance *balance =
        code == EXIT_DONE ? tyn_offline_output(r.offline, TYN_OUTPUT_BALANCE) : NULL;
    if (balance) {
        m->has_balance = true;
        memcpy(m->imbalance, balance->imbalance, sizeof m->imbalance);
        memcpy(m->imbalance_se, balance->imbalance_se, sizeof m->imbalance_se);
    }
    renderer_close(&r);
    return code == EXIT_WRONG ? EXIT_DONE : code; // there is no balance of such a scene
}

// ---- a run ------------------------------------------------------------------------------------

static int open_run(measuring *m)
{
    app *a = m->c->a;
    int code = method_open(a, &m->run->method, &m->method);
    if (code == EXIT_DONE) {
        code = renderer_open(a, m->c->machine->device, &m->method, &m->renderer);
    }
    m->view = m->c->view;
    method_view(&m->run->method, &m->view);
    m->planes = malloc(6 * sizeof *m->planes * m->view.width * m->view.height);
    if (!m->planes) {
        code = app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    return code;
}

static void close_run(measuring *m)
{
    renderer_close(&m->renderer);
    method_finish(&m->method);
    cJSON_Delete(m->nodes);
    cJSON_Delete(m->warnings);
    free(m->planes);
}

// A method whose frame is done when it is done.
static int measure_frames(measuring *m, const char *label)
{
    app *a = m->c->a;
    // The picture, with the layers that tell how much of it the medium fills.
    m->view.outputs = TYN_OUTPUT_RADIANCE | (m->method.info.outputs & TYN_OUTPUT_TRANSMITTANCE);
    int code = renderer_frame(a, &m->renderer, &m->c->scene, &m->view, false, label);
    m->setup_ms = m->renderer.setup_ms;
    if (code == EXIT_DONE) {
        code = take_picture(m);
    }
    m->view.outputs = TYN_OUTPUT_RADIANCE;
    if (code == EXIT_DONE) { // allocates for these outputs
        code = renderer_frame(a, &m->renderer, &m->c->scene, &m->view, true, NULL);
    }
    if (code == EXIT_DONE) {
        code = time_cold(m);
    }
    if (code == EXIT_DONE) {
        code = time_camera(m, 3, m->c->suite->timing_seconds);
    }
    if (code == EXIT_DONE) {
        take_states(m);
        code = time_unchanged(m);
    }
    return code;
}

// A method that samples: a frame is the whole rendering of its samples.
static int measure_samples(measuring *m, const char *label)
{
    app *a = m->c->a;
    const uint32_t spp = m->view.num_samples;
    const double seconds = m->c->suite->timing_seconds;
    m->view.outputs = TYN_OUTPUT_RADIANCE | (m->method.info.outputs & TYN_OUTPUT_ERROR);
    m->view.num_samples = 1; // pipelines and memory
    int code = renderer_frame(a, &m->renderer, &m->c->scene, &m->view, false, NULL);
    m->setup_ms = m->renderer.setup_ms;
    m->view.num_samples = spp;
    if (code == EXIT_DONE) {
        code = renderer_frame(a, &m->renderer, &m->c->scene, &m->view, true, label);
    }
    if (code == EXIT_DONE) {
        m->cold_ms = m->renderer.frame_ms;
        take_report(m, m->node_ms);
        code = take_picture(m);
    }
    // Short ones again: a first millisecond is noise.
    if (code == EXIT_DONE && m->cold_ms < 0.2e3 * seconds) {
        code = time_cold(m);
    } else if (code == EXIT_DONE) {
        finish_nodes(m);
    }
    if (code == EXIT_DONE && 3e-3 * m->cold_ms < seconds) {
        code = time_camera(m, 3, seconds);
        m->camera_ms = NAN; // that of the whole rendering
    }
    return code;
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

static int write_picture(measuring *m, cJSON *json)
{
    if (!m->c->folder) {
        cJSON_AddNullToObject(json, "picture");
        return EXIT_DONE;
    }
    char *name = text_format("pictures/%s/%s.exr", m->c->spec->slug, m->run->slug);
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
    cJSON_AddStringToObject(json, "name", m->run->name);
    cJSON_AddStringToObject(json, "method", m->run->method.method);
    cJSON_AddStringToObject(json, "group", m->run->group);
    cJSON_AddBoolToObject(json, "sampling", m->method.info.progressive);
    cJSON_AddBoolToObject(json, "baseline", m->run->baseline);
    cJSON_AddBoolToObject(json, "swept", m->run->swept);
    cJSON_AddItemToObject(json, "spec", cJSON_Duplicate(m->run->spec, true));
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

static int add_figures(measuring *m, cJSON *json)
{
    double non_finite = 0, negative = 0;
    count_values(m, &non_finite, &negative);
    json_add_float(json, "fill", m->fill);
    cJSON_AddItemToObject(json, "errors", json_errors(m));
    json_add_float(json, "setup_ms", m->setup_ms);
    cJSON *frame = cJSON_AddObjectToObject(json, "frame_ms");
    json_add_float(frame, "cold", m->cold_ms);
    json_add_float(frame, "camera_moved", m->camera_ms);
    json_add_float(frame, "unchanged", m->unchanged_ms);
    cJSON *memory = cJSON_AddObjectToObject(json, "memory");
    cJSON_AddNumberToObject(memory, "persistent", (double)m->persistent);
    cJSON_AddNumberToObject(memory, "transient", (double)m->transient);
    cJSON_AddItemToObject(json, "nodes", m->nodes);
    cJSON_AddItemToObject(json, "imbalance", doubles_or_null(m->imbalance, m->has_balance));
    cJSON_AddItemToObject(json, "imbalance_se", doubles_or_null(m->imbalance_se, m->has_balance));
    json_add_float(json, "flicker", m->flicker);
    cJSON_AddNumberToObject(json, "non_finite", non_finite);
    cJSON_AddNumberToObject(json, "negative", negative);
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
    cJSON_AddStringToObject(reference, "method", c->spec->reference ? "file" : "path");
    cJSON_AddStringToObject(reference, "key", c->reference.key);
    if (!c->spec->reference) {
        cJSON_AddNumberToObject(reference, "spp", c->spec->reference_spp);
        cJSON_AddNumberToObject(reference, "seed", BENCH_REFERENCE_SEED);
    }
    cJSON_AddItemToObject(record, "run", run);
    return record;
}

int bench_measure(bench_case *c, const bench_run *run, const char *key, cJSON **record)
{
    measuring m = {.c = c,
                   .run = run,
                   .fill = NAN,
                   .setup_ms = NAN,
                   .cold_ms = NAN,
                   .camera_ms = NAN,
                   .unchanged_ms = NAN,
                   .flicker = NAN};
    char label[192];
    snprintf(label, sizeof label, "%.80s: %.80s", c->spec->name, run->name);
    *record = NULL;
    int code = open_run(&m);
    bool opened = code == EXIT_DONE;
    if (opened) {
        code = m.method.info.progressive ? measure_samples(&m, label) : measure_frames(&m, label);
    }
    if (code == EXIT_DONE) {
        code = measure_balance(&m);
    }
    if (code == EXIT_DONE) {
        cJSON *json = json_run(&m, key, NULL);
        code = add_figures(&m, json);
        *record = make_record(c, key, json);
    } else if (opened && code != EXIT_INTERRUPTED) { // this method cannot do this scene; others may
        *record = make_record(c, key, json_run(&m, key, c->a->last_error));
        code = code == EXIT_WRONG ? EXIT_DONE : code;
    }
    close_run(&m);
    return code;
}
