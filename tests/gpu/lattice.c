// lattice.c -- the lattice solver on the device against its twin on the CPU.
#include "bound.h"
#include "gpu_test.h"
#include "llc_twin.h"
#include "shaders/common/scene_args.h"
#include "passes/lattice/lattice.h"
#include "numbers.h"
#include "random_unit.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- running the pass on what twins hold --------------------------------------------------------

typedef struct run {
    float *moments; // of the device: [channel][cell][4]
    float *leaks;   // [channel]: sum
    double ms;
} run;

// One twin per channel, all of one size; what enters at the box is that of the first.
static run run_pass(gpu_test *t, const llc_twin *twins, uint32_t channels, int sweeps)
{
    const llc_twin *first = &twins[0];
    const int *n = first->n;
    size_t cells = (size_t)n[0] * n[1] * n[2];
    tyn_extent texels = {(uint32_t)n[0], (uint32_t)n[1], (uint32_t)n[2] * channels};
    float *cell = calloc(cells * channels * 4, 4), *source = calloc(cells * channels * 4, 4);
    for (uint32_t ch = 0; ch < channels; ch++) {
        for (size_t i = 0; i < cells; i++) {
            const llc_twin *w = &twins[ch];
            const double c[4] = {w->sigma_s[i], w->sigma_a[i], w->g[i], w->emission[i]};
            for (int k = 0; k < 4; k++) {
                cell[(ch * cells + i) * 4 + k] = (float)c[k];
                source[(ch * cells + i) * 4 + k] = (float)w->beam[i][k];
            }
        }
    }
    struct env_block env = {
        .sky = {(float)first->boundary, (float)first->boundary, (float)first->boundary}};
    tyn_lattice_params params;
    tyn_pass_defaults(&tyn_pass_lattice, &params);
    params.shape.cells = n[0] > n[1] ? n[0] : n[1];
    params.shape.cells = params.shape.cells > n[2] ? params.shape.cells : n[2];
    for (int a = 0; a < 3; a++) {
        params.shape.extent[a] = (float)(n[a] * first->dx);
        params.shape.tint[a] = 1;
    }
    params.shape.channels = channels;
    params.sweeps = sweeps;
    params.cycles = first->cycles;
    params.anderson = first->anderson;

    tyn_graph_begin(t->graph);
    tyn_ref refs[64] = {
        [LATTICE_PORT_CELLS] = gpu_image(t, "cells", TYN_IMAGE_3D, texels, 4, cell),
        [LATTICE_PORT_SOURCE] = gpu_image(t, "source", TYN_IMAGE_3D, texels, 4, source),
        [LATTICE_PORT_ENVIRONMENT] = gpu_buffer(t, "environment", &env, sizeof env),
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_lattice, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "moments", refs[LATTICE_PORT_MOMENTS], true);
    tyn_graph_output(t->graph, "leaks", refs[LATTICE_PORT_LEAKS], true);
    gpu_run(t);
    run r = {.moments = malloc(cells * channels * 16), .leaks = calloc(channels, 4)};
    memcpy(r.moments, gpu_map(t, "moments"), cells * channels * 16);
    tyn_extent bytes;
    const float *leaks = tyn_graph_map(t->graph, "leaks", &bytes, NULL);
    size_t per_channel = bytes.x / 4 / channels;
    for (size_t i = 0; i < per_channel * channels; i++) {
        r.leaks[i / per_channel] += leaks[i];
    }
    r.ms = gpu_ms(t, "lattice");
    free(cell);
    free(source);
    return r;
}

static void run_free(run *r)
{
    free(r->moments);
    free(r->leaks);
}

// Largest difference of a moment, over the largest fluence.
static double difference(const llc_twin *w, const float *moments)
{
    size_t cells = (size_t)w->n[0] * w->n[1] * w->n[2];
    double most = 0, scale = 0;
    for (size_t i = 0; i < cells; i++) {
        scale = fmax(scale, fabs(w->m[i][0]));
        for (int k = 0; k < 4; k++) {
            double d = fabs(moments[i * 4 + k] - w->m[i][k]);
            most = maximum(most, d);
        }
    }
    return most / scale;
}

// Hands the device's solution to the twin, to ask it for the balance.
static double imbalance(llc_twin *w, const float *moments, float leak)
{
    size_t cells = (size_t)w->n[0] * w->n[1] * w->n[2];
    for (size_t i = 0; i < cells * 4; i++) {
        w->m[i / 4][i % 4] = moments[i];
    }
    w->leak = leak;
    return llc_twin_imbalance(w);
}

// ---- media --------------------------------------------------------------------------------------

// Homogeneous, with a beam along +z.
static void fill_homogeneous(llc_twin *w, double sigma_s, double sigma_a, double g)
{
    double f = g > 0 ? g * g : 0, s = (1 - f) * sigma_s, tau = (s + sigma_a) * w->dx;
    int plane = w->n[0] * w->n[1];
    for (int i = 0; i < plane * w->n[2]; i++) {
        w->sigma_s[i] = s;
        w->sigma_a[i] = sigma_a;
        w->g[i] = (g - f) / (1 - f);
        w->beam[i][0] = exp(-tau * (i / plane)) * (tau > 0 ? -expm1(-tau) / tau : 1);
        w->beam[i][3] = w->beam[i][0];
    }
}

