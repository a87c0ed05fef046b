// refine.c -- the fit of samples on layers, where the answer is known: samples that are layers times coefficients, samples that say
// nothing new, noise, and what is not finite.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "passes/refined/refine/refine.h"
#include "shaders/common/counters.h"
#include "shaders/common/scene_args.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 128 };

static float base[MOST * MOST][4], single[MOST * MOST][4], samples[MOST * MOST][4];

static double random_one(void)
{
    return (double)rand() / RAND_MAX;
}

// Standard normal.
static double random_normal(void)
{
    return sqrt(-2 * log(random_one() + 1e-12)) * cos(6.2831853 * random_one());
}

typedef struct fit_case {
    uint32_t width, height, grid;
    float margin;
} fit_case;

// A picture with an edge and waves, and its single scattering.
static void make_layers(const fit_case *f)
{
    for (uint32_t y = 0; y < f->height; y++) {
        for (uint32_t x = 0; x < f->width; x++) {
            float *b = base[y * f->width + x], *s = single[y * f->width + x];
            const float wave = 0.5f + 0.4f * sinf(0.23f * (float)x) * cosf(0.31f * (float)y);
            for (int c = 0; c < 3; c++) {
                s[c] = (x + y > (f->width + f->height) / 2 ? 0.4f : 0.1f) * (1 + 0.2f * (float)c);
                b[c] = s[c] + wave * (0.6f + 0.3f * (float)c);
            }
            b[3] = 0.75f;
            s[3] = 1;
        }
    }
}

// Of a square of grid x grid pixels, the mean of factor x base + part x single, with `noise` of the base.
static void make_samples(const fit_case *f, double (*factor)(double), double part, double noise)
{
    const uint32_t w = (f->width + f->grid - 1) / f->grid, h = (f->height + f->grid - 1) / f->grid;
    for (uint32_t i = 0; i < w * h; i++) {
        double sum[3] = {0, 0, 0}, own[3] = {0, 0, 0}, pixels = 0;
        for (uint32_t k = 0; k < f->grid * f->grid; k++) {
            const uint32_t x = i % w * f->grid + k % f->grid, y = i / w * f->grid + k / f->grid;
            if (x >= f->width || y >= f->height) {
                continue;
            }
            const uint32_t p = y * f->width + x;
            for (int c = 0; c < 3; c++) {
                sum[c] +=
                    factor((x + 0.5) / f->width) * (double)base[p][c] + part * (double)single[p][c];
                own[c] += (double)base[p][c];
            }
            pixels++;
        }
        for (int c = 0; c < 3; c++) {
            samples[i][c] = (float)((sum[c] + noise * random_normal() * own[c]) / pixels);
        }
        samples[i][3] = 1;
    }
}

static tyn_refine_params params_of(const fit_case *f)
{
    tyn_refine_params params;
    tyn_pass_defaults(&tyn_pass_refine, &params);
    params.grid = (int32_t)f->grid;
    params.margin = f->margin;
    params.carry = 0;
    params.picture[0] = f->width;
    params.picture[1] = f->height;
    return params;
}

// What is kept from picture to picture.
static void add_kept(gpu_test *t, const tyn_refine_params *params, tyn_ref *refs)
{
    static const char *const names[] = {"kept", "carried"};
    for (int i = 0; i < 2; i++) {
        refs[REFINE_PORT_KEPT + i] =
            tyn_graph_history_image(t->graph, names[i], TYN_IMAGE_2D, VK_FORMAT_R32G32B32A32_SFLOAT,
                                    tyn_refine_kept(params), 1);
    }
    refs[REFINE_PORT_SEEN] =
        tyn_graph_history_buffer(t->graph, "seen", sizeof(struct camera_block), 1);
}

static const float (*run(gpu_test *t, const fit_case *f))[4]
{
    const tyn_refine_params params = params_of(f);
    const tyn_extent size = {f->width, f->height, 1};
    const tyn_extent sampled = {(f->width + f->grid - 1) / f->grid,
                                (f->height + f->grid - 1) / f->grid, 1};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    refs[REFINE_PORT_BASE] = gpu_image(t, "base", TYN_IMAGE_2D, size, 4, base[0]);
    refs[REFINE_PORT_SINGLE] = gpu_image(t, "single", TYN_IMAGE_2D, size, 4, single[0]);
    refs[REFINE_PORT_SAMPLES] = gpu_image(t, "samples", TYN_IMAGE_2D, sampled, 4, samples[0]);
    add_kept(t, &params, refs);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_refine, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "radiance", refs[REFINE_PORT_RADIANCE], true);
    tyn_graph_output(t->graph, "error", refs[REFINE_PORT_ERROR], true);
    tyn_graph_output(t->graph, "bias", refs[REFINE_PORT_BIAS], true);
    tyn_graph_output(t->graph, "counters", refs[REFINE_PORT_COUNTERS], true);
    gpu_run(t);
    return (const float(*)[4])gpu_map(t, "radiance");
}

