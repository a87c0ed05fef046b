// stress_render.c -- a picture or balance of a case, and what was counted on the way.
#include "stress_render.h"
#include "stats.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/registry.h>

// ---- what is counted --------------------------------------------------------------------------

static void count_values(const float *rgba, stress_counts *counts)
{
    for (uint32_t i = 0; rgba && i < 4 * STRESS_PIXELS; i++) {
        counts->non_finite += i % 4 < 3 && !isfinite(rgba[i]);
        counts->negative += i % 4 < 3 && rgba[i] < 0;
    }
}

// Kernels replace values that are not finite by 0 and count them.
static double counted(const tyn_report *report, const char *name)
{
    double sum = 0;
    for (uint32_t i = 0; i < report->num_nodes; i++) {
        for (uint32_t k = 0; k < report->nodes[i].num_work; k++) {
            bool is = strcmp(report->nodes[i].work[k].name, name) == 0;
            sum += is ? report->nodes[i].work[k].amount : 0;
        }
    }
    return sum;
}

static double largest(const tyn_report *report, const char *name)
{
    double most = 0;
    for (uint32_t i = 0; i < report->num_nodes; i++) {
        for (uint32_t k = 0; k < report->nodes[i].num_work; k++) {
            bool is = strcmp(report->nodes[i].work[k].name, name) == 0;
            most = is ? fmax(most, report->nodes[i].work[k].amount) : most;
        }
    }
    return most;
}

static void add_warning(cJSON *warnings, const char *text)
{
    const cJSON *w;
    cJSON_ArrayForEach(w, warnings)
    {
        if (strcmp(w->valuestring, text) == 0) {
            return;
        }
    }
    cJSON_AddItemToArray(warnings, cJSON_CreateString(text));
}

static void take_report(tyn_offline *offline, stress_counts *counts)
{
    tyn_report report = {0};
    tyn_offline_report(offline, &report);
    counts->non_finite += counted(&report, "non_finite");
    for (uint32_t i = 0; i < report.num_warnings; i++) {
        add_warning(counts->warnings, report.warnings[i]);
    }
    counts->clamped += counted(&report, "clamped") + counted(&report, "ghosts");
    counts->hidden = fmax(counts->hidden, largest(&report, "hidden"));
    counts->cut += counted(&report, "cut");
    if (counts->cut > 0) { // as the stats of a rendering say it
        add_warning(counts->warnings, "paths were ended by the safety cap: the result is too dark");
    }
}

// ---- a run ------------------------------------------------------------------------------------

typedef struct run {
    app *a;
    tyn_offline *offline;
    tyn_method_info info;
    tyn_scene scene;
    tyn_view view;
    tyn_log log; // to keep the first message
    stress_counts *counts;
} run;

static bool go_on(void *user, double fraction)
{
    (void)user;
    (void)fraction;
    return !app_interrupted();
}

static int open_run(run *r, tyn_device *device, const char *with, const stress_case *c,
                    const stress_effort *effort)
{
    tyn_settings *settings = NULL;
    bool ok = tyn_method_named(with, &r->info) && stress_scene(c, &r->scene);
    stress_view(c, &r->view);
    r->view.seed = effort->seed;
    r->view.max_depth = effort->max_depth;
    tyn_result result = ok ? tyn_settings_create(&settings) : TYN_ERR_MEMORY;
    if (result == TYN_OK && c->storage) {
        result = tyn_settings_set(settings, "medium.storage", c->storage, &r->a->log);
    }
    if (result == TYN_OK) {
        result = tyn_offline_create(
            device, tyn_offline_params(.method = with, .settings = settings), &r->offline);
    }
    tyn_settings_destroy(&settings);
    if (result == TYN_OK) {
        tyn_offline_on_progress(r->offline, go_on, NULL);
    }
    return app_exit_code(r->a, result, false);
}

static void close_run(run *r)
{
    tyn_offline_destroy(&r->offline);
    tyn_scene_finish(&r->scene);
}

// A frame of `samples` more. EXIT_DONE with counts->failure where the method refuses.
static int frame(run *r, uint32_t samples)
{
    r->view.num_samples = r->info.progressive ? samples : 0;
    tyn_result result = tyn_offline_frame(r->offline, &r->scene, &r->view, false);
    r->view.first_sample += r->view.num_samples;
    r->counts->paths += (double)r->view.num_samples * STRESS_PIXELS;
    if (result == TYN_ERR_STOPPED) {
        return EXIT_INTERRUPTED;
    }
    if (result == TYN_ERR_PARAMS || result == TYN_ERR_UNSUPPORTED) {
        r->counts->failure = text_format("refused by the method (%d)", (int)result);
        return EXIT_DONE;
    }
    r->counts->ms += tyn_offline_frame_ms(r->offline);
    return app_exit_code(r->a, result, false);
}

