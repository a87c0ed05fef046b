// shdom.c -- the solver on a lattice of given cells: light deep inside a medium, light of a thin one, and two runs give the
// same bytes.
//
// Without sources from outside the cells emit. Where each emits what it takes away, radiance deep inside is that of an
// unbounded medium, emission / absorption, for any number of bands and any phase function.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "passes/shdom/shdom/shdom.h"
#include "shaders/common/counters.h"
#include "shaders/common/scene_args.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { N = 12, CELLS = N * N * N };

static const struct medium_block medium = {
    .extent = {1, 1, 1}, .size = {1, 1, 1}, .num_shapes = 1, .voxel = {1, 1, 1}, .max_density = 1};
static float cells[CELLS][4];

// A lattice of the unit cube: sigma_s, sigma_a and g without delta scaling, emission.
static void fill(float sigma_s, float sigma_a, float g, float emission)
{
    for (int i = 0; i < CELLS; i++) {
        cells[i][0] = sigma_s * (1 - (g > 0 ? g * g : 0));
        cells[i][1] = sigma_a;
        cells[i][2] = g > 0 ? g / (1 + g) : g;
        cells[i][3] = emission;
    }
}

typedef struct outcome {
    float moments[CELLS][4];
} outcome;

static void run(gpu_test *t, int bands, int iterations, outcome *o)
{
    const tyn_lattice_shape shape = {
        .extent = {1, 1, 1}, .cells = N, .channels = 1, .tint = {1, 0.5f, 0.25f}};
    tyn_graph_begin(t->graph);
    const tyn_ref block = gpu_buffer(t, "medium", &medium, sizeof medium);
    const tyn_ref image =
        gpu_image(t, "cells", TYN_IMAGE_3D, (tyn_extent){N, N, N}, 4, &cells[0][0]);
    tyn_shdom_params p;
    tyn_pass_defaults(&tyn_pass_shdom, &p);
    p.shape = shape;
    p.bands = bands;
    p.iterations = iterations;
    tyn_ref a[SHDOM_NUM_PORTS] = {[SHDOM_PORT_MEDIUM] = block, [SHDOM_PORT_CELLS] = image};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_shdom, &p, a), TYN_OK);
    tyn_graph_output(t->graph, "moments", a[SHDOM_PORT_MOMENTS], true);
    tyn_graph_output(t->graph, "counters", a[SHDOM_PORT_COUNTERS], true);
    gpu_run(t);
    memcpy(o->moments, gpu_map(t, "moments"), sizeof o->moments);
    assert_int_equal(gpu_non_finite(t), 0);
}

static int cell_at(int x, int y, int z)
{
    return (z * N + y) * N + x;
}

// Deep inside a medium of depth 24 the radiance is emission / absorption.
static void deep_inside(void **state)
{
    static const float gs[] = {0, 0.7f, -0.4f};
    static const int bands[] = {1, 3, 7};
    outcome *o = malloc(sizeof *o);
    double fluence = 0, flux = 0;
    for (int i = 0; i < 3; i++) {
        fill(14, 10, gs[i], 20);
        run(*state, bands[i], 24, o);
        const float *m = o->moments[cell_at(N / 2, N / 2, N / 2)];
        fluence = maximum(fluence, fabs((double)m[0] / (8 * PI) - 1));
        for (int k = 1; k < 4; k++) {
            flux = maximum(flux, fabs((double)m[k] / (8 * PI)));
        }
        print_message("g %4.1f, %d bands: fluence %.5f\n", (double)gs[i], bands[i],
                      (double)m[0] / (8 * PI));
    }
    assert_within(fluence, 0.003, NULL);
    assert_within(flux, 3e-4, NULL);
    free(o);
}

// Emission of a thin medium that does not scatter: the fluence in the middle of the cube is the mean way to its faces.
static void thin(void **state)
{
    fill(0, 1e-3f, 0, 1);
    outcome *o = malloc(sizeof *o);
    run(*state, 6, 1, o);
    // Integral of the distance from the middle of a cell next to the cube's middle to the faces, over directions.
    double sum = 0;
    enum { M = 400 };
    const double p = (N / 2 + 0.5) / N;
    for (int i = 0; i < M * M; i++) {
        const double z = 2 * (i / M + 0.5) / M - 1, phi = 2 * PI * (i % M + 0.5) / M;
        const double d[3] = {sqrt(1 - z * z) * cos(phi), sqrt(1 - z * z) * sin(phi), z};
        double way = 2;
        for (int a = 0; a < 3; a++) {
            const double face = d[a] > 0 ? (1 - p) / d[a] : p / -d[a];
            way = face < way ? face : way;
        }
        sum += way * 4 * PI / (M * M);
    }
    const double found = (double)o->moments[cell_at(N / 2, N / 2, N / 2)][0];
    print_message("thin: fluence %.5f of %.5f\n", found, sum);
    assert_within(fabs(found / sum - 1), 0.04, NULL);
    free(o);
}

// Sums are in a fixed order.
static void same_bytes(void **state)
{
    fill(9, 1, 0.6f, 1);
    for (int i = 0; i < CELLS; i++) {
        cells[i][0] *= (float)(i * 7 % 11) / 5;
    }
    outcome *o = malloc(2 * sizeof *o);
    run(*state, 4, 5, &o[0]);
    fill(1, 1, 0, 1); // something else in between
    run(*state, 2, 1, &o[1]);
    fill(9, 1, 0.6f, 1);
    for (int i = 0; i < CELLS; i++) {
        cells[i][0] *= (float)(i * 7 % 11) / 5;
    }
    run(*state, 4, 5, &o[1]);
    assert_memory_equal(&o[0], &o[1], sizeof *o);
    free(o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(deep_inside),
        cmocka_unit_test(thin),
        cmocka_unit_test(same_bytes),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
