// photon_cache.c -- the sum of generations: what comes is added, what goes is taken out, and nothing is left of it.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "passes/photon/photon_cache/photon_cache.h"
#include "shaders/common/counters.h"
#include "shaders/common/scene_args.h"
#include "passes/photon/common/photon_args.h"
#include <stdlib.h>
#include <string.h>

enum { X = 4, Y = 2, Z = 3, N = X * Y * Z, LOBES = 3, QUADS = LOBES * N, M = 5, EACH = 2 };
enum { SLOTS = M + EACH };

static struct {
    struct photon_ring head;
    int32_t words[SLOTS][QUADS][4];
} ring;
static int32_t flux[SLOTS][QUADS][4];

static int32_t history[64][2][QUADS][4]; // all generations ever
static float medium_cells[N][4];         // of three channels the same: lattice_cells

static tyn_photon_cache_params params = {
    .shape = {.extent = {4, 2, 2.5f}, .cells = X, .channels = 3, .tint = {1, 1, 1}},
    .generations = M,
    .slots = SLOTS,
    .lobes = LOBES,
    .unit = 0.25f,
};

// So many generations more.
static void trace(uint32_t count)
{
    ring.head.first = ring.head.turns;
    ring.head.count = count;
    for (uint32_t k = 0; k < count; k++, ring.head.turns++) {
        const uint32_t turn = ring.head.turns;
        for (uint32_t i = 0; i < 2 * QUADS * 4; i++) {
            const uint32_t quad = i / (QUADS * 4), word = i % 4;
            const bool is_signed = quad == 1 && word < PHOTON_COUNT;
            history[turn][quad][i / 4 % QUADS][word] =
                is_signed ? rand() % 200 - 100 : 100 + rand() % 900;
        }
        memcpy(ring.words[turn % SLOTS], history[turn][0], sizeof history[turn][0]);
        memcpy(flux[turn % SLOTS], history[turn][1], sizeof history[turn][1]);
    }
}

typedef struct sums {
    struct photon_sum head;
    int32_t words[2][QUADS][4];
} sums;

static const sums *run(gpu_test *t)
{
    struct medium_block medium = {.extent = {4, 2, 2.5f}};
    tyn_ref refs[PHOTON_CACHE_NUM_PORTS] = {
        [PHOTON_CACHE_PORT_SUM] = (tyn_ref){0},
    };
    tyn_graph_begin(t->graph);
    refs[PHOTON_CACHE_PORT_MEDIUM] = gpu_buffer(t, "medium", &medium, sizeof medium);
    static float cells[3][N][4];
    for (int c = 0; c < 3; c++) {
        memcpy(cells[c], medium_cells, sizeof medium_cells);
    }
    refs[PHOTON_CACHE_PORT_RING] = gpu_buffer(t, "ring", &ring, sizeof ring);
    refs[PHOTON_CACHE_PORT_FLUX] = gpu_buffer(t, "flux", flux, sizeof flux);
    refs[PHOTON_CACHE_PORT_CELLS] =
        gpu_image(t, "cells", TYN_IMAGE_3D, (tyn_extent){X, Y, 3 * Z}, 4, cells[0][0]);
    refs[PHOTON_CACHE_PORT_SUM] = tyn_graph_history_buffer(t->graph, "sum", sizeof(sums), 1);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_photon_cache, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "sum", refs[PHOTON_CACHE_PORT_SUM], true);
    tyn_graph_output(t->graph, "light", refs[PHOTON_CACHE_PORT_LIGHT], true);
    tyn_graph_output(t->graph, "moments", refs[PHOTON_CACHE_PORT_MOMENTS], true);
    tyn_graph_output(t->graph, "counters", refs[PHOTON_CACHE_PORT_COUNTERS], true);
    gpu_run(t);
    return gpu_map(t, "sum");
}

static int64_t expected(uint32_t k, uint32_t quad, uint32_t word)
{
    int64_t sum = 0;
    const uint32_t turns = ring.head.turns;
    for (uint32_t turn = turns > M ? turns - M : 0; turn < turns; turn++) {
        sum += history[turn][k][quad][word];
    }
    return sum;
}