static void take_picture(run *r, stress_picture *p)
{
    const float *rgba = tyn_offline_output(r->offline, TYN_OUTPUT_RADIANCE);
    const float *error = tyn_offline_output(r->offline, TYN_OUTPUT_ERROR);
    p->has_se = error != NULL;
    for (int i = 0; i < 3 * STRESS_PIXELS; i++) {
        p->rgb[i % 3][i / 3] = rgba[i / 3 * 4 + i % 3];
        p->se[i % 3][i / 3] = error ? error[i / 3 * 4 + i % 3] : 0;
    }
    metrics_image image, mean;
    metrics m = {0};
    stress_image(p, &image);
    mean = image;
    memset(mean.se, 0, sizeof mean.se);
    p->noise = metrics_compare(&image, &mean, STRESS_BLOCK, &m) == METRICS_OK ? m.n : 0;
}

void stress_image(const stress_picture *p, metrics_image *image)
{
    *image = (metrics_image){.width = STRESS_SIZE, .height = STRESS_SIZE};
    for (int k = 0; k < 3; k++) {
        image->rgb[k] = p->rgb[k];
        image->se[k] = p->has_se ? p->se[k] : NULL;
    }
}

// Four times the samples each time, as long as the next time fits.
int stress_render(app *a, tyn_device *device, const char *with, const stress_case *c,
                  const stress_effort *effort, stress_picture *picture, stress_counts *counts)
{
    run r = {.a = a, .counts = counts};
    int code = open_run(&r, device, with, c, effort);
    r.view.outputs = TYN_OUTPUT_RADIANCE | (r.info.outputs & TYN_OUTPUT_ERROR) |
                     (r.info.progressive ? 0 : r.info.outputs & TYN_OUTPUT_TRANSMITTANCE);
    uint32_t samples = 4;
    for (int turn = 0; code == EXIT_DONE; turn++) {
        const double start = app_seconds();
        code = frame(&r, samples);
        if (code != EXIT_DONE || counts->failure) {
            break;
        }
        take_picture(&r, picture);
        take_report(r.offline, counts);
        // The first frame makes kernels, and what the paths need to know of the scene: its own time counts. The next turn takes four
        // times the samples of all before.
        const double used =
            turn == 0 ? 0.001 * tyn_offline_frame_ms(r.offline) : 4 * (app_seconds() - start);
        bool enough = picture->noise <= effort->noise && turn > 1;
        if (!r.info.progressive || enough || used > effort->seconds) {
            break;
        }
        samples = 3 * r.view.first_sample;
    }
    if (code == EXIT_DONE && !counts->failure) {
        count_values(tyn_offline_output(r.offline, TYN_OUTPUT_RADIANCE), counts);
        count_values(tyn_offline_output(r.offline, TYN_OUTPUT_TRANSMITTANCE), counts);
    }
    close_run(&r);
    return code;
}

int stress_balance(app *a, tyn_device *device, const char *with, const stress_case *c,
                   const stress_effort *effort, double *imbalance, double *se,
                   stress_counts *counts)
{
    run r = {.a = a, .counts = counts};
    *imbalance = *se = 0;
    int code = open_run(&r, device, with, c, effort);
    r.view.outputs = TYN_OUTPUT_BALANCE;
    if (code == EXIT_DONE) {
        code = frame(&r, 64);
    }
    if (code == EXIT_DONE && !counts->failure) {
        const tyn_balance *b = tyn_offline_output(r.offline, TYN_OUTPUT_BALANCE);
        for (int k = 0; k < 3; k++) {
            const double all[] = {b->entering[k], b->absorbed_media[k], b->escaped[k],
                                  b->imbalance[k]};
            for (int i = 0; i < 4; i++) {
                counts->non_finite += !isfinite(all[i]);
                counts->negative += i < 3 && all[i] < 0;
            }
            if (!(fabs(b->imbalance[k]) <= fabs(*imbalance))) {
                *imbalance = b->imbalance[k];
                *se = b->imbalance_se[k];
            }
        }
        take_report(r.offline, counts);
    }
    close_run(&r);
    return code;
}
