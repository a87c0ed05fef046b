// offline.c -- rendering to host memory with a device of our own: submit and wait.
#include <tyndall/offline.h>
#include "base/clock.h"
#include "base/fault.h"
#include "frame/context.h"
#include "frame/projection.h"
#include "frame/submission.h"
#include "base/given.h"
#include <stdlib.h>
#include <string.h>

// A part of a picture is rendered with a margin and from a multiple of pixels on, so that each pixel has the neighbours that it
// has in the whole picture, and grids of pixels begin at the same places. By default settings patterns of `shade` are of 5 x 5
// blocks of two pixels, first steps of the march and the display's dither of 8 x 8 pixels: both begin every 40 pixels. Light
// comes to a pixel from at most five blocks or a few nodes of four pixels away: the margin is twice that.
enum { PART_PERIOD = 40, PART_MARGIN = 24 };

// What of a rendered picture is asked for, pixels.
typedef struct shown_part {
    uint32_t corner[2], size[2], rendered[2];
} shown_part;

struct tyn_offline {
    tyn_device *dev;
    tyn_context *context;
    tyn_submission submission;
    double setup_ms, frame_ms;
    uint32_t samples; // done in the last frame
    tyn_progress_fn progress;
    void *progress_user;
    // Sums over the records of the last frame; num_nodes 0: it was one record.
    tyn_node_report *nodes;
    uint32_t num_nodes;
    bool progressive;
    bool makes_pictures; // of its samples, which need be done for the last of them alone
    shown_part shown;    // of the last frame's pictures
    void *pictures[TYN_NUM_OUTPUTS]; // parts of them, by the output's bit
};

tyn_result tyn_offline_create(tyn_device *dev, const tyn_offline_params *params, tyn_offline **out)
{
    if (out) {
        *out = NULL;
    }
    if (!TYN_GIVEN(dev ? &dev->log : NULL, dev, params, out) ||
        !tyn_sized(&dev->log, __func__, params->struct_size, sizeof *params,
                   "tyn_offline_params")) {
        return TYN_ERR_PARAMS;
    }
    if (!dev->queue) {
        return TYN_FAULT(&dev->log, TYN_ERR_PARAMS,
                         "tyn_offline_create needs a device from tyn_device_open");
    }
    tyn_offline *off = calloc(1, sizeof *off);
    if (!off) {
        return TYN_ERR_MEMORY;
    }
    off->dev = dev;
    off->submission.dev = dev;
    tyn_method_info info; // of a method that is none the context complains
    off->progressive = tyn_method_named(params->method, &info) && info.progressive;
    off->makes_pictures = !info.reference;
    tyn_result result = tyn_context_create(
        dev,
        tyn_context_params(.method = params->method, .settings = params->settings,
                           .frames_in_flight = 1, .readback = true,
                           .memory_budget = params->memory_budget),
        &off->context);
    if (result == TYN_OK) {
        result = tyn_submission_create(dev, &off->submission);
    }
    if (result != TYN_OK) {
        tyn_offline_destroy(&off);
    }
    *out = off;
    return result;
}

void tyn_offline_destroy(tyn_offline **offline)
{
    tyn_offline *off = offline ? *offline : NULL;
    if (!off) {
        return;
    }
    *offline = NULL;
    tyn_context_destroy(&off->context);
    tyn_submission_destroy(&off->submission);
    for (uint32_t i = 0; i < TYN_NUM_OUTPUTS; i++) {
        free(off->pictures[i]);
    }
    free(off->nodes);
    free(off);
}

void tyn_offline_on_progress(tyn_offline *off, tyn_progress_fn fn, void *user)
{
    if (off) {
        off->progress = fn;
        off->progress_user = user;
    }
}

// Records, submits and waits.
static tyn_result submit(tyn_offline *off, tyn_frame *frame)
{
    frame->cmd = off->submission.cmd;
    TYN_TRY(tyn_submission_begin(&off->submission));
    TYN_TRY(tyn_context_record(off->context, frame));
    const tyn_result result = tyn_submission_run(&off->submission, "rendering a frame");
    if (result != TYN_OK) {
        tyn_context_forget(off->context);
    }
    return result;
}

// Adds what the last record did. A node that did not run in it still reports its last run.
static void add_record(tyn_offline *off)
{
    tyn_report report;
    tyn_context_report(off->context, &report);
    if (off->num_nodes != report.num_nodes) { // the first record of a frame
        tyn_node_report *nodes = realloc(off->nodes, report.num_nodes * sizeof *nodes);
        if (nodes) {
            memcpy(nodes, report.nodes, report.num_nodes * sizeof *nodes);
            off->nodes = nodes;
            off->num_nodes = report.num_nodes;
        }
        return;
    }
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        const tyn_node_report *from = &report.nodes[i];
        tyn_node_report *to = &off->nodes[i];
        if (strcmp(from->state, "ran")) {
            continue;
        }
        to->state = from->state;
        to->gpu_ms += from->gpu_ms;
        to->cpu_ms += from->cpu_ms;
        to->dispatches += from->dispatches;
        to->barriers += from->barriers;
        to->flops += from->flops;
        for (uint32_t w = 0; w < from->num_work && w < to->num_work; w++) {
            to->work[w].amount += from->work[w].amount;
        }
    }
}

