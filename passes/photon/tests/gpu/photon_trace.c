// photon_trace.c -- photons alone: Beer's law in every cell, what media absorb, generations, the same each time.
#include "bound.h"
#include "path_scene.h"
#include "passes/photon/photon_trace/photon_trace.h"
#include "passes/photon/common/photon_args.h"
#include "numbers.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 8, N = CELLS * CELLS * CELLS, GENERATIONS = 4, SLOTS = GENERATIONS + 1, LOBES = 2 };
enum { SUN, SKY }; // lobes

typedef struct ring {
    struct photon_ring head;
    int32_t words[SLOTS][LOBES][N][4];
} ring;

static tyn_photon_trace_params params;
static ring found;
static int32_t flux[SLOTS][LOBES][N][4];

static void set_params(const path_scene *s, float power)
{
    tyn_pass_defaults(&tyn_pass_photon_trace, &params);
    params.shape =
        (tyn_lattice_shape){.extent = {1, 1, 1}, .cells = CELLS, .channels = 3, .tint = {1, 1, 1}};
    params.generations = GENERATIONS;
    params.photons = 16384;
    params.similarity = TYN_PHOTON_SIMILARITY_OFF;
    params.first = TYN_PHOTON_FIRST_CACHE;
    params.mean = TYN_PHOTON_MEAN_VOLUME;
    params.lobes = LOBES;
    params.sky_first = 1;
    params.scaled = 1;
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
    refs[PHOTON_TRACE_PORT_FLUX] =
        tyn_graph_history_buffer(t->graph, "flux", tyn_photon_flux_size(&params), key);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_photon_trace, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "flux", refs[PHOTON_TRACE_PORT_FLUX], true);
    tyn_graph_output(t->graph, "ring", refs[PHOTON_TRACE_PORT_RING], true);
    tyn_graph_output(t->graph, "counters", refs[PHOTON_TRACE_PORT_COUNTERS], true);
    gpu_run(t);
    const struct counters_block *counters = gpu_map(t, "counters");
    assert_int_equal(counters->non_finite + counters->cut, 0);
    memcpy(&found, gpu_map(t, "ring"), sizeof found);
    memcpy(flux, gpu_map(t, "flux"), sizeof flux);
}

// Fluence of a cell over the first generations, W/m^2.
static double fluence_of(uint32_t cell, uint32_t lobe, uint32_t channel)
{
    double sum = 0;
    for (int g = 0; g < GENERATIONS; g++) {
        sum += found.words[g][lobe][cell][channel];
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
                    sum += fluence_of(i * CELLS + (uint32_t)x, SUN, c) / (N / CELLS);
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
            const int32_t *w = found.words[0][SUN][i], *f = flux[0][SUN][i];
            const double mean = ((double)w[0] + w[1] + w[2]) / 3;
            assert_true(fabs(f[0] - mean) <= 1e-3 * mean + 2.0 * f[PHOTON_COUNT] + 4);
            assert_true(w[PHOTON_ORDER] == 0 && f[1] == 0 && f[2] == 0);
            assert_true(found.words[0][SKY][i][0] == 0 && flux[0][SKY][i][PHOTON_COUNT] == 0);
        }
    }
    assert_true(right);
}

static void light_cube(path_scene *s, bool sky)
{
    if (sky) {
        path_scene_sky(s, 0.5f);
    } else {
        path_scene_sun(s, (float[]){1, 0, 0}, (float[]){1, 1, 1});
    }
}