static void check_sums(gpu_test *t)
{
    const sums *s = run(t);
    assert_int_equal(s->head.turns, ring.head.turns);
    for (uint32_t i = 0; i < 2 * QUADS * 4; i++) {
        const uint32_t k = i / (QUADS * 4), quad = i / 4 % QUADS;
        assert_int_equal(s->words[k][quad][i % 4], expected(k, quad, i % 4));
    }
}

// What the cells' words mean: fluence over the part of a cell in the box, or over its medium; depth, net flux.
static void check_light(gpu_test *t)
{
    const struct photon_light *light = gpu_map(t, "light");
    const float(*moments)[4] = (const float(*)[4])gpu_map(t, "moments");
    double worst = 0;
    for (uint32_t i = 0; i < N; i++) {
        // Three layers of 1 m hold 2.5 m: the outer two have 0.75 m in the box.
        double measure = i / (X * Y) == 1 ? 1 : 0.75, all = 0, net[3] = {0, 0, 0};
        if (params.majorant > 0) {
            measure =
                ((double)medium_cells[i][0] + (double)medium_cells[i][1]) / (double)params.majorant;
        }
        const double scale = 0.25 / M / measure;
        for (uint32_t lobe = 0; lobe < LOBES; lobe++) {
            const uint32_t quad = lobe * N + i;
            double w[8];
            for (uint32_t k = 0; k < 8; k++) {
                w[k] = (double)expected(k / 4, quad, k % 4);
            }
            const struct photon_light *l = &light[quad];
            const double mean = (w[0] + w[1] + w[2]) / 3;
            worst = maximum(worst, fabs((double)l->fluence[1] / (scale * w[1]) - 1));
            worst = maximum(worst, fabs((double)l->order - PHOTON_ORDER_UNIT * w[3] / mean) / 16);
            all += scale * w[1];
            for (int a = 0; a < 3; a++) {
                worst = maximum(worst, fabs((double)l->way[a] - w[4 + a] / mean));
                net[a] += scale * w[1] * w[4 + a] / mean;
            }
            assert_near((double)l->count, w[7], 0.5);
        }
        const float *m = moments[N + i]; // green
        worst = maximum(worst, fabs((double)m[0] / all - 1));
        for (int a = 0; a < 3; a++) {
            worst = maximum(worst, fabs((double)m[1 + a] - net[a]) / all);
        }
    }
    assert_true(worst < 1e-5);
}

static void sums_of_generations(void **state)
{
    srand(5);
    memset(&ring, 0, sizeof ring);
    trace(M);
    check_sums(*state);
    check_light(*state);
    trace(1);
    check_sums(*state);
    trace(EACH);
    check_sums(*state);
    for (int k = 0; k < 10; k++) {
        trace(1 + (uint32_t)k % EACH);
        check_sums(*state);
    }
    trace(EACH + 1); // some were missed
    check_sums(*state);
    check_light(*state);
    for (int i = 0; i < N; i++) { // delta scaled
        medium_cells[i][0] = 1 + (float)rand() / (float)RAND_MAX;
        medium_cells[i][1] = (float)rand() / (float)RAND_MAX;
        medium_cells[i][2] = 0.4f;
    }
    params.majorant = 4;
    params.scaled = 1;
    check_sums(*state);
    check_light(*state);
    params.majorant = 0;
}

// Where a generation brings more than a cell can sum up it is bounded, and counted.
static void bounded(void **state)
{
    memset(&ring, 0, sizeof ring);
    memset(flux, 0, sizeof flux);
    ring.head.turns = 60;
    for (int g = 0; g < SLOTS; g++) {
        ring.words[g][3][0] = 2000000000;
    }
    const sums *s = run(*state);
    assert_int_equal(s->words[0][3][0], M * (2000000000 / M));
    const struct counters_block *counters = gpu_map(*state, "counters");
    assert_int_equal(counters->clamped, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sums_of_generations),
                                       cmocka_unit_test(bounded)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
