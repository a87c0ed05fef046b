// pictures.c -- which picture is computed when: small ones while something moves, then sharper ones.
#include "view/viewer.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double rest_after = 0.15;       // seconds without a change
static const double rest_bound_ms = 1000;    // that a picture may take when movement has ended
static const double patient_bound_ms = 4000; // that one may take after a longer rest
static const double sharp_budget_ms = 200;   // of more samples at rest

// ---- showing ----------------------------------------------------------------------------------

bool pictures_has_layer(const viewer *v, uint32_t layer)
{
    return picture_layers[layer].title && picture_layers[layer].output & v->method.info.outputs;
}

uint32_t pictures_next_layer(const viewer *v)
{
    uint32_t layer = v->layer;
    do {
        layer = (layer + 1) % NUM_PICTURE_LAYERS;
    } while (layer && !pictures_has_layer(v, layer));
    return layer;
}

// The layer's values as they are uploaded: the first channel is what is shown of depths.
static const float *layer_values(viewer *v, const rendering *r, bool scale, float **copy)
{
    const picture_layer *layer = &picture_layers[v->layer];
    const bool made = r->method.outputs & layer->output;
    const float *values = rendering_output(r, made ? layer->output : TYN_OUTPUT_RADIANCE);
    if (!made || !values || layer->shows != PICTURE_SHOWS_FIRST) {
        return values;
    }
    const size_t count = (size_t)r->width * r->height;
    *copy = malloc(4 * count * sizeof **copy);
    float low = INFINITY, high = 0;
    for (size_t i = 0; *copy && i < count; i++) {
        const float x = values[4 * i + layer->first];
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
    v->woken = true;
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
    view.outputs = TYN_OUTPUT_RADIANCE | picture_layers[v->layer].output;
    view.width = (v->view.width + divisor - 1) / divisor;
    view.height = (v->view.height + divisor - 1) / divisor;
    return view;
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

static resolution_cost cost_of(const rendering *r, uint32_t divisor)
{
    return (resolution_cost){
        .divisor = divisor,
        .ms = r->ms,
        .pixels_ms = rendering_pixels_ms(r),
        .first = r->resized,
        .cold = r->frames == 1,
    };
}

static uint32_t coarsest(const viewer *v)
{
    return resolution_coarsest(v->view.width, v->view.height);
}

// What a sharper picture may take: no more than half of the rest so far, as what moves next waits for it.
static double patience_ms(const viewer *v)
{
    const double rested = 1e3 * (app_seconds() - v->last_change);
    return fmin(fmax(0.5 * rested, rest_bound_ms), patient_bound_ms);
}

// ---- the frame under way ----------------------------------------------------------------------

static bool is_open(const rendering *r)
{
    return r->context != NULL;
}

// Begins a frame of a rendering that may have to be opened first.
static rendering_state begin(viewer *v, viewer_task task, rendering *r, uint32_t divisor)
{
    tyn_view view = view_of(v, divisor);
    rendering_state state;
    if (task == TASK_REFERENCE) {
        state = comparison_begin(v, &view);
    } else if (!is_open(r) && !rendering_open(r, &v->library, &v->method)) {
        state = RENDERING_FAILED;
    } else {
        if (task != TASK_SMALL) {
            probe_ask(v, &view);
            estimate_ask(v, &view);
        }
        state = rendering_begin(r, &v->scene, &view, task == TASK_SAMPLES);
    }
    if (state == RENDERING_BUSY) {
        v->busy = r;
        v->task = task;
        v->task_divisor = divisor;
        v->sharp = v->sharp && (task == TASK_SAMPLES || task == TASK_REFERENCE);
        v->outdated = false;
        v->rest_next = 0;
    }
    return state;
}

static void fail(viewer *v, viewer_task task)
{
    if (task == TASK_REFERENCE) {
        comparison_fail(v);
        return;
    }
    v->outdated = false;
    v->sharp = task != TASK_SMALL || v->fresh; // nothing better comes of trying again
    v->save_wanted = v->whole = false;
    viewer_note(v, "%s", v->app->last_error);
}

static void take_small(viewer *v, const rendering *r)
{
    if (pictures_show(v, r, PICTURE_METHOD)) {
        count(v, true);
    }
    const resolution_cost cost = cost_of(r, v->task_divisor);
    resolution_moved(&v->small, &cost, v->args->target_ms, coarsest(v));
    if (!v->rest_divisor) {
        v->rest_divisor = resolution_at_rest(&cost, rest_bound_ms, coarsest(v));
    }
}

static void take_rest(viewer *v, const rendering *r)
{
    const bool more = v->task == TASK_SAMPLES;
    if (!pictures_show(v, r, PICTURE_METHOD)) {
        return;
    }
    count(v, false);
    v->rest_shown = v->task_divisor;
    if (v->outdated) { // it is not of what is asked for any more
        if (v->whole) {
            v->whole = v->save_wanted = false;
            viewer_note(v, "not saved: something changed while the picture was drawn");
        }
        return;
    }
    keep(v, r);
    probe_take(v, r);
    estimate_take(v, r, more);
    v->sharp = true; // sharpen() may find that a still sharper one is to be had
    if (more) {
        return;
    }
    v->stats.sharp_ms = 1e3 * (app_seconds() - v->last_change);
    v->rest_cost = cost_of(r, v->task_divisor);
    if (!v->whole) {
        v->rest_divisor = resolution_at_rest(&v->rest_cost, rest_bound_ms, coarsest(v));
    }
    v->whole = false;
    if (!v->method.info.progressive) {
        resolution_rested(&v->small, &v->rest_cost, v->args->target_ms, coarsest(v));
    }
}

static double budget_ms(const viewer *v)
{
    return v->task == TASK_SMALL ? v->args->target_ms : sharp_budget_ms;
}

// The frame under way is done: what it gave is shown.
static void take(viewer *v, rendering *r)
{
    if (v->task == TASK_REFERENCE) {
        if (!v->outdated) {
            comparison_take(v);
        }
        return;
    }
    v->shown = r;
    if (v->task == TASK_SMALL) {
        take_small(v, r);
    } else {
        take_rest(v, r);
    }
    if (v->fresh) {
        v->fresh = false;
        v->stats.first_ms = 1e3 * (app_seconds() - v->asked_at);
    }
}

bool pictures_computing(const viewer *v)
{
    return v->busy || is_open(&v->retired);
}

bool pictures_wait(viewer *v, double seconds)
{
    if (is_open(&v->retired)) {
        if (gpu_wait_for(&v->library, &v->retired.commands, seconds) != GPU_BUSY) {
            rendering_close(&v->retired);
        }
        return !pictures_computing(v);
    }
    if (!v->busy) {
        return true;
    }
    rendering *r = v->busy;
    const rendering_state state = rendering_poll(r, seconds, budget_ms(v));
    if (state == RENDERING_BUSY) {
        return false;
    }
    v->busy = NULL;
    if (state == RENDERING_DONE) {
        take(v, r);
    } else {
        fail(v, v->task);
    }
    v->task = TASK_NONE;
    return true;
}

void pictures_say(const viewer *v, char *text, size_t size)
{
    const rendering *r = v->busy ? v->busy : &v->retired;
    const double seconds = app_seconds() - r->started;
    text[0] = '\0';
    if (is_open(r) && seconds > 0.5) {
        snprintf(text, size, "%s %ux%u, %.0f s", v->busy ? "drawing" : "ending", r->width,
                 r->height, floor(seconds));
    }
}

void pictures_retire(viewer *v, rendering *r)
{
    if (v->busy == r) {
        v->busy = NULL;
        v->task = TASK_NONE;
    }
    v->shown = v->shown == r ? NULL : v->shown;
    if (is_open(r) && r->commands.pending && !v->library.lost && !is_open(&v->retired)) {
        v->retired = *r;
        *r = (rendering){0};
    }
    rendering_close(r);
}

// ---- what comes next --------------------------------------------------------------------------

uint32_t pictures_samples_wanted(const viewer *v)
{
    return method_samples(&v->how, VIEWER_SAMPLES);
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

static bool wants_samples(const viewer *v)
{
    return v->method.info.progressive &&
           (v->rest.samples < pictures_samples_wanted(v) || estimate_missing(v));
}

bool pictures_working(const viewer *v)
{
    return v->outdated || !v->sharp || moving(v) || wants_samples(v) || comparison_working(v);
}

// A still sharper picture at rest, if it is expected to take no more than it may.
static void sharpen(viewer *v)
{
    if (v->sharp && !v->outdated && v->rest_shown > 1 && v->rest_cost.divisor == v->rest_shown) {
        const uint32_t next = resolution_at_rest(&v->rest_cost, patience_ms(v), coarsest(v));
        v->sharp = next >= v->rest_shown;
        v->rest_next = v->sharp ? 0 : next;
    }
}

static void begin_next(viewer *v)
{
    const bool small = v->fresh || (moving(v) && v->has_picture);
    viewer_task task;
    rendering *r = &v->rest;
    uint32_t divisor = v->rest_divisor;
    if (small && v->outdated) {
        task = TASK_SMALL;
        v->small.divisor =
            v->small.divisor ? v->small.divisor : resolution_start(v->view.width, v->view.height);
        divisor = v->small.divisor;
        r = divisor > 1 ? &v->moving : r;
    } else if (small) {
        return;
    } else if (v->outdated || !v->sharp) {
        task = TASK_REST;
        divisor = v->whole                       ? 1
                  : !v->outdated && v->rest_next ? v->rest_next
                  : v->rest_divisor              ? v->rest_divisor
                                                 : resolution_start(v->view.width, v->view.height);
    } else if (wants_samples(v) && !(comparison_working(v) && v->last_task == TASK_SAMPLES)) {
        task = TASK_SAMPLES;
        divisor = v->rest_shown;
    } else if (comparison_working(v)) {
        task = TASK_REFERENCE;
        divisor = v->rest_shown;
        r = &v->comparison.rendering;
    } else {
        if (v->args->busy) {
            count(v, false);
        }
        return;
    }
    v->last_task = task;
    if (begin(v, task, r, divisor) == RENDERING_FAILED) {
        fail(v, task);
    }
}

// A picture is saved in the window's size, whatever that takes.
static void step_save(viewer *v)
{
    if (!v->save_wanted || !v->sharp || v->outdated || v->busy) {
        return;
    }
    if (v->rest_shown != 1) {
        v->whole = true; // begin_next makes it
        v->sharp = false;
        return;
    }
    v->save_wanted = false;
    save_picture(v);
}

void pictures_step(viewer *v)
{
    if (pictures_wait(v, 0)) {
        sharpen(v);
        step_save(v);
        begin_next(v);
    }
    const uint32_t pending = pictures_pending(v);
    v->stats.most_pending = pending > v->stats.most_pending ? pending : v->stats.most_pending;
}

void pictures_args(const viewer *v, struct picture_args *args)
{
    const picture_layer *layer = &picture_layers[v->layer];
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

void pictures_forget(viewer *v)
{
    v->small = (resolution){0};
    v->rest_divisor = v->rest_next = 0;
    v->rest.frames = v->moving.frames = 0; // kernels may be compiled again
    v->fresh = true;
    v->outdated = true;
    v->sharp = false;
    v->last_change = app_seconds();
}

void pictures_close(viewer *v)
{
    pictures_retire(v, &v->rest);
    pictures_retire(v, &v->moving);
    comparison_close(v);
    pictures_forget(v);
}