// Relative L1 from factor x base + part x single, of the picture and of the base.
static double off_by(const fit_case *f, const float (*picture)[4], double (*factor)(double),
                     double part)
{
    double error = 0, sum = 0;
    for (uint32_t p = 0; p < f->width * f->height; p++) {
        for (int c = 0; c < 3; c++) {
            const double x = (p % f->width + 0.5) / f->width;
            const double truth = factor(x) * (double)base[p][c] + part * (double)single[p][c];
            error += fabs((double)picture[p][c] - truth);
            sum += fabs(truth);
        }
        assert_true(picture[p][3] == base[p][3]);
    }
    return error / sum;
}

static double same(double x)
{
    (void)x;
    return 1;
}

static double brighter(double x)
{
    (void)x;
    return 1.3;
}

static double ramp(double x)
{
    return 0.8 + 0.5 * x;
}

static const fit_case cases[] = {{64, 64, 1, 1}, {128, 96, 2, 1}, {101, 67, 4, 1}, {37, 29, 2, 1}};
enum { CASES = sizeof cases / sizeof *cases };

// Coefficients that are the same everywhere are found, whatever the sizes.
static void layers_times_coefficients(void **state)
{
    for (int i = 0; i < CASES; i++) {
        make_layers(&cases[i]);
        make_samples(&cases[i], brighter, -0.4, 0);
        assert_true(within(off_by(&cases[i], run(*state, &cases[i]), brighter, -0.4), 1e-3, NULL,
                           "coefficients found, relative L1"));
    }
}

static void make_black(int channel)
{
    for (uint32_t p = 0; p < MOST * MOST; p++) {
        base[p][channel] = single[p][channel] = samples[p][channel] = 0;
    }
}

// Root mean square of a layer.
static double size_of(gpu_test *t, const char *layer, const fit_case *f)
{
    const float(*v)[4] = (const float(*)[4])gpu_map(t, layer);
    double sum = 0;
    for (uint32_t i = 0; i < 3 * f->width * f->height; i++) {
        assert_true(isfinite(v[i / 3][i % 3]));
        sum += (double)v[i / 3][i % 3] * (double)v[i / 3][i % 3];
    }
    return sqrt(sum / (3 * f->width * f->height));
}

// Light of one colour is refined as any other, and of a black picture too the errors are numbers.
static void black_channels(void **state)
{
    const fit_case *f = &cases[1];
    make_layers(f);
    make_samples(f, brighter, -0.4, 0);
    make_black(1);
    assert_true(within(off_by(f, run(*state, f), brighter, -0.4), 3e-4, NULL,
                       "coefficients found without green, relative L1"));
    const double error = size_of(*state, "error", f), bias = size_of(*state, "bias", f);
    assert_true(error < 0.1 * bias);
    make_black(0);
    make_black(2);
    run(*state, f);
    size_of(*state, "error", f);
    size_of(*state, "bias", f);
}

// Samples that say what the picture says change no bit of it.
static void nothing_new(void **state)
{
    for (int i = 0; i < CASES; i++) {
        make_layers(&cases[i]);
        memcpy(samples, base, sizeof samples);
        if (cases[i].grid == 1) {
            const float(*picture)[4] = run(*state, &cases[i]);
            assert_memory_equal(picture, base, sizeof(float[4]) * cases[i].width * cases[i].height);
        }
    }
}

// Without samples the picture stays, and its error is the known share.
static void no_samples(void **state)
{
    gpu_test *t = *state;
    const fit_case *f = &cases[2];
    make_layers(f);
    tyn_refine_params params = params_of(f);
    params.known = 0.25f;
    const tyn_extent size = {f->width, f->height, 1};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    refs[REFINE_PORT_BASE] = gpu_image(t, "base", TYN_IMAGE_2D, size, 4, base[0]);
    add_kept(t, &params, refs);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_refine, &params, refs), TYN_OK);
    static const char *const names[] = {"radiance", "error", "bias"};
    for (int k = 0; k < 3; k++) {
        static const int ports[] = {REFINE_PORT_RADIANCE, REFINE_PORT_ERROR, REFINE_PORT_BIAS};
        tyn_graph_output(t->graph, names[k], refs[ports[k]], true);
    }
    gpu_run(t);
    assert_memory_equal(gpu_map(t, "radiance"), base, sizeof(float[4]) * f->width * f->height);
    for (int k = 1; k < 3; k++) {
        const float(*error)[4] = (const float(*)[4])gpu_map(t, names[k]);
        for (uint32_t i = 0; i < 3 * f->width * f->height; i++) {
            assert_true(error[i / 3][i % 3] == 0.25f * base[i / 3][i % 3]);
        }
    }
}

