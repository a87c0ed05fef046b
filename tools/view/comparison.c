// comparison.c -- the method's picture beside that of the progressive path tracer, and how far it is off.
#include "view/comparison.h"
#include "view/viewer.h"
#include <stdlib.h>
#include <tyndall/registry.h>

static const double measure_every = 0.5; // seconds

void comparison_close(viewer *v)
{
    pictures_retire(v, &v->comparison.rendering);
    method_finish(&v->comparison.method);
    v->comparison.started = v->comparison.measured = false;
}

void comparison_toggle(viewer *v)
{
    comparison *c = &v->comparison;
    c->on = !c->on;
    c->split = 0.5f;
    v->woken = true;
    if (!c->on) {
        comparison_close(v);
    }
}

static bool open_reference(viewer *v)
{
    comparison *c = &v->comparison;
    if (c->rendering.context) {
        return true;
    }
    method_options how = v->how;
    how.method = tyn_method_reference();
    how.quality = NULL;
    how.defines.count = 0;
    method_finish(&c->method);
    return method_open(v->app, &how, &c->method) == EXIT_DONE &&
           scene_prepare(v->app, &c->method.info, &v->scene) == EXIT_DONE &&
           rendering_open(&c->rendering, &v->library, &c->method);
}

// Four floats a pixel into three planes of one channel each; `planes` is new memory, NULL if there is none.
static float *planes_of(const float *rgba, size_t count, const float *planes[3])
{
    float *values = rgba ? malloc(3 * count * sizeof *values) : NULL;
    for (size_t c = 0; c < 3; c++) {
        planes[c] = values ? values + c * count : NULL;
        for (size_t i = 0; values && i < count; i++) {
            values[c * count + i] = rgba[4 * i + c];
        }
    }
    return values;
}

static void measure(viewer *v)
{
    comparison *c = &v->comparison;
    const rendering *r = &c->rendering;
    const size_t count = (size_t)r->width * r->height;
    if (!v->pixels || v->pixels_width != r->width || v->pixels_height != r->height) {
        return;
    }
    metrics_image image = {.width = r->width, .height = r->height}, reference = image;
    float *memory[] = {
        planes_of(v->pixels, count, image.rgb),
        planes_of(rendering_output(r, TYN_OUTPUT_RADIANCE), count, reference.rgb),
        planes_of(rendering_output(r, TYN_OUTPUT_ERROR), count, reference.se),
    };
    c->measured = memory[0] && memory[1] &&
                  metrics_compare(&image, &reference, COMPARISON_BLOCK, &c->error) == METRICS_OK;
    for (size_t i = 0; i < ARRAY_SIZE(memory); i++) {
        free(memory[i]);
    }
    c->last_measured = app_seconds();
}

bool comparison_seen(const viewer *v)
{
    return v->comparison.on && v->comparison.started && v->sharp;
}

bool comparison_working(const viewer *v)
{
    const comparison *c = &v->comparison;
    return c->on && (!c->started || c->rendering.samples < pictures_samples_wanted(v));
}

bool comparison_tells(const comparison *c)
{
    return c->measured && c->error.n < 0.5 * c->error.rel_l1;
}

void comparison_fail(viewer *v)
{
    viewer_note(v, "%s", v->app->last_error);
    comparison_toggle(v);
}

rendering_state comparison_begin(viewer *v, const tyn_view *view)
{
    comparison *c = &v->comparison;
    tyn_view asked = *view;
    const tyn_output layer = picture_layers[v->layer].output;
    asked.num_points = 0;
    asked.points = NULL;
    if (!open_reference(v)) {
        return RENDERING_FAILED;
    }
    asked.outputs =
        (TYN_OUTPUT_RADIANCE | TYN_OUTPUT_ERROR | (uint32_t)layer) & c->rendering.method.outputs;
    return rendering_begin(&c->rendering, &v->scene, &asked, c->started);
}

void comparison_take(viewer *v)
{
    comparison *c = &v->comparison;
    c->started = true;
    pictures_show(v, &c->rendering, PICTURE_REFERENCE);
    if (!c->measured || !comparison_working(v) ||
        app_seconds() - c->last_measured > measure_every) {
        measure(v);
    }
}
