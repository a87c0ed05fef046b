// pictures.c -- which picture is computed when: small ones while something moves, then a sharp one.
#include "view/viewer.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_DIVISOR = 8 };
static const double rest_after = 0.15;     // seconds without a change
static const double sharp_budget_ms = 200; // of more samples at rest, so that the window answers

// ---- showing ----------------------------------------------------------------------------------

// The layer's values as they are uploaded: the first channel is what is shown of depths.
static const float *layer_values(viewer *v, const rendering *r, bool scale, float **copy)
{
    const view_layer *layer = &view_layers[v->layer];
    const bool made = r->method.outputs & layer->output;
    const float *values = rendering_output(r, made ? layer->output : TYN_OUTPUT_RADIANCE);
    if (!made || !values || layer->shows != PICTURE_SHOWS_FIRST) {
        return values;
    }
    const size_t count = (size_t)r->width * r->height;
    *copy = malloc(4 * count * sizeof **copy);
    float low = INFINITY, high = 0;
    for (size_t i = 0; *copy && i < count; i++) {
        const float x = values[4 * i + layer->component];
        (*copy)[4 * i] = x;
        if (isfinite(x) && x > 0) {
            low = fminf(low, x);
            high = fmaxf(high, x);
        }
    }
    if (scale) {
        v->low = low < high ? low : 0;
        v->high = low < high ? high : fmaxf(high, 1);
    }
    return *copy;
}

bool pictures_show(viewer *v, const rendering *r, picture_slot slot)
{
    if (slot == PICTURE_METHOD) {
        v->low = 0;
        v->high = 1;
    }
    float *copy = NULL;
    const float *values = layer_values(v, r, slot == PICTURE_METHOD, &copy);
    const bool shown = values && gpu_wait(&v->gpu, &v->surface.commands) &&
                       picture_set(&v->picture, slot, r->width, r->height, values);
    free(copy);
    v->has_picture = v->has_picture || shown;
    return shown;
}

static void count(viewer *v, bool moving)
{
    const double now = app_seconds(), since = now - v->last_shown;
    if (v->last_shown > 0 && v->last_was_moving == moving && since < 2) {
        *(moving ? &v->stats.moving_seconds : &v->stats.rest_seconds) += since;
        *(moving ? &v->stats.moving_frames : &v->stats.rest_frames) += 1;
    }
    v->last_shown = now;
    v->last_was_moving = moving;
}

// ---- computing --------------------------------------------------------------------------------

static tyn_view view_of(const viewer *v, uint32_t divisor)
{
    tyn_view view = v->view;
    view.camera = v->camera.camera;
    view.outputs = TYN_OUTPUT_RADIANCE | view_layers[v->layer].output;
    view.width = (v->view.width + divisor - 1) / divisor;
    view.height = (v->view.height + divisor - 1) / divisor;
    return view;
}

// A frame of a rendering that may have to be opened first.
static rendering_state compute(viewer *v, rendering *r, const tyn_view *view, double budget_ms,
                               bool more)
{
    if (!r->context && !rendering_open(r, &v->gpu, &v->method)) {
        return RENDERING_FAILED;
    }
    return rendering_frame(r, &v->scene, view, budget_ms, more);
}

// Keeps the radiance of a sharp picture: outputs are gone with the next frame.
static void keep(viewer *v, const rendering *r)
{
    const size_t size = (size_t)r->width * r->height * 4 * sizeof *v->pixels;
    const float *radiance = rendering_output(r, TYN_OUTPUT_RADIANCE);
    if (v->pixels_width != r->width || v->pixels_height != r->height) {
        free(v->pixels);
        v->pixels = malloc(size);
        v->pixels_width = v->pixels ? r->width : 0;
        v->pixels_height = v->pixels ? r->height : 0;
    }
    if (v->pixels && radiance) {
        memcpy(v->pixels, radiance, size);
    }
}

// The size at which the pixels' work fits into the time that a picture may take while something moves. Another size costs
// a set-up, so a larger one must fit easily; a smaller one is found while something moves.
static void choose_divisor(viewer *v)
{
    const double all = rendering_pixels_ms(&v->rest), larger = v->divisor - 1.0;
    if (v->divisor && (larger < 1 || all / (larger * larger) > 0.4 * v->args->target_ms)) {
        return;
    }
    uint32_t divisor = 1;
    while (divisor < MAX_DIVISOR && all / (divisor * divisor) > 0.7 * v->args->target_ms) {
        divisor++;
    }
    v->divisor = divisor;
}

