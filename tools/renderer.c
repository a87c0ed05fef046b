// renderer.c -- one frame of a method, in portions that can be interrupted.
#include "renderer.h"
#include <stdlib.h>
#include <string.h>

// Samples of all pixels in one call: small enough for Ctrl-C and the bar, and given by the view alone,
// so that the sums are the same on every run.
enum { SAMPLES_PER_CALL = 1 << 18 };

int renderer_open(app *a, tyn_device *device, const method *m, renderer *r)
{
    *r = (renderer){.progressive = m->info.progressive};
    tyn_result result = tyn_offline_create(
        device, tyn_offline_params(.method = m->info.name, .settings = m->settings), &r->offline);
    return app_exit_code(a, result, true);
}

void renderer_close(renderer *r)
{
    tyn_offline_destroy(&r->offline);
    for (size_t i = 0; i < ARRAY_SIZE(r->warnings); i++) {
        free(r->warnings[i]);
        r->warnings[i] = NULL;
    }
}

static double counted(const tyn_report *report, const char *name)
{
    double sum = 0;
    for (uint32_t i = 0; i < report->num_nodes; i++) {
        const tyn_node_report *n = &report->nodes[i];
        for (uint32_t k = 0; k < n->num_work; k++) {
            sum += strcmp(n->work[k].name, name) == 0 ? n->work[k].amount : 0;
        }
    }
    return sum;
}

// Says once what was replaced or cut.
static void warn_of_counts(app *a, renderer *r)
{
    static const struct {
        const char *name, *what;
    } counts[] = {{"non_finite", "values were not finite and count as 0"},
                  {"cut", "paths were ended by the safety cap: the result is too dark"}};
    tyn_report report = {0};
    tyn_offline_report(r->offline, &report);
    for (size_t i = 0; i < ARRAY_SIZE(counts); i++) {
        double count = counted(&report, counts[i].name);
        if (count > 0 && !r->warnings[i]) {
            r->warnings[i] = text_format("at least %.0f %s", count, counts[i].what);
            app_warn(a, "%s", r->warnings[i] ? r->warnings[i] : counts[i].what);
        }
    }
}

static uint32_t portion(const tyn_view *view)
{
    uint64_t points = (uint64_t)view->width * view->height;
    if (view->outputs & TYN_OUTPUT_PROBE) {
        points = view->num_points;
    }
    uint64_t samples = SAMPLES_PER_CALL / (points ? points : 1);
    return samples < 1 ? 1 : (uint32_t)samples;
}

static int progressive_frame(app *a, renderer *r, const tyn_scene *scene, const tyn_view *view,
                             bool recompute, bool bar)
{
    tyn_view part = *view;
    uint32_t most = portion(view);
    for (uint32_t done = 0; done < view->num_samples; done += part.num_samples) {
        uint32_t left = view->num_samples - done;
        part.first_sample = done;
        part.num_samples = left < most ? left : most;
        tyn_result result = tyn_offline_frame(r->offline, scene, &part, recompute && done == 0);
        if (result != TYN_OK || app_interrupted()) {
            return app_exit_code(a, result, true);
        }
        r->frame_ms += tyn_offline_frame_ms(r->offline);
        r->setup_ms += tyn_offline_setup_ms(r->offline);
        if (bar) {
            progress_update(&a->bar, (double)(done + part.num_samples) / view->num_samples);
        }
    }
    return EXIT_DONE;
}

int renderer_frame(app *a, renderer *r, const tyn_scene *scene, const tyn_view *view,
                   bool recompute, const char *label)
{
    r->setup_ms = r->frame_ms = 0;
    if (label) {
        progress_start(&a->bar, label, a->quiet);
    }
    int code;
    if (r->progressive) {
        code = progressive_frame(a, r, scene, view, recompute, label != NULL);
    } else {
        tyn_view once = *view;
        once.num_samples = 0;
        code = app_exit_code(a, tyn_offline_frame(r->offline, scene, &once, recompute), true);
        r->frame_ms = tyn_offline_frame_ms(r->offline);
        r->setup_ms = tyn_offline_setup_ms(r->offline);
    }
    if (label) {
        progress_stop(&a->bar);
    }
    if (code == EXIT_DONE) {
        warn_of_counts(a, r);
    }
    return code;
}
