// measure.c -- one run on one scene: errors, times, nodes, memory, imbalance, flicker, as a record.
#include "measuring.h"
#include "flicker.h"
#include "flip.h"
#include "json.h"
#include "stats.h"
#include "timing.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FLICKER_FRAMES = 8, BALANCE_SAMPLES = 16 };
static const double flicker_step = 0.1 * 3.14159265358979323846 / 180; // of the camera, a frame

// ---- the picture ------------------------------------------------------------------------------

static int take_picture(measuring *m)
{
    bench_planes(m->renderer.offline, &m->view, m->planes, &m->image);
    for (int i = 0; i < BENCH_BLOCKS; i++) {
        if (metrics_compare(&m->image, &m->c->reference.image, m->c->blocks[i], &m->errors[i]) !=
            METRICS_OK) {
            app_error(m->c->a,
                      m->errors[i].nan
                          ? "%s: too few values of the picture are finite"
                          : "%s: the reference is black; nothing can be relative to it",
                      m->c->spec->name);
            return EXIT_WRONG;
        }
    }
    float scale;
    if (!flip_scale(&m->c->reference.image, &scale) ||
        !flip_ldr(&m->image, &m->c->reference.image, scale, NULL, &m->flip)) {
        return app_exit_code(m->c->a, TYN_ERR_MEMORY, false);
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

// ---- nodes ------------------------------------------------------------------------------------

static cJSON *json_node(const tyn_node_report *n)
{
    cJSON *node = cJSON_CreateObject(), *work = cJSON_CreateObject();
    const node_work w = node_work_of(n);
    cJSON_AddStringToObject(node, "name", n->name);
    cJSON_AddBoolToObject(node, "setup", n->media_only);
    cJSON_AddNumberToObject(node, "dispatches", n->dispatches);
    cJSON_AddNumberToObject(node, "memory", (double)n->bytes);
    cJSON_AddNumberToObject(node, "shared_memory", (double)n->shared_bytes);
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

// Renders the next frame of a kind; what it does beside its time is its own.
typedef int (*frame_of)(measuring *m, void *state);

// Times frames of a kind for `seconds`, `least` and `most` of them, into their median. Gives the exit code.
static int time_frames(measuring *m, bench_time kind, frame_of frame, void *state, uint32_t least,
                       uint32_t most, double seconds)
{
    double *times = calloc(most, sizeof *times);
    int code = times ? EXIT_DONE : app_exit_code(m->c->a, TYN_ERR_MEMORY, false);
    uint32_t done = 0;
    const double start = app_seconds();
    while (code == EXIT_DONE && done < most && (done < least || app_seconds() - start < seconds)) {
        code = frame(m, state);
        times[done] = m->renderer.frame_ms;
        done += code == EXIT_DONE;
    }
    if (code == EXIT_DONE) {
        m->ms[kind] = timing_median(times, done);
        m->frames[kind] = done;
    }
    free(times);
    return code;
}

// The whole picture again.
static int again_frame(measuring *m, void *state)
{
    (void)state;
    return renderer_frame(m->c->a, &m->renderer, &m->c->scene, &m->view, true, NULL);
}

// Frames that nobody times.
static int keep_busy(measuring *m)
{
    const double end = app_seconds() + m->c->suite->warm_seconds;
    int code = EXIT_DONE;
    while (code == EXIT_DONE && app_seconds() < end) {
        code = again_frame(m, NULL);
    }
    return code;
}

// Times of every node.
typedef struct node_times {
    uint32_t most, done;
    double *ms; // `most` for each node
} node_times;

static int light_frame(measuring *m, void *state)
{
    node_times *nodes = state;
    const int code = renderer_frame(m->c->a, &m->renderer, &m->c->scene, &m->view, true, NULL);
    if (code == EXIT_DONE) {
        double times[MAX_NODES] = {0};
        take_report(m, times);
        for (uint32_t k = 0; k < m->num_nodes; k++) {
            nodes->ms[k * nodes->most + nodes->done] = times[k];
        }
        nodes->done++;
    }
    return code;
}

static int time_light(measuring *m, uint32_t least)
{
    const bench_suite *suite = m->c->suite;
    node_times nodes = {.most = suite->frames,
                        .ms = calloc((size_t)suite->frames * MAX_NODES, sizeof *nodes.ms)};
    int code = nodes.ms ? keep_busy(m) : app_exit_code(m->c->a, TYN_ERR_MEMORY, false);
    if (code == EXIT_DONE) {
        code = time_frames(m, TIME_LIGHT, light_frame, &nodes, least, suite->frames,
                           suite->timing_seconds);
    }
    if (code == EXIT_DONE) {
        for (uint32_t k = 0; k < m->num_nodes; k++) {
            m->node_ms[k] = timing_median(nodes.ms + k * nodes.most, nodes.done);
        }
        finish_nodes(m);
    }
    free(nodes.ms);
    return code;
}

// The camera turns by a little, and a frame is rendered, with samples of its own where a method samples: as in a film.
typedef struct film {
    tyn_view view;
    flicker flicker;
} film;

static int film_frame(measuring *m, void *state)
{
    film *f = state;
    timing_turn_camera(&m->c->scene, &f->view.camera, flicker_step);
    f->view.seed += m->method.info.progressive;
    const int code = renderer_frame(m->c->a, &m->renderer, &m->c->scene, &f->view, false, NULL);
    if (code == EXIT_DONE && f->flicker.frames < FLICKER_FRAMES) {
        flicker_add(&f->flicker, tyn_offline_output(m->renderer.offline, TYN_OUTPUT_RADIANCE));
    }
    return code;
}

// Frames after the camera has moved: times, and flicker. The first is not timed: drivers compile in it what only
// such frames need.
static int time_camera(measuring *m, uint32_t least, uint32_t most, double seconds)
{
    film f = {.view = m->view};
    int code = flicker_open(&f.flicker, m->view.width, m->view.height)
                   ? keep_busy(m)
                   : app_exit_code(m->c->a, TYN_ERR_MEMORY, false);
    code = code == EXIT_DONE ? film_frame(m, &f) : code;
    if (code == EXIT_DONE) {
        code = time_frames(m, TIME_CAMERA, film_frame, &f, least, most, seconds);
    }
    if (code == EXIT_DONE) {
        m->flicker = flicker_value(&f.flicker);
    }
    flicker_close(&f.flicker);
    return code;
}

static int same_frame(measuring *m, void *state)
{
    (void)state;
    return renderer_frame(m->c->a, &m->renderer, &m->c->scene, &m->view, false, NULL);
}

static int time_unchanged(measuring *m)
{
    const bench_suite *suite = m->c->suite;
    int code = keep_busy(m);
    code = code == EXIT_DONE ? same_frame(m, NULL) : code; // puts right what the camera left
    return code == EXIT_DONE ? time_frames(m, TIME_UNCHANGED, same_frame, NULL, 1, suite->frames,
                                           suite->timing_seconds)
                             : code;
}

// The media of the frame before, as if they were new: grids are uploaded again, and a millionth is added to or taken
// from the densities, so that what is homogeneous changes as well.
typedef struct other_media {
    uint64_t hashes[TYN_MAX_MEDIA];
    float scales[TYN_MAX_MEDIA];
    uint32_t frames;
} other_media;

static int medium_frame(measuring *m, void *state)
{
    other_media *before = state;
    tyn_scene *scene = &m->c->scene;
    before->frames++;
    for (uint32_t i = 0; i < scene->num_volumes && i < TYN_MAX_MEDIA; i++) {
        scene->volumes[i].hash =
            before->hashes[i] ^ (UINT64_C(0x9E3779B97F4A7C15) * before->frames);
    }
    for (uint32_t i = 0; i < scene->num_media && i < TYN_MAX_MEDIA; i++) {
        scene->media[i].density_scale = before->scales[i] * (before->frames % 2 ? 1.000001f : 1);
    }
    return renderer_frame(m->c->a, &m->renderer, scene, &m->view, false, NULL);
}

// Frames in which the media have changed, the first of them not timed.
static int time_medium(measuring *m, uint32_t least)
{
    tyn_scene *scene = &m->c->scene;
    other_media before = {0};
    for (uint32_t i = 0; i < scene->num_volumes && i < TYN_MAX_MEDIA; i++) {
        before.hashes[i] = scene->volumes[i].hash;
    }
    for (uint32_t i = 0; i < scene->num_media && i < TYN_MAX_MEDIA; i++) {
        before.scales[i] = scene->media[i].density_scale;
    }
    int code = keep_busy(m);
    code = code == EXIT_DONE ? medium_frame(m, &before) : code;
    if (code == EXIT_DONE) {
        code = time_frames(m, TIME_MEDIUM, medium_frame, &before, least, m->c->suite->frames,
                           m->c->suite->timing_seconds);
    }
    for (uint32_t i = 0; i < scene->num_volumes && i < TYN_MAX_MEDIA; i++) {
        scene->volumes[i].hash = before.hashes[i];
    }
    for (uint32_t i = 0; i < scene->num_media && i < TYN_MAX_MEDIA; i++) {
        scene->media[i].density_scale = before.scales[i];
    }
    return code;
}

// The first picture of a program that has just opened the device: pipelines, uploads, memory, all nodes. The driver
// has compiled these kernels before.
static int time_first(measuring *m)
{
    renderer fresh = {0};
    const double start = app_seconds();
    int code = renderer_open(m->c->a, m->c->machine->device, &m->method, &fresh);
    if (code == EXIT_DONE) {
        code = renderer_frame(m->c->a, &fresh, &m->c->scene, &m->view, false, NULL);
    }
    if (code == EXIT_DONE) {
        m->ms[TIME_FIRST] = 1e3 * (app_seconds() - start);
        m->frames[TIME_FIRST] = 1;
    }
    renderer_close(&fresh);
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
        const double sample_ms = 2e4 * m->ms[TIME_LIGHT] / paths;
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
    // Once without a clock: drivers compile kernels when they first run, and other ones for these outputs. The frame
    // before was the first of all, so that only this one tells whether frames take long; such are not rendered more
    // often than times need, for which flicker, of three pictures, is left out.
    const double seconds = m->c->suite->timing_seconds;
    m->view.outputs = TYN_OUTPUT_RADIANCE;
    if (code == EXIT_DONE) {
        code = renderer_frame(a, &m->renderer, &m->c->scene, &m->view, true, NULL);
    }
    const uint32_t least = m->renderer.frame_ms > 1e3 * seconds ? 1 : 2;
    if (code == EXIT_DONE) {
        code = time_light(m, least);
    }
    if (code == EXIT_DONE) {
        const uint32_t frames = m->c->suite->frames;
        code =
            time_camera(m, least, frames < FLICKER_FRAMES ? FLICKER_FRAMES - 1 : frames, seconds);
    }
    if (code == EXIT_DONE) {
        take_states(m);
        code = time_unchanged(m);
    }
    // Of a sweep nobody asks for these.
    if (code == EXIT_DONE && bench_preset(m->run)) {
        code = time_medium(m, least);
        code = code == EXIT_DONE ? time_first(m) : code;
    }
    return code;
}

// A method that samples begins anew wherever anything changes: what its frame takes beside the samples is measured
// with one of them. Of unchanged frames it gives the picture that it has.
static int time_samples(measuring *m)
{
    const double samples_ms = m->ms[TIME_LIGHT];
    const uint32_t spp = m->view.num_samples, frames = m->frames[TIME_LIGHT];
    m->view.num_samples = 1;
    int code = time_frames(m, TIME_LIGHT, again_frame, NULL, 2, 2, 0);
    const double one_ms = m->ms[TIME_LIGHT];
    code = code == EXIT_DONE ? time_medium(m, 2) : code;
    code = code == EXIT_DONE ? time_first(m) : code;
    m->view.num_samples = spp;
    m->ms[TIME_LIGHT] = m->ms[TIME_CAMERA] = samples_ms;
    m->frames[TIME_LIGHT] = frames;
    m->ms[TIME_MEDIUM] = fmax(samples_ms, samples_ms + m->ms[TIME_MEDIUM] - one_ms);
    m->ms[TIME_FIRST] = fmax(samples_ms, samples_ms + m->ms[TIME_FIRST] - one_ms);
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
    code = code == EXIT_DONE ? keep_busy(m) : code;
    m->view.num_samples = spp;
    if (code == EXIT_DONE) {
        code = renderer_frame(a, &m->renderer, &m->c->scene, &m->view, true, label);
    }
    if (code == EXIT_DONE) {
        m->ms[TIME_LIGHT] = m->renderer.frame_ms;
        m->frames[TIME_LIGHT] = 1;
        take_report(m, m->node_ms);
        code = take_picture(m);
    }
    // Short ones again: a first millisecond is noise.
    if (code == EXIT_DONE && m->ms[TIME_LIGHT] < fmin(0.2e3 * seconds, 300)) {
        code = time_light(m, 1);
    } else if (code == EXIT_DONE) {
        finish_nodes(m);
    }
    if (code == EXIT_DONE && 3e-3 * m->ms[TIME_LIGHT] < seconds) {
        code = time_camera(m, 2, 2, seconds); // three pictures
    }
    if (code == EXIT_DONE) {
        code = time_samples(m);
    }
    return code;
}

int bench_measure(bench_case *c, const bench_run *run, const char *key, cJSON **record)
{
    measuring m = {.c = c,
                   .run = run,
                   .flip = NAN,
                   .fill = NAN,
                   .setup_ms = NAN,
                   .ms = {NAN, NAN, NAN, NAN, NAN},
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
        code = measuring_record(&m, key, NULL, record);
    } else if (opened && code != EXIT_INTERRUPTED) { // this method cannot do this scene; others may
        measuring_record(&m, key, c->a->last_error, record);
        code = code == EXIT_WRONG ? EXIT_DONE : code;
    }
    close_run(&m);
    return code;
}
