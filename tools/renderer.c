// renderer.c -- one frame of a method, in portions that can be interrupted.
#include "renderer.h"

// Samples of all pixels in one call: small enough for Ctrl-C and the bar, and given by the view alone,
// so that the sums are the same on every run.
enum { SAMPLES_PER_CALL = 1 << 20 };

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
        progress_clear(&a->bar);
    }
    return code;
}
