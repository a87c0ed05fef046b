// until.c -- see until.h.
#include "until.h"
#include "metrics.h"
#include <math.h>
#include <string.h>

bool until_parse(app *a, const char *text, float *error)
{
    bool percent = false;
    const double value = text_fraction(text, &percent);
    if (isnan(value) || (value >= 1 && !percent)) {
        app_error(a, "--until: '%s' is neither a percentage like 1%% nor a share below 1 like 0.01",
                  text);
        return false;
    }
    *error = (float)value;
    return true;
}

void until_method(float error, method_options *how)
{
    if (!how->method && !how->refine) {
        how->refine = "4096";
    }
    how->until = error;
}

bool until_tells(const tyn_method_info *info)
{
    return info->progressive && info->outputs & TYN_OUTPUT_ERROR;
}

bool until_check(app *a, const tyn_method_info *info, const char *text)
{
    const bool tells = until_tells(info);
    if (!tells) {
        app_error(a,
                  "--until %s: method '%s' does not say how far it is off; leave --method out, or "
                  "take 'path'",
                  text, info->name);
    }
    return tells;
}

static float estimate(const renderer *r, const tyn_view *view)
{
    const float *light = tyn_offline_output(r->offline, TYN_OUTPUT_RADIANCE);
    const float *error = tyn_offline_output(r->offline, TYN_OUTPUT_ERROR);
    const size_t pixels = (size_t)view->width * view->height;
    return light && error ? (float)metrics_expected(light, error, pixels) : 0;
}

int until_render(app *a, renderer *r, const tyn_scene *scene, const tyn_view *view, float error,
                 const char *label, uint32_t *samples)
{
    enum { FIRST = 4 };
    double ms = 0;
    float reached = INFINITY;
    int code = EXIT_DONE;
    *samples = 0;
    while (code == EXIT_DONE && *samples < view->num_samples && !(reached <= error)) {
        tyn_view part = *view;
        const uint32_t left = view->num_samples - *samples, next = *samples ? *samples : FIRST;
        part.outputs |= TYN_OUTPUT_RADIANCE | TYN_OUTPUT_ERROR;
        part.first_sample = *samples;
        part.num_samples = next < left ? next : left;
        code = renderer_frame(a, r, scene, &part, false, label);
        *samples += r->samples;
        ms += r->frame_ms;
        reached = code == EXIT_DONE ? estimate(r, view) : reached;
    }
    r->frame_ms = ms;
    if (code == EXIT_DONE && reached > error) {
        app_warn(a,
                 "--until %.3g%%: the error is still about %.2g %% after the %u samples that are "
                 "allowed",
                 100 * (double)error, 100 * (double)reached, *samples);
    } else if (code == EXIT_DONE) {
        app_note(a, "error about %.2g %% after %u samples", 100 * (double)reached, *samples);
    }
    return code;
}
