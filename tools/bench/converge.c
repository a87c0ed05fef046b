// converge.c -- a picture of `path` that is rendered in rounds until it is good enough.
//
// A round gives means m_i of n_i samples and their standard errors s_i. The mean of all is sum n_i m_i / N with the
// standard error sqrt(sum (n_i s_i)^2) / N, N = sum n_i.
#include "converge.h"
#include "renderer.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { FIRST_ROUND = 16, LARGEST_ROUND = 512 };
static const double round_seconds = 20;

// What rendering takes: on a processor its time over its cores, so that whatever else it does meanwhile takes nothing
// from a reference; else the clock's.
static double device_seconds(const bench_machine *on)
{
    struct timespec t;
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    if (strcmp(on->type, "cpu") != 0 || cores < 1 ||
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t) != 0) {
        return app_seconds();
    }
    return ((double)t.tv_sec + 1e-9 * (double)t.tv_nsec) / (double)cores;
}

bool converge_is_done(const bench_reference *r, const bench_goal *goal)
{
    const double noise = r->noise[BENCH_BLOCKS - 1];
    return r->spp >= goal->spp || r->seconds >= goal->seconds ||
           (r->spp > 0 && goal->noise > 0 && noise <= goal->noise);
}

// Samples of the next round. Where their number alone is asked for it follows from the number before, so that every
// call gives the same bytes; else it is what takes round_seconds as far as is known, and no more than is missing.
static uint32_t next_round(const bench_reference *r, const bench_goal *goal, uint32_t done,
                           double took)
{
    double n = FIRST_ROUND;
    if (goal->noise == 0 && isinf(goal->seconds)) {
        n = fmin(fmin(fmax(n, r->spp), LARGEST_ROUND), (double)goal->spp - r->spp);
        return n > 2 ? (uint32_t)n : 2;
    }
    if (done > 0 && took > 0) {
        n = fmin(done * fmin(round_seconds, goal->seconds - r->seconds) / took, 8.0 * done);
    }
    const double ratio = goal->noise > 0 ? r->noise[BENCH_BLOCKS - 1] / goal->noise : 0;
    if (goal->noise > 0 && r->spp > 0) {
        n = fmin(n, 1.05 * r->spp * (ratio * ratio - 1));
    }
    n = fmin(n, (double)goal->spp - r->spp);
    return n > 2 ? (uint32_t)n : 2; // one sample has no standard error
}

static int allocate(app *a, const tyn_view *view, bench_reference *r)
{
    r->file = (tyn_image_file){.width = view->width, .height = view->height};
    r->image = (metrics_image){.width = view->width, .height = view->height};
    r->known_noise = true;
    r->file.channels = calloc(6, sizeof *r->file.channels);
    for (int i = 0; r->file.channels && i < 6; i++) {
        tyn_channel *channel = &r->file.channels[r->file.num_channels];
        snprintf(channel->name, sizeof channel->name, "%s", bench_reference_channels[i]);
        channel->data = calloc((size_t)view->width * view->height, sizeof(float));
        r->file.num_channels += channel->data != NULL;
        *(i < 3 ? &r->image.rgb[i] : &r->image.se[i - 3]) = channel->data;
    }
    return r->file.num_channels == 6 ? EXIT_DONE : app_exit_code(a, TYN_ERR_MEMORY, false);
}

static void merge(bench_reference *r, const float *planes, uint32_t samples)
{
    const size_t num = (size_t)r->file.width * r->file.height;
    const double before = r->spp, all = before + samples;
    for (int i = 0; i < 3; i++) {
        float *mean = tyn_image_file_channel(&r->file, bench_reference_channels[i]);
        float *error = tyn_image_file_channel(&r->file, bench_reference_channels[3 + i]);
        const float *more = planes + i * num, *spread = planes + (3 + i) * num;
        for (size_t k = 0; k < num; k++) {
            mean[k] = (float)((before * mean[k] + samples * (double)more[k]) / all);
            error[k] = (float)(hypot(before * error[k], samples * (double)spread[k]) / all);
        }
    }
    r->spp += samples;
}

int converge(app *a, const bench_machine *on, const method *m, const tyn_scene *scene,
             const tyn_view *asked, const bench_goal *goal, const char *name, converge_keep keep,
             void *user, bench_reference *r)
{
    tyn_view view = *asked;
    view.outputs = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_ERROR;
    int code = r->file.channels ? EXIT_DONE : allocate(a, &view, r);
    float *planes = malloc(6 * sizeof *planes * view.width * view.height);
    if (code != EXIT_DONE || !planes) {
        free(planes);
        return app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    renderer renders = {0};
    code = renderer_open(a, on->device, m, &renders);
    uint32_t done = 0;
    double took = 0, unkept = 0;
    while (code == EXIT_DONE && !converge_is_done(r, goal)) {
        char label[160];
        snprintf(label, sizeof label, "%.80s: reference, %u samples", name, r->spp);
        view.num_samples = next_round(r, goal, done, took);
        view.seed = BENCH_REFERENCE_SEED + r->spp; // a run's samples must not be the reference's
        const double start = device_seconds(on);
        code = renderer_frame(a, &renders, scene, &view, true, label);
        if (code == EXIT_DONE) {
            metrics_image image;
            bench_planes(renders.offline, &view, planes, &image);
            merge(r, planes, view.num_samples);
            bench_reference_measure(r);
            const double seconds = device_seconds(on) - start;
            r->seconds += seconds;
            unkept += seconds;
            done += view.num_samples;
            took += seconds;
            if (unkept >= round_seconds || converge_is_done(r, goal)) {
                code = keep(user, r);
                unkept = 0;
            }
        }
    }
    renderer_close(&renders);
    free(planes);
    return code;
}
