// measure.c -- error, times and nodes of a run; what a baseline needs for the same error.
#include "bench.h"
#include "timing.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- a run ------------------------------------------------------------------------------------

static int compare_frame(bench_case *c, tyn_offline *offline, const tyn_view *view,
                         metrics errors[BENCH_BLOCKS])
{
    float *planes = malloc(6 * sizeof *planes * view->width * view->height);
    if (!planes) {
        return app_exit_code(c->a, TYN_ERR_MEMORY, false);
    }
    metrics_image image;
    bench_planes(offline, view, planes, &image);
    int code = EXIT_DONE;
    for (int i = 0; i < BENCH_BLOCKS && code == EXIT_DONE; i++) {
        if (metrics_compare(&image, &c->reference.image, c->blocks[i], &errors[i]) != METRICS_OK) {
            app_error(c->a, "%s: the reference is black; nothing can be relative to it",
                      c->spec->name);
            code = EXIT_WRONG;
        }
    }
    free(planes);
    return code;
}

// What of rel_l1 the noise of the reference does not explain.
static double without_reference(const metrics *m, double reference_noise)
{
    return sqrt(fmax(0, m->rel_l1 * m->rel_l1 - reference_noise * reference_noise));
}

// Transmittance below 0.99 is medium.
static void measure_fill(bench_case *c, tyn_offline *offline)
{
    const float *t = tyn_offline_output(offline, TYN_OUTPUT_TRANSMITTANCE);
    const size_t num = (size_t)c->view.width * c->view.height;
    size_t filled = 0;
    for (size_t i = 0; t && i < num; i++) {
        filled += t[4 * i] + t[4 * i + 1] + t[4 * i + 2] < 3 * 0.99f;
    }
    c->fill = t ? (double)filled / (double)num : c->fill;
}

static void take_nodes(tyn_offline *offline, bench_result *result)
{
    tyn_report report = {0};
    tyn_offline_report(offline, &report);
    result->persistent = report.persistent_bytes;
    result->transient = report.transient_bytes;
    result->num_nodes = 0;
    for (uint32_t i = 0; i < report.num_nodes && i < BENCH_MAX_NODES; i++) {
        const tyn_node_report *n = &report.nodes[i];
        bench_node *node = &result->nodes[result->num_nodes++];
        *node = (bench_node){.bytes = n->bytes, .gpu_ms = n->gpu_ms, .setup = n->media_only};
        snprintf(node->name, sizeof node->name, "%s", n->name);
        for (uint32_t k = 0; k < n->num_work; k++) {
            node->steps = strcmp(n->work[k].name, "steps") == 0 ? n->work[k].amount : node->steps;
        }
    }
}

// Cold frames: medians of the whole and of every node.
static int time_cold(bench_case *c, renderer *r, const tyn_view *view, bench_result *result)
{
    const uint32_t frames = c->suite->frames;
    double *whole = calloc(frames, sizeof *whole);
    double *nodes = calloc((size_t)frames * BENCH_MAX_NODES, sizeof *nodes);
    int code = whole && nodes ? EXIT_DONE : app_exit_code(c->a, TYN_ERR_MEMORY, false);
    for (uint32_t i = 0; i < frames && code == EXIT_DONE; i++) {
        code = renderer_frame(c->a, r, &c->scene, view, true, NULL);
        if (code == EXIT_DONE) {
            whole[i] = r->frame_ms;
            take_nodes(r->offline, result);
            for (uint32_t k = 0; k < result->num_nodes; k++) {
                nodes[k * frames + i] = result->nodes[k].gpu_ms;
            }
        }
    }
    if (code == EXIT_DONE) {
        result->cold_ms = timing_median(whole, frames);
        for (uint32_t k = 0; k < result->num_nodes; k++) {
            result->nodes[k].gpu_ms = timing_median(nodes + k * frames, frames);
        }
    }
    free(whole);
    free(nodes);
    return code;
}

static void take_states(tyn_offline *offline, bench_result *result)
{
    tyn_report report = {0};
    tyn_offline_report(offline, &report);
    for (uint32_t i = 0; i < report.num_nodes && i < result->num_nodes; i++) {
        snprintf(result->nodes[i].state, sizeof result->nodes[i].state, "%s",
                 report.nodes[i].state);
    }
}

static int time_frames(bench_case *c, renderer *r, const tyn_view *view, bench_result *result)
{
    const uint32_t frames = c->suite->frames;
    int code = time_cold(c, r, view, result);
    if (code == EXIT_DONE) {
        code =
            timing_run(c->a, r, &c->scene, view, TIMING_UNCHANGED, frames, &result->unchanged_ms);
    }
    if (code == EXIT_DONE) {
        code = timing_run(c->a, r, &c->scene, view, TIMING_CAMERA, frames, &result->camera_ms);
        take_states(r->offline, result);
    }
    return code;
}

