// renderer.c -- one frame of a method, with progress, that can be interrupted.
#include "renderer.h"
#include <stdlib.h>
#include <string.h>

int renderer_open(app *a, tyn_device *device, const method *m, renderer *r)
{
    *r = (renderer){.progressive = m->info.progressive};
    tyn_result result =
        tyn_offline_create(device,
                           tyn_offline_params(.method = m->info.name, .settings = m->settings,
                                              .memory_budget = m->memory_budget),
                           &r->offline);
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
            r->warnings[i] = text_format("%.0f %s", count, counts[i].what);
            app_warn(a, "%s", r->warnings[i] ? r->warnings[i] : counts[i].what);
        }
    }
}

// Between the records of a frame: Ctrl-C, how far it is, what is kept of it.
static bool go_on(void *user, double fraction)
{
    renderer *r = user;
    if (r->labelled) {
        progress_update(&r->a->bar, fraction);
    }
    if (r->keep && !app_interrupted()) {
        r->keep(r->keep_user, tyn_offline_samples(r->offline));
    }
    return !app_interrupted();
}

int renderer_frame(app *a, renderer *r, const tyn_scene *scene, const tyn_view *view,
                   bool recompute, const char *label)
{
    if (label) {
        progress_start(&a->bar, label, a->quiet);
    }
    tyn_view asked = *view;
    asked.num_samples = r->progressive ? view->num_samples : 0;
    r->a = a;
    r->labelled = label != NULL;
    tyn_offline_on_progress(r->offline, go_on, r);
    tyn_result result = tyn_offline_frame(r->offline, scene, &asked, recompute);
    if (label) {
        progress_stop(&a->bar);
    }
    r->setup_ms = tyn_offline_setup_ms(r->offline);
    r->frame_ms = tyn_offline_frame_ms(r->offline);
    r->samples = tyn_offline_samples(r->offline);
    int code = app_exit_code(a, result, true);
    if (code == EXIT_DONE) {
        warn_of_counts(a, r);
    }
    return code;
}