static void step_sharp(viewer *v, bool more)
{
    tyn_view view = view_of(v, 1);
    probe_ask(v, &view);
    const rendering_state state = compute(v, &v->rest, &view, sharp_budget_ms, more);
    if (state == RENDERING_PENDING) {
        return; // what is shown stays
    }
    if (state == RENDERING_FAILED) {
        v->outdated = false;
        v->sharp = true; // nothing better comes of trying again
        viewer_note(v, "%s", v->app->last_error);
        return;
    }
    if (pictures_show(v, &v->rest, PICTURE_METHOD)) {
        keep(v, &v->rest);
        if (!more) {
            v->stats.sharp_ms = 1e3 * (app_seconds() - v->last_change);
        }
        count(v, false);
        v->sharp = true;
        v->outdated = false;
        probe_take(v, &v->rest);
        if (!v->method.info.progressive && !more) {
            choose_divisor(v);
        }
    }
}

// Steps by one, after a picture that took far from the time it should.
static void correct_divisor(viewer *v, const rendering *r)
{
    const double wanted = v->args->target_ms;
    if (r->ms > 1.5 * wanted && v->divisor < MAX_DIVISOR && rendering_pixels_ms(r) > 0.6 * wanted) {
        v->divisor++;
    }
}

static void step_moving(viewer *v)
{
    v->divisor = v->divisor ? v->divisor : v->method.info.progressive ? 2 : 3;
    rendering *r = v->divisor > 1 ? &v->moving : &v->rest;
    const tyn_view view = view_of(v, v->divisor);
    const rendering_state state = compute(v, r, &view, v->args->target_ms, false);
    if (state == RENDERING_PENDING) {
        return;
    }
    if (state == RENDERING_FAILED) {
        v->outdated = false;
        viewer_note(v, "%s", v->app->last_error);
        return;
    }
    v->outdated = false;
    v->sharp = false;
    if (pictures_show(v, r, PICTURE_METHOD)) {
        count(v, true);
    }
    correct_divisor(v, r);
}

uint32_t pictures_samples_wanted(const viewer *v)
{
    return v->how.spp ? v->how.spp : 4096;
}

static bool moving(const viewer *v)
{
    return v->turntable || app_seconds() - v->last_change < rest_after;
}

uint32_t pictures_pending(const viewer *v)
{
    return rendering_pending(&v->rest) + rendering_pending(&v->moving) +
           rendering_pending(&v->comparison.rendering);
}

bool pictures_working(const viewer *v)
{
    return v->outdated || !v->sharp || moving(v) ||
           (v->method.info.progressive && v->rest.samples < pictures_samples_wanted(v)) ||
           comparison_working(v);
}

// What is left to do at rest: more samples of the method, and of the reference.
static void step_rest(viewer *v)
{
    const bool busy = v->args->busy;
    if (v->method.info.progressive && v->rest.samples < pictures_samples_wanted(v)) {
        step_sharp(v, true);
    } else if (busy) {
        count(v, false);
    }
    if (comparison_working(v)) {
        const tyn_view view = view_of(v, 1);
        comparison_step(v, &view, sharp_budget_ms);
    }
}

void pictures_step(viewer *v)
{
    if (moving(v) && v->has_picture) {
        if (v->outdated) {
            step_moving(v);
        }
    } else if (v->outdated || !v->sharp) {
        step_sharp(v, false);
    } else {
        step_rest(v);
    }
    const uint32_t pending = pictures_pending(v);
    v->stats.most_pending = pending > v->stats.most_pending ? pending : v->stats.most_pending;
    if (v->sharp && v->save_wanted) {
        v->save_wanted = false;
        save_picture(v);
    }
}

void pictures_args(const viewer *v, struct picture_args *args)
{
    const view_layer *layer = &view_layers[v->layer];
    *args = (struct picture_args){
        .width = (float)v->surface.extent.width,
        .height = (float)v->surface.extent.height,
        .split = comparison_seen(v) ? v->comparison.split * (float)v->surface.extent.width
                                    : (float)v->surface.extent.width,
        .scale = exp2f(v->exposure),
        .low = v->low,
        .high = v->high,
        .shows = layer->shows,
        .curve = (uint32_t)v->curve,
    };
}

void pictures_close(viewer *v)
{
    rendering_close(&v->rest);
    rendering_close(&v->moving);
    comparison_close(v);
    v->outdated = true;
    v->sharp = false;
    v->divisor = 0;
}