static void fill_random(llc_twin *w, uint32_t seed)
{
    for (int i = 0; i < w->n[0] * w->n[1] * w->n[2]; i++) {
        bool empty = random_unit(&seed) < 0.3;
        w->sigma_s[i] = empty ? 0 : 6 * random_unit(&seed);
        w->sigma_a[i] = empty ? 0 : random_unit(&seed);
        w->g[i] = 0.9 * random_unit(&seed) - 0.3;
        w->emission[i] = empty ? 0 : 0.1 * random_unit(&seed);
        w->beam[i][0] = random_unit(&seed);
        w->beam[i][1] = 0.6 * w->beam[i][0];
        w->beam[i][3] = -0.8 * w->beam[i][0];
    }
}

// ---- tests --------------------------------------------------------------------------------------

static void matches_twin(void **state)
{
    // Odd sizes; more than one level outside the workgroup; one workgroup alone; thin boxes.
    static const int sizes[][3] = {{13, 9, 7}, {24, 25, 17}, {16, 16, 16}, {33, 5, 1}, {1, 1, 40}};
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        llc_twin twins[3];
        for (uint32_t ch = 0; ch < 3; ch++) {
            llc_twin_init(&twins[ch], sizes[s][0], sizes[s][1], sizes[s][2], 0.125);
            twins[ch].cycles = 2;
            twins[ch].anderson = s % 2;
            twins[ch].boundary = 0.25;
            fill_random(&twins[ch], 17 * ch + (uint32_t)s);
        }
        run r = run_pass(*state, twins, 3, 4);
        for (uint32_t ch = 0; ch < 3; ch++) {
            size_t cells = (size_t)sizes[s][0] * sizes[s][1] * sizes[s][2];
            llc_twin_solve(&twins[ch], 4);
            double d = difference(&twins[ch], r.moments + ch * cells * 4);
            double leak = fabs(r.leaks[ch] - twins[ch].leak) / (1 + fabs(twins[ch].leak));
            printf("%d x %d x %d, channel %u: moments %.1e, leak %.1e\n", sizes[s][0], sizes[s][1],
                   sizes[s][2], ch, d, leak);
            // Mixing divides by differences of almost equal sweeps; without it rounding stays
            // rounding.
            assert_true(twins[ch].anderson ? within(d, 2e-3, BOUND_ROUNDING, "Anderson mixing")
                                           : d < 2e-5);
            assert_true(leak < 1e-5);
            llc_twin_finish(&twins[ch]);
        }
        run_free(&r);
    }
}

// Inside a uniform environment a medium that only scatters is invisible: phi = 4 pi L, no flux.
static void furnace(void **state)
{
    llc_twin w;
    llc_twin_init(&w, 20, 17, 12, 0.25);
    fill_random(&w, 5);
    for (int i = 0; i < 20 * 17 * 12; i++) {
        w.sigma_a[i] = w.emission[i] = 0;
        memset(w.beam[i], 0, sizeof w.beam[i]);
    }
    w.boundary = 2;
    run r = run_pass(*state, &w, 1, 3);
    for (int i = 0; i < 20 * 17 * 12; i++) {
        assert_true(fabs(r.moments[4 * i] / (4 * M_PI * 2) - 1) < 1e-5);
        for (int k = 1; k < 4; k++) {
            assert_true(fabs(r.moments[4 * i + k]) < 1e-4);
        }
    }
    run_free(&r);
    llc_twin_finish(&w);
}

// What the beam scatters leaves the box or is absorbed: <= 1 % is missing after 4 sweeps, <= 0.3 %
// after 6.
static void conserves(void **state)
{
    static const double media[][3] = {
        {4, 0, 0},     {4, 0, 0.6},    {4, 0, 0.9},      {3.6, 0.4, 0.9},
        {50, 0, 0},    {50, 0, 0.9},   {49.5, 0.5, 0.9}, {4, 0, -0.5},
        {1e-6, 0, .5}, {4e-6, 4, 0.5}, {400, 0, 0.9999},
    };
    for (size_t m = 0; m < sizeof media / sizeof media[0]; m++) {
        for (int sweeps = 4; sweeps <= 6; sweeps += 2) {
            llc_twin w;
            llc_twin_init(&w, 24, 24, 24, 1.0 / 24);
            fill_homogeneous(&w, media[m][0], media[m][1], media[m][2]);
            run r = run_pass(*state, &w, 1, sweeps);
            double missing = imbalance(&w, r.moments, r.leaks[0]);
            printf("sigma_s %g, sigma_a %g, g %g: %d sweeps, imbalance %.1e\n", media[m][0],
                   media[m][1], media[m][2], sweeps, missing);
            assert_true(fabs(missing) < (sweeps == 4 ? 0.01 : 0.003));
            run_free(&r);
            llc_twin_finish(&w);
        }
    }
}

// The same input gives the same bits: no sum depends on which thread came first.
static void deterministic(void **state)
{
    llc_twin w;
    llc_twin_init(&w, 24, 19, 21, 0.125);
    run runs[3];
    for (int i = 0; i < 3; i++) {
        fill_random(&w, i == 1 ? 8 : 7); // another medium in between, or nothing would be run again
        runs[i] = run_pass(*state, &w, 1, 4);
    }
    size_t bytes = (size_t)24 * 19 * 21 * 16;
    assert_int_equal(memcmp(runs[0].moments, runs[2].moments, bytes), 0);
    assert_int_not_equal(memcmp(runs[0].moments, runs[1].moments, bytes), 0);
    for (int i = 0; i < 3; i++) {
        run_free(&runs[i]);
    }
    llc_twin_finish(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matches_twin),
        cmocka_unit_test(furnace),
        cmocka_unit_test(conserves),
        cmocka_unit_test(deterministic),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