// What is rendered for `view`: of what is no part (it will be refused) and for progressive methods, whose pixels depend on no
// others, what is asked for. `most` pixels along a side can be rendered: what with its margin is more has none.
static tyn_view rendered_view(shown_part *shown, const tyn_view *view, bool progressive,
                              uint32_t most)
{
    tyn_view all = *view;
    uint32_t *size[2] = {&all.width, &all.height};
    *shown = (shown_part){{0, 0}, {view->width, view->height}, {view->width, view->height}};
    if (progressive || !tyn_frame_is_part(view)) {
        return all;
    }
    for (int a = 0; a < 2; a++) {
        const uint32_t from = view->corner[a], first = from > PART_MARGIN ? from - PART_MARGIN : 0;
        const uint32_t begin = first / PART_PERIOD * PART_PERIOD,
                       margin_end = from + *size[a] + PART_MARGIN,
                       end = margin_end < view->whole[a] ? margin_end : view->whole[a];
        if (end - begin > most) {
            continue;
        }
        all.corner[a] = begin;
        *size[a] = end - begin;
        shown->corner[a] = from - all.corner[a];
        shown->rendered[a] = *size[a];
    }
    return all;
}

tyn_result tyn_offline_frame(tyn_offline *off, const tyn_scene *scene, const tyn_view *view,
                             bool recompute)
{
    if (!off || !TYN_GIVEN(&off->dev->log, scene, view)) {
        return TYN_ERR_PARAMS;
    }
    shown_part shown;
    tyn_view part = rendered_view(&shown, view, off->progressive, tyn_frame_most_pixels(off->dev));
    tyn_frame frame = *tyn_frame(.scene = scene, .view = &part, .recompute = recompute);
    uint32_t batch = tyn_context_batch(off->context, &frame);
    uint32_t samples = view->num_samples ? view->num_samples : 1;
    const bool several = batch < samples; // records of one structure: it is prepared once
    part.num_samples = several ? batch : samples;
    double start = tyn_now_ms();
    tyn_result result = tyn_context_prepare(off->context, &frame);
    if (result == TYN_OK) {
        off->shown = shown; // of a frame that is refused the pictures are those of the last one
        frame.setup_only = true;
        result = submit(off, &frame);
        frame.setup_only = false;
    }
    off->setup_ms = tyn_now_ms() - start;

    off->num_nodes = 0;
    off->samples = 0;
    start = tyn_now_ms();
    bool stopped = false;
    for (uint32_t done = 0; result == TYN_OK && done < samples; done += part.num_samples) {
        frame.recompute = recompute && done == 0;
        part.first_sample = view->first_sample + done;
        batch = done ? tyn_context_batch(off->context, &frame) : batch;
        part.num_samples = samples - done < batch ? samples - done : batch;
        part.unfinished = off->makes_pictures && done + part.num_samples < samples;
        result = submit(off, &frame);
        off->samples += result == TYN_OK ? part.num_samples : 0;
        if (result == TYN_OK && several) {
            const double fraction = (double)(done + part.num_samples) / samples;
            add_record(off);
            bool go_on = !off->progress || off->progress(off->progress_user, fraction);
            stopped = stopped || !go_on;
            if (stopped && !part.unfinished) {
                break;
            } else if (stopped) { // one more, which makes the picture
                samples = done + part.num_samples + 1;
            }
        }
    }
    result = result == TYN_OK && stopped ? TYN_ERR_STOPPED : result;
    off->frame_ms = tyn_now_ms() - start;
    return result;
}

// Bytes of a pixel of a picture, by the bit of its output; 0: it is none.
#define ROW(constant, bit, name, bytes, set) [bit] = bytes,
static const uint32_t pixel_bytes[TYN_NUM_OUTPUTS] = {TYN_OUTPUTS(ROW)};
#undef ROW

const void *tyn_offline_output(tyn_offline *off, tyn_output output)
{
    const char *from = off ? tyn_context_output(off->context, output) : NULL;
    if (!from) {
        return NULL;
    }
    const shown_part *shown = &off->shown;
    uint32_t bit = 0;
    while (!((uint32_t)output >> bit & 1)) {
        bit++;
    }
    const uint32_t bytes = pixel_bytes[bit];
    if (!bytes || !memcmp(shown->size, shown->rendered, sizeof shown->size)) {
        return from;
    }
    const size_t row = (size_t)bytes * shown->size[0],
                 rendered = (size_t)bytes * shown->rendered[0];
    void **picture = &off->pictures[bit];
    free(*picture);
    *picture = malloc(row * shown->size[1]);
    for (uint32_t y = 0; *picture && y < shown->size[1]; y++) {
        memcpy((char *)*picture + y * row,
               from + (shown->corner[1] + y) * rendered + (size_t)bytes * shown->corner[0], row);
    }
    return *picture;
}

void tyn_offline_report(tyn_offline *off, tyn_report *report)
{
    tyn_context_report(off ? off->context : NULL, report);
    if (off && report && off->num_nodes) {
        report->nodes = off->nodes;
        report->num_nodes = off->num_nodes;
    }
}

tyn_context *tyn_offline_context(tyn_offline *off)
{
    return off ? off->context : NULL;
}

uint32_t tyn_offline_samples(const tyn_offline *off)
{
    return off ? off->samples : 0;
}

double tyn_offline_setup_ms(const tyn_offline *off)
{
    return off ? off->setup_ms : 0;
}

double tyn_offline_frame_ms(const tyn_offline *off)
{
    return off ? off->frame_ms : 0;
}