// What is absorbed is sigma_a times fluence: as much as is missing of what leaves (path_fluxes); with beams of
// a medium that is delta scaled.
static void energy(void **state)
{
    static const struct {
        int32_t similarity;
        bool beams;
        double bound;
    } runs[] = {{TYN_PHOTON_SIMILARITY_OFF, false, 0.005},
                {TYN_PHOTON_SIMILARITY_USUAL, false, 0.02},
                {TYN_PHOTON_SIMILARITY_OFF, true, 0.005},
                {TYN_PHOTON_SIMILARITY_USUAL, true, 0.02}};
    bool right = true;
    for (int lit = 0; lit < 3; lit++) {
        for (size_t k = 0; k < sizeof runs / sizeof runs[0]; k++) {
            path_scene s, scaled;
            const bool sky = lit == 1;
            const float g = lit == 2 ? 0.96f : 0.85f, sigma_s = (1 - g * g) * 12;
            path_scene_cube(&s, 12, 0.5f, g, true);
            path_scene_cube(&scaled, sigma_s, 0.5f, g / (1 + g), true);
            light_cube(&s, sky);
            light_cube(&scaled, sky);
            const tyn_fluxes *f = path_scene_fluxes(*state, runs[k].beams ? &scaled : &s, 1 << 17);
            const double left = f->mean.reflected[1] + f->mean.transmitted[1],
                         sent = f->mean.incident[1], se = f->se.absorbed_media[1];
            set_params(&s, 16);
            params.similarity = runs[k].similarity;
            params.reduced = params.similarity ? (0.5f + (1 - g) * 12) / 12.5f : 1;
            double absorbed = 0;
            if (runs[k].beams) { // delta scaled; what has not scattered is the march's
                const double sigma_t = 0.5 + (double)sigma_s;
                params.first = TYN_PHOTON_FIRST_BEAMS;
                params.scaled = (float)sigma_t / 12.5f;
                params.reduced = params.similarity ? params.reduced : params.scaled;
                params.mean = TYN_PHOTON_MEAN_MEDIUM; // the same where the medium is
                params.majorant = (float)sigma_t;
                params.marched[0] = 1;
                absorbed = sky ? 0 : 0.5 * (1 - exp(-sigma_t)) / sigma_t;
            }
            run(*state, &s, (uint64_t)(20 + 4 * lit) + k);
            for (uint32_t i = 0; i < N; i++) {
                absorbed += 0.5 * fluence_of(i, sky ? SKY : SUN, 1) / N;
            }
            const double off = fabs(absorbed + left - sent) / sent;
            printf("%s, g %.2f, %s, similarity %d: absorbed %.4f, left %.4f of %.4f W (+- %.4f): "
                   "%.2f %%\n",
                   sky ? "sky" : "sun", (double)g, runs[k].beams ? "beams" : "cache",
                   (int)runs[k].similarity, absorbed, left, sent, se, 100 * off);
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
            absorbed += sigma * fluence_of(i, SKY, c) / N;
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
        count += flux[slot][SUN][i][PHOTON_COUNT];
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
            sums[0] += found.words[g][SUN][i][0];
            sums[1] += found.words[g][SUN][i][1];
        }
        assert_near(sums[1] / sums[0], g == kept ? 1 : 2, 0.01);
    }
}

// No ring is larger than what every device binds, whatever is asked for.
static void rings(void **state)
{
    (void)state;
    static const struct {
        int cells, generations, lobes; // lobes that fit
    } cases[] = {{16, 100, 20}, {32, 100, 2},  {64, 30, 1},
                 {64, 100, 0},  {64, 1000, 0}, {4, 1000, 130}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        tyn_photon_trace_params p;
        tyn_pass_defaults(&tyn_pass_photon_trace, &p);
        p.shape = (tyn_lattice_shape){.extent = {1, 1, 1}, .cells = cases[k].cells};
        p.generations = cases[k].generations;
        p.lobes = (int32_t)tyn_photon_most_lobes(&p);
        assert_int_equal(p.lobes, cases[k].lobes);
        assert_true(tyn_photon_ring_size(&p) <= PHOTON_MOST_BYTES);
        p.lobes++;
        assert_true(tyn_photon_ring_size(&p) > PHOTON_MOST_BYTES);
    }
}

// True if it is refused with this in the line that says why.
static bool is_refused(gpu_test *t, path_scene *s, const char *why)
{
    tyn_ref refs[PHOTON_TRACE_NUM_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    path_scene_declare(t, s, refs);
    refs[PHOTON_TRACE_PORT_RING] = tyn_graph_history_buffer(t->graph, "ring", 64, 1);
    refs[PHOTON_TRACE_PORT_FLUX] = tyn_graph_history_buffer(t->graph, "flux", 64, 1);
    t->quiet = true;
    const tyn_result result = tyn_graph_add(t->graph, &tyn_pass_photon_trace, &params, refs);
    t->quiet = false;
    const bool said = result == TYN_ERR_PARAMS && strstr(t->last_error, why);
    t->errors = 0;
    return said;
}

// As many dispatches and as much memory as there is room for.
static void refused(void **state)
{
    path_scene s;
    path_scene_cube(&s, 2, 0, 0.5f, true);
    set_params(&s, 2);
    params.batch = 64;
    assert_true(is_refused(*state, &s, "more than 512 dispatches"));
    set_params(&s, 2);
    params.shape.cells = 64;
    params.generations = 100;
    assert_true(is_refused(*state, &s, "are more than 128 MiB"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(beer),    cmocka_unit_test(energy),
                                       cmocka_unit_test(colours), cmocka_unit_test(generations),
                                       cmocka_unit_test(rings),   cmocka_unit_test(refused)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
