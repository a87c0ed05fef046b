// photon_cache.c -- the sum of generations: what comes is added, what goes is taken out, and nothing is left of it.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "passes/photon_cache/photon_cache.h"
#include "shaders/common/counters.h"
#include "shaders/common/scene_args.h"
#include "shaders/photon/photon_args.h"
#include <stdlib.h>
#include <string.h>

enum { X = 4, Y = 2, Z = 3, N = X * Y * Z, M = 5, EACH = 2, SLOTS = M + EACH };

static struct {
    struct photon_ring head;
    int32_t words[SLOTS][N][PHOTON_WORDS];
} ring;

static int32_t history[64][N][PHOTON_WORDS]; // all generations ever

static const tyn_photon_cache_params params = {
    .shape = {.extent = {4, 2, 2.5f}, .cells = X, .channels = 3, .tint = {1, 1, 1}},
    .generations = M,
    .slots = SLOTS,
    .sun = {0, 0.6f, 0.8f},
    .unit = 0.25f,
};

// So many generations more.
static void trace(uint32_t count)
{
    ring.head.first = ring.head.turns;
    ring.head.count = count;
    for (uint32_t k = 0; k < count; k++, ring.head.turns++) {
        const uint32_t turn = ring.head.turns;
        for (uint32_t i = 0; i < N * PHOTON_WORDS; i++) {
            const uint32_t word = i % PHOTON_WORDS;
            const bool is_signed =
                word == PHOTON_COSINE || (word >= PHOTON_FLUX && word < PHOTON_COUNT);
            history[turn][i / PHOTON_WORDS][word] =
                is_signed ? rand() % 400 - 200 : 100 + rand() % 900;
        }
        memcpy(ring.words[turn % SLOTS], history[turn], sizeof history[turn]);
    }
}

typedef struct sums {
    struct photon_sum head;
    int32_t words[N][PHOTON_WORDS];
} sums;

static const sums *run(gpu_test *t)
{
    struct medium_block medium = {.extent = {4, 2, 2.5f}};
    tyn_ref refs[PHOTON_CACHE_NUM_PORTS] = {
        [PHOTON_CACHE_PORT_SUM] = (tyn_ref){0},
    };
    tyn_graph_begin(t->graph);
    refs[PHOTON_CACHE_PORT_MEDIUM] = gpu_buffer(t, "medium", &medium, sizeof medium);
    refs[PHOTON_CACHE_PORT_RING] = gpu_buffer(t, "ring", &ring, sizeof ring);
    refs[PHOTON_CACHE_PORT_SUM] = tyn_graph_history_buffer(t->graph, "sum", sizeof(sums), 1);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_photon_cache, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "sum", refs[PHOTON_CACHE_PORT_SUM], true);
    tyn_graph_output(t->graph, "light", refs[PHOTON_CACHE_PORT_LIGHT], true);
    tyn_graph_output(t->graph, "moments", refs[PHOTON_CACHE_PORT_MOMENTS], true);
    tyn_graph_output(t->graph, "counters", refs[PHOTON_CACHE_PORT_COUNTERS], true);
    gpu_run(t);
    return gpu_map(t, "sum");
}

static int64_t expected(uint32_t cell, uint32_t word)
{
    int64_t sum = 0;
    const uint32_t turns = ring.head.turns;
    for (uint32_t turn = turns > M ? turns - M : 0; turn < turns; turn++) {
        sum += history[turn][cell][word];
    }
    return sum;
}

static void check_sums(gpu_test *t)
{
    const sums *s = run(t);
    assert_int_equal(s->head.turns, ring.head.turns);
    for (uint32_t i = 0; i < N; i++) {
        for (uint32_t w = 0; w < PHOTON_WORDS; w++) {
            assert_int_equal(s->words[i][w], expected(i, w));
        }
    }
}

// What the cells' words mean: fluence over the part of a cell in the box, cosines, depth, net flux.
static void check_light(gpu_test *t)
{
    const struct photon_light *light = gpu_map(t, "light");
    const float(*moments)[4] = (const float(*)[4])gpu_map(t, "moments");
    double worst = 0;
    for (uint32_t i = 0; i < N; i++) {
        double w[PHOTON_WORDS];
        for (uint32_t k = 0; k < PHOTON_WORDS; k++) {
            w[k] = (double)expected(i, k);
        }
        // Three layers of 1 m hold 2.5 m: the outer two have 0.75 m in the box.
        const double volume = i / (X * Y) == 1 ? 1 : 0.75, scale = 0.25 / M / volume;
        const double sun = (w[0] + w[1] + w[2]) / 3, sky = (w[4] + w[5] + w[6]) / 3;
        const double cosine = w[PHOTON_COSINE] / sun;
        worst = maximum(worst, fabs((double)light[i].sun[1] / (scale * w[1]) - 1));
        worst = maximum(worst, fabs((double)light[i].sky[2] / (scale * w[6]) - 1));
        worst = maximum(worst, fabs((double)light[i].cosine - cosine));
        worst = maximum(
            worst,
            fabs((double)light[i].order - PHOTON_ORDER_UNIT * w[PHOTON_ORDER] / (sun + sky)) / 16);
        for (int a = 0; a < 3; a++) {
            worst = maximum(worst, fabs((double)light[i].way[a] - w[PHOTON_FLUX + a] / sky));
            const float *m = moments[N + i]; // green
            const double flux =
                scale * (w[1] * cosine * (double)params.sun[a] + w[5] * w[PHOTON_FLUX + a] / sky);
            worst = maximum(worst, fabs((double)m[1 + a] - flux) / (scale * (w[1] + w[5])));
            worst = maximum(worst, fabs((double)m[0] / (scale * (w[1] + w[5])) - 1));
        }
        assert_near((double)light[i].count, w[PHOTON_COUNT], 0.5);
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
}

// Where a generation brings more than a cell can sum up it is bounded, and counted.
static void bounded(void **state)
{
    memset(&ring, 0, sizeof ring);
    ring.head.turns = 60;
    for (int g = 0; g < SLOTS; g++) {
        ring.words[g][3][0] = 2000000000;
    }
    const sums *s = run(*state);
    assert_int_equal(s->words[3][0], M * (2000000000 / M));
    const struct counters_block *counters = gpu_map(*state, "counters");
    assert_int_equal(counters->clamped, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sums_of_generations),
                                       cmocka_unit_test(bounded)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
