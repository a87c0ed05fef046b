// photon_trace.c -- photons alone: Beer's law in every cell, what media absorb, generations, the same each time.
#include "bound.h"
#include "path_scene.h"
#include "passes/photon_trace/photon_trace.h"
#include "shaders/photon/photon_args.h"
#include "numbers.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 8, N = CELLS * CELLS * CELLS, GENERATIONS = 4, SLOTS = GENERATIONS + 1 };

typedef struct ring {
    struct photon_ring head;
    int32_t words[SLOTS][N][PHOTON_WORDS];
} ring;

static tyn_photon_trace_params params;
static ring found;

static void set_params(const path_scene *s, float power)
{
    tyn_pass_defaults(&tyn_pass_photon_trace, &params);
    params.shape =
        (tyn_lattice_shape){.extent = {1, 1, 1}, .cells = CELLS, .channels = 3, .tint = {1, 1, 1}};
    params.generations = GENERATIONS;
    params.photons = 16384;
    params.similarity = TYN_PHOTON_SIMILARITY_OFF;
    params.path = s->params;
    params.path.box[1][0] = params.path.box[1][1] = params.path.box[1][2] = 1;
    params.sun[0] = 1;
    params.sun_cosine = 1 - 1e-5f;
    params.power = power;
    params.reduced = 1;
    params.batch = 8192;
    params.settles = GENERATIONS - 1;
}

// Goes on with the ring of `key`, or starts one.
static void run(gpu_test *t, path_scene *s, uint64_t key)
{
    tyn_ref refs[PHOTON_TRACE_NUM_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    path_scene_declare(t, s, refs);
    assert_int_equal(tyn_photon_ring_size(&params), sizeof found);
    refs[PHOTON_TRACE_PORT_RING] =
        tyn_graph_history_buffer(t->graph, "ring", tyn_photon_ring_size(&params), key);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_photon_trace, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "ring", refs[PHOTON_TRACE_PORT_RING], true);
    tyn_graph_output(t->graph, "counters", refs[PHOTON_TRACE_PORT_COUNTERS], true);
    gpu_run(t);
    const struct counters_block *counters = gpu_map(t, "counters");
    assert_int_equal(counters->non_finite + counters->cut, 0);
    memcpy(&found, gpu_map(t, "ring"), sizeof found);
}

// Fluence of a cell over the first generations, W/m^2.
static double fluence_of(uint32_t cell, uint32_t word)
{
    double sum = 0;
    for (int g = 0; g < GENERATIONS; g++) {
        sum += found.words[g][cell][word];
    }
    return sum / GENERATIONS / (double)tyn_photon_units(&params) * N;
}

// A cube that absorbs, in the sun along +x: e^-tau in each layer of cells, whenever beams end, by chance or not.
static void beer(void **state)
{
    static const struct {
        float stop;
        bool roulette;
        double bound;
    } ends[] = {{1, true, 0.03}, {0.05f, true, 0.006}, {0.5f, true, 0.008}, {0.01f, false, 0.006}};
    path_scene s;
    path_scene_cube(&s, 0, 2, 0, true);
    path_scene_sun(&s, (float[]){1, 0, 0}, (float[]){1, 2, 3});
    bool right = true;
    for (size_t k = 0; k < sizeof ends / sizeof ends[0]; k++) {
        set_params(&s, 4);
        params.stop = ends[k].stop;
        params.roulette = ends[k].roulette;
        run(*state, &s, 10 + k);
        assert_int_equal(found.head.turns, GENERATIONS);
        double worst = 0;
        for (int x = 0; x < CELLS; x++) {
            const double a = (double)x / CELLS, b = (x + 1.0) / CELLS;
            const double mean = (exp(-2 * a) - exp(-2 * b)) / (2 * (b - a));
            for (uint32_t c = 0; c < 3; c++) {
                double sum = 0;
                for (uint32_t i = 0; i < N / CELLS; i++) {
                    sum += fluence_of(i * CELLS + (uint32_t)x, PHOTON_SUN + c) / (N / CELLS);
                }
                worst = maximum(worst, fabs(sum / ((c + 1) * mean) - 1));
            }
        }
        printf("beams end at %g%s: largest error of a layer %.2f %%\n", (double)ends[k].stop,
               ends[k].roulette ? " by chance" : "", 100 * worst);
        right =
            within(worst, ends[k].bound, BOUND_NOISE, "layers, stop %g", (double)ends[k].stop) &&
            right;
        for (uint32_t i = 0; i < N; i++) { // it has not turned, and none of it is the sky's
            const int32_t *w = found.words[0][i];
            const double mean = ((double)w[0] + w[1] + w[2]) / 3;
            assert_true(fabs(w[PHOTON_COSINE] - mean) <= 1e-3 * mean + 2.0 * w[PHOTON_COUNT] + 4);
            assert_true(w[PHOTON_SKY] == 0 && w[PHOTON_ORDER] == 0 && w[PHOTON_FLUX] == 0);
        }
    }
    assert_true(right);
}

