// estimate.c -- see estimate.h.
#include "until.h"
#include "view/viewer.h"
#include <math.h>

bool estimate_told(const viewer *v)
{
    return until_tells(&v->method.info);
}

uint32_t estimate_place(uint32_t samples)
{
    const uint32_t place = samples ? 1 + (uint32_t)(8 * log2(samples)) : 0;
    return place < ESTIMATE_POINTS ? place : ESTIMATE_POINTS - 1;
}

void estimate_ask(const viewer *v, tyn_view *view)
{
    if (v->show_panel && estimate_told(v)) {
        view->outputs |= v->method.info.outputs & (TYN_OUTPUT_ERROR | TYN_OUTPUT_BIAS);
    }
}

bool estimate_missing(const viewer *v)
{
    return v->show_panel && estimate_told(v) &&
           estimate_place(v->estimate.samples) != estimate_place(v->rest.samples);
}

static float expected(const rendering *r, tyn_output layer)
{
    const float *light = rendering_output(r, TYN_OUTPUT_RADIANCE);
    const float *error = rendering_output(r, layer);
    const size_t pixels = (size_t)r->width * r->height;
    return light && error ? (float)metrics_expected(light, error, pixels) : 0;
}

void estimate_take(viewer *v, const rendering *r, bool more)
{
    estimate *e = &v->estimate;
    if (!more) {
        *e = (estimate){0};
    }
    if (estimate_missing(v) && rendering_output(r, TYN_OUTPUT_ERROR)) {
        e->samples = r->samples;
        e->error = expected(r, TYN_OUTPUT_ERROR);
        e->bias = expected(r, TYN_OUTPUT_BIAS);
        e->curve[estimate_place(e->samples)] = isfinite(e->error) ? e->error : 0;
    }
}