int bench_measure(bench_case *c, const bench_run *run, bench_result *result)
{
    *result = (bench_result){.cold_ms = NAN, .camera_ms = NAN, .unchanged_ms = NAN};
    method m = {0};
    renderer r = {0};
    tyn_view view = c->view;
    method_view(&run->method, &view);
    int code = method_open(c->a, &run->method, &m);
    if (code == EXIT_DONE) {
        code = renderer_open(c->a, c->device, &m, &r);
    }
    bool opened = code == EXIT_DONE;
    if (opened) {
        // The picture, with the layers that tell how much of it the medium fills and how noisy it is.
        view.outputs |= m.info.outputs & (TYN_OUTPUT_TRANSMITTANCE | TYN_OUTPUT_ERROR);
        char label[128];
        snprintf(label, sizeof label, "%.50s: %.50s", c->spec->name, run->name);
        code = renderer_frame(c->a, &r, &c->scene, &view, false, label);
    }
    if (opened && code == EXIT_WRONG) { // this method cannot do this scene; others may
        result->failed = true;
        code = EXIT_DONE;
    } else if (code == EXIT_DONE) {
        measure_fill(c, r.offline);
        code = compare_frame(c, r.offline, &view, result->error);
        for (int i = 0; i < BENCH_BLOCKS; i++) { // a run's own noise is an error of it
            result->error[i].error = without_reference(&result->error[i], c->reference.noise[i]);
        }
        result->setup_ms = r.setup_ms;
        view.outputs = TYN_OUTPUT_RADIANCE;
        if (code == EXIT_DONE) {
            code = renderer_frame(c->a, &r, &c->scene, &view, true,
                                  NULL); // allocates for these outputs
        }
        if (code == EXIT_DONE) {
            code = time_frames(c, &r, &view, result);
        }
    }
    renderer_close(&r);
    method_finish(&m);
    return code;
}

// ---- baselines --------------------------------------------------------------------------------

static int render_baseline(bench_case *c, const bench_run *run, uint32_t spp, bench_sample *sample)
{
    method m = {0};
    renderer r = {0};
    metrics errors[BENCH_BLOCKS];
    tyn_view view = c->view;
    method_view(&run->method, &view);
    view.num_samples = spp;
    view.outputs = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_ERROR;
    int code = method_open(c->a, &run->method, &m);
    if (code == EXIT_DONE) {
        code = renderer_open(c->a, c->device, &m, &r);
    }
    if (code == EXIT_DONE) { // pipelines and memory
        view.num_samples = 1;
        code = renderer_frame(c->a, &r, &c->scene, &view, false, NULL);
        view.num_samples = spp;
    }
    if (code == EXIT_DONE) {
        char label[128];
        snprintf(label, sizeof label, "%.50s: %.50s, %u samples", c->spec->name, run->name, spp);
        code = renderer_frame(c->a, &r, &c->scene, &view, true, label);
    }
    if (code == EXIT_DONE) {
        code = compare_frame(c, r.offline, &view, errors);
    }
    if (code == EXIT_DONE) {
        *sample = (bench_sample){.spp = spp, .ms = r.frame_ms};
        for (int i = 0; i < BENCH_BLOCKS; i++) {
            sample->error[i] = without_reference(&errors[i], c->reference.noise[i]);
        }
    }
    renderer_close(&r);
    method_finish(&m);
    return code;
}

int bench_baseline_pilot(bench_case *c, const bench_run *run, bench_baseline *b)
{
    *b = (bench_baseline){0};
    return render_baseline(c, run, c->suite->pilot_spp, &b->pilot);
}

// Noise falls as 1 / sqrt(samples): from the error of a sample to another error.
static void by_the_rule(const bench_sample *sample, uint32_t block_index, double error,
                        bench_equal *equal)
{
    const double ratio = sample->error[block_index] / error, factor = ratio * ratio;
    equal->spp = sample->spp * factor;
    equal->ms = sample->ms * factor;
}

// The pilot tells by the rule how many samples are needed. As many are rendered as long as that is
// affordable, else as many as are: the rule then has less far to go than from the pilot, whose few
// samples have not met all of a long tail.
int bench_baseline_equal(bench_case *c, const bench_run *run, bench_baseline *b,
                         uint32_t block_index, double error, bench_equal *equal)
{
    *equal = (bench_equal){0};
    if (!(error > 0)) {
        return EXIT_DONE;
    }
    by_the_rule(&b->pilot, block_index, error, equal);
    const double affordable = 1e3 * c->suite->max_seconds * b->pilot.spp / b->pilot.ms;
    const double needed = fmax(1, round(equal->spp));
    bench_sample sample = {0};
    int code = EXIT_DONE;
    if (needed <= affordable) {
        code = render_baseline(c, run, (uint32_t)needed, &sample);
        equal->measured = code == EXIT_DONE;
    } else if (affordable > b->pilot.spp) {
        if (!b->longest.spp) {
            code = render_baseline(c, run, (uint32_t)affordable, &b->longest);
        }
        sample = b->longest;
    }
    if (sample.spp) {
        by_the_rule(&sample, block_index, error, equal);
    }
    return code;
}