// What is absorbed is sigma_a times fluence: as much as is missing of what leaves (path_fluxes).
static void energy(void **state)
{
    static const struct {
        int32_t similarity;
        double bound;
    } runs[] = {{TYN_PHOTON_SIMILARITY_OFF, 0.005}, {TYN_PHOTON_SIMILARITY_USUAL, 0.02}};
    path_scene s;
    bool right = true;
    for (int lit = 0; lit < 3; lit++) {
        const bool sky = lit == 1;
        const float g = lit == 2 ? 0.96f : 0.85f;
        path_scene_cube(&s, 12, 0.5f, g, true);
        if (sky) {
            path_scene_sky(&s, 0.5f);
        } else {
            path_scene_sun(&s, (float[]){1, 0, 0}, (float[]){1, 1, 1});
        }
        const tyn_fluxes *f = path_scene_fluxes(*state, &s, 1 << 17);
        const double left = f->mean.reflected[1] + f->mean.transmitted[1],
                     sent = f->mean.incident[1], se = f->se.absorbed_media[1];
        for (size_t k = 0; k < sizeof runs / sizeof runs[0]; k++) {
            set_params(&s, 16);
            params.similarity = runs[k].similarity;
            params.reduced = params.similarity ? (0.5f + (1 - g) * 12) / 12.5f : 1;
            run(*state, &s, (uint64_t)(20 + 2 * lit) + k);
            double absorbed = 0;
            for (uint32_t i = 0; i < N; i++) {
                absorbed += 0.5 * fluence_of(i, sky ? PHOTON_SKY + 1 : PHOTON_SUN + 1) / N;
            }
            const double off = fabs(absorbed + left - sent) / sent;
            printf("%s, g %.2f, similarity %d: absorbed %.4f, left %.4f of %.4f W (+- %.4f): %.2f "
                   "%%\n",
                   sky ? "sky" : "sun", (double)g, (int)runs[k].similarity, absorbed, left, sent,
                   se, 100 * off);
            right = within(off, runs[k].bound, BOUND_NOISE, "energy, similarity %d",
                           (int)runs[k].similarity) &&
                    right;
        }
    }
    assert_true(right);
}

