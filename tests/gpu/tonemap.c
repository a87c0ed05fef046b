// tonemap.c -- the display transform against its formulas.
#include "bound.h"
#include "gpu_test.h"
#include "passes/tonemap/tonemap.h"
#include <math.h>
#include <stdlib.h>

enum { W = 64, H = 64 };

static double srgb(double x)
{
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}

static double filmic(double x)
{
    x *= 0.6;
    return fmin(fmax(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0), 1);
}

static const uint8_t *display(gpu_test *t, const float *radiance, tyn_tonemap_params params)
{
    tyn_graph_begin(t->graph);
    tyn_ref refs[TONEMAP_NUM_PORTS] = {
        gpu_image(t, "radiance", TYN_IMAGE_2D, (tyn_extent){W, H, 1}, 4, radiance)};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_tonemap, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "display", refs[TONEMAP_PORT_DISPLAY], true);
    gpu_run(t);
    return gpu_map(t, "display");
}

// A ramp over twelve stops.
static void ramp(float *radiance)
{
    for (int i = 0; i < W * H; i++) {
        for (int c = 0; c < 3; c++) {
            radiance[4 * i + c] =
                exp2f(12.0f * (float)i / (W * H) - 8.0f) * (1.0f - 0.2f * (float)c);
        }
        radiance[4 * i + 3] = 0.5f;
    }
}

static void curves(void **state)
{
    static float radiance[W * H * 4];
    ramp(radiance);
    for (int k = 0; k < 4; k++) {
        double (*const curve[])(double) = {filmic, NULL};
        tyn_tonemap_params params = {.curve = k & 1, .exposure_ev = k & 2 ? -1.5f : 0, .opaque = 1};
        const uint8_t *out = display(*state, radiance, params);
        for (int i = 0; i < W * H * 4; i++) {
            double x = radiance[i] * exp2(params.exposure_ev);
            x = k & 1 ? fmin(x, 1) : curve[0](x);
            double expected = i % 4 == 3 ? 255 : 255 * srgb(x);
            assert_true(fabs(out[i] - expected) <= 0.52);
        }
    }
}

// Dither moves a value by at most one step and keeps the mean.
static void dither(void **state)
{
    static float radiance[W * H * 4];
    for (int i = 0; i < W * H * 4; i++) {
        radiance[i] = 0.05f;
    }
    const uint8_t *out =
        display(*state, radiance, (tyn_tonemap_params){.curve = TONEMAP_CURVE_LINEAR, .dither = 1});
    double exact = 255 * srgb(0.05 / 0.05), sum = 0; // alpha 0.05: straight colour is 1
    for (int i = 0; i < W * H; i++) {
        sum += out[4 * i];
        assert_true(abs(out[4 * i] - (int)exact) <= 1);
    }
    for (int i = 0; i < W * H; i++) {
        radiance[4 * i + 3] = 1;
    }
    out =
        display(*state, radiance, (tyn_tonemap_params){.curve = TONEMAP_CURVE_LINEAR, .dither = 1});
    exact = 255 * srgb(0.05);
    sum = 0;
    for (int i = 0; i < W * H; i++) {
        sum += out[4 * i];
        assert_true(fabs(out[4 * i] - exact) <= 1);
    }
    assert_within(fabs(sum / (W * H) - exact), 4e-3, NULL);
}

static void extremes(void **state)
{
    static float radiance[W * H * 4];
    const float values[] = {0, 1e-30f, 1e30f, 65504, 3};
    for (int i = 0; i < W * H * 4; i++) {
        radiance[i] = i % 4 == 3 ? 1 : values[i / 4 % 5];
    }
    const uint8_t *out = display(*state, radiance, (tyn_tonemap_params){.exposure_ev = 20});
    for (int i = 0; i < W * H; i++) {
        assert_int_equal(out[4 * i], i % 5 < 2 ? 0 : 255);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(curves), cmocka_unit_test(dither),
                                       cmocka_unit_test(extremes)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