// Coefficients that change across the picture.
static void a_ramp(void **state)
{
    const fit_case *f = &cases[1];
    make_layers(f);
    make_samples(f, ramp, 0, 0);
    assert_true(
        within(off_by(f, run(*state, f), ramp, 0), 6e-3, NULL, "a ramp found, relative L1"));
    make_samples(f, ramp, 0, 0.5);
    assert_true(within(off_by(f, run(*state, f), ramp, 0), 0.04, NULL,
                       "a ramp in noise of .5 a sample, relative L1"));
}

// Noise alone is not taken for a difference.
static void noise_alone(void **state)
{
    double sum = 0, worst = 0;
    srand(7);
    for (int k = 0; k < 8; k++) {
        make_layers(&cases[0]);
        make_samples(&cases[0], same, 0, 1);
        const double off = off_by(&cases[0], run(*state, &cases[0]), same, 0);
        sum += off / 8;
        worst = maximum(worst, off);
    }
    assert_true(within(sum, 0.01, NULL, "noise of 1 a sample alone, mean relative L1"));
    assert_true(within(worst, 0.02, NULL, "noise of 1 a sample alone, worst relative L1"));
}

// After the camera has moved by some cells, what was found lies as many cells beside; what comes into view is unknown.
static void carried_over(void **state)
{
    enum { N = 64, CELLS = N / 2, ROW = 2 * CELLS, BY = 5 };
    gpu_test *t = *state;
    const fit_case f = {N, N, 1, 1};
    const tyn_extent size = {N, N, 1};
    static float found[4 * CELLS * CELLS][4];
    make_layers(&f);
    make_samples(&f, ramp, -0.4, 0.5);
    struct camera_block camera = {.orthographic = 1,
                                  .right = {1, 0, 0},
                                  .half_width = 1,
                                  .up = {0, 1, 0},
                                  .half_height = 1,
                                  .forward = {0, 0, -1},
                                  .size = {N, N}};
    tyn_refine_params params = params_of(&f);
    params.carry = params.begins = 1;
    for (int a = 0; a < 3; a++) {
        params.lo[a] = -1;
        params.hi[a] = 1;
    }
    for (int picture = 0; picture < 2; picture++) {
        camera.origin[0] = 2.0f * BY * (float)picture / CELLS;
        tyn_ref refs[TYN_MAX_PORTS] = {{0}};
        tyn_graph_begin(t->graph);
        refs[REFINE_PORT_BASE] = gpu_image(t, "base", TYN_IMAGE_2D, size, 4, base[0]);
        refs[REFINE_PORT_SINGLE] = gpu_image(t, "single", TYN_IMAGE_2D, size, 4, single[0]);
        refs[REFINE_PORT_SAMPLES] = gpu_image(t, "samples", TYN_IMAGE_2D, size, 4, samples[0]);
        refs[REFINE_PORT_CAMERA] = gpu_buffer(t, "camera", &camera, sizeof camera);
        add_kept(t, &params, refs);
        assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_refine, &params, refs), TYN_OK);
        tyn_graph_output(t->graph, "kept", refs[REFINE_PORT_KEPT], true);
        tyn_graph_output(t->graph, "carried", refs[REFINE_PORT_CARRIED], true);
        gpu_run(t);
        if (picture == 0) {
            memcpy(found, gpu_map(t, "kept"), sizeof found);
        }
    }
    const float(*carried)[4] = (const float(*)[4])gpu_map(t, "carried");
    for (int i = 0; i < 4 * CELLS * CELLS; i++) {
        const int x = i % ROW % CELLS;
        for (int c = 0; c < 4; c++) {
            const float right = x + BY < CELLS ? found[i + BY][c] : 0;
            assert_true(fabsf(carried[i][c] - right) <= 1e-4f);
        }
    }
}

static void not_finite(void **state)
{
    make_layers(&cases[0]);
    make_samples(&cases[0], brighter, 0, 0);
    samples[17][1] = NAN;
    samples[1234][0] = INFINITY;
    const double off = off_by(&cases[0], run(*state, &cases[0]), brighter, 0);
    assert_int_equal(gpu_non_finite(*state), 2);
    assert_true(within(off, 2e-4, NULL, "two samples not finite, relative L1"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_times_coefficients),
        cmocka_unit_test(black_channels),
        cmocka_unit_test(nothing_new),
        cmocka_unit_test(no_samples),
        cmocka_unit_test(a_ramp),
        cmocka_unit_test(noise_alone),
        cmocka_unit_test(carried_over),
        cmocka_unit_test(not_finite),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