// Coloured media and a lamp in the middle: photons of all channels together.
static void colours(void **state)
{
    static const float ones[8] = {1, 1, 1, 1, 1, 1, 1, 1};
    path_scene s;
    path_scene_box(&s, (float[]){1, 1, 1}, (float[]){0, 0, 0}, (float[]){0.5f, 1, 2},
                   (float[]){0, 0, 0}, ones, (uint32_t[]){2, 2, 2});
    s.params.grey = 0;
    path_scene_lamp(&s, (float[]){0.5f, 0.5f, 0.5f}, (float[]){1, 1, 1});
    set_params(&s, 16);
    run(*state, &s, 30);
    // Of the light within 0.5 m all directions are alike; beyond the cube's corners: by quadrature.
    for (uint32_t c = 0; c < 3; c++) {
        const double sigma = 0.5 * (1 << c);
        double absorbed = 0, expected = 0;
        for (uint32_t i = 0; i < N; i++) {
            absorbed += sigma * fluence_of(i, PHOTON_SKY + c) / N;
        }
        enum { M = 200 };
        for (int i = 0; i < M * 2 * M; i++) {
            const double z = 1 - 2 * (i / (2 * M) + 0.5) / M, phi = M_PI * (i % (2 * M) + 0.5) / M;
            const double r = sqrt(1 - z * z), x = fabs(r * cos(phi)), y = fabs(r * sin(phi));
            const double far = 0.5 / fmax(fmax(x, y), fabs(z));
            expected += 4 * M_PI / (2.0 * M * M) * (1 - exp(-sigma * far));
        }
        printf("lamp, sigma_a %.1f: absorbed %.4f of %.4f\n", sigma, absorbed, expected);
        assert_within(fabs(absorbed / expected - 1), 0.006, BOUND_NOISE);
    }
}

static int32_t slot_count(uint32_t slot)
{
    int32_t count = 0;
    for (uint32_t i = 0; i < N; i++) {
        count += found.words[slot][i][PHOTON_COUNT];
    }
    return count;
}

// A ring that is started is filled; after a change a slot at a time is renewed, and then nothing runs. Bytes are the same in
// another ring.
static void generations(void **state)
{
    gpu_test *t = *state;
    path_scene s;
    path_scene_cube(&s, 2, 0, 0.5f, true);
    path_scene_sun(&s, (float[]){1, 0, 0}, (float[]){1, 1, 1});
    set_params(&s, 2);
    run(t, &s, 40);
    static ring first;
    memcpy(&first, &found, sizeof first);
    run(t, &s, 41);
    assert_memory_equal(&first, &found, sizeof first);
    for (uint32_t g = 0; g < GENERATIONS; g++) {
        assert_true(slot_count(g) > 16384 / 2);
    }
    assert_int_equal(slot_count(GENERATIONS), 0);
    run(t, &s, 41); // nothing has changed
    assert_memory_equal(&first, &found, sizeof first);
    // Another strength: four frames, in which all slots but one are made anew.
    s.lights[0].color[1] = 2;
    static const uint32_t turns[] = {5, 6, 7, 8, 8, 8};
    for (size_t k = 0; k < sizeof turns / sizeof turns[0]; k++) {
        run(t, &s, 41);
        assert_int_equal(found.head.turns, turns[k]);
    }
    assert_int_equal(found.head.first, 7);
    assert_int_equal(found.head.count, 1);
    const uint32_t kept = 3; // generation 3: 4 to 7 are in slots 4, 0, 1, 2
    assert_memory_equal(first.words[kept], found.words[kept], sizeof first.words[kept]);
    for (uint32_t g = 0; g < SLOTS; g++) {
        double sums[2] = {0, 0};
        for (uint32_t i = 0; i < N; i++) {
            sums[0] += found.words[g][i][PHOTON_SUN];
            sums[1] += found.words[g][i][PHOTON_SUN + 1];
        }
        assert_near(sums[1] / sums[0], g == kept ? 1 : 2, 0.01);
    }
}

// As many dispatches as there is room for.
static void refused(void **state)
{
    gpu_test *t = *state;
    path_scene s;
    path_scene_cube(&s, 2, 0, 0.5f, true);
    set_params(&s, 2);
    params.batch = 64;
    tyn_ref refs[PHOTON_TRACE_NUM_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    path_scene_declare(t, &s, refs);
    refs[PHOTON_TRACE_PORT_RING] =
        tyn_graph_history_buffer(t->graph, "ring", tyn_photon_ring_size(&params), 1);
    t->quiet = true;
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_photon_trace, &params, refs),
                     TYN_ERR_PARAMS);
    t->quiet = false;
    assert_non_null(strstr(t->last_error, "more than 512 dispatches"));
    t->errors = 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(beer), cmocka_unit_test(energy),
                                       cmocka_unit_test(colours), cmocka_unit_test(generations),
                                       cmocka_unit_test(refused)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
