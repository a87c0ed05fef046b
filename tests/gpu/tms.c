// tms.c -- the table of light scattered from cones against the double precision series.
#include "bound.h"
#include "gpu_test.h"
#include "passes/scatter_lut/scatter_lut.h"
#include "lobe_series.h"
#include "numbers.h"
#include "point_pass.h"
#include "tms_eval.comp.h"
#include "random_unit.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

// ---- the table at points --------------------------------------------------------------------------

typedef struct point {
    float tau, mu, part;
    uint32_t channel;
    float g, tau_p;
} point;

static const float *evaluate(gpu_test *t, const tyn_scatter_lut_params *lut_params,
                             const point *points, uint32_t count, uint32_t mixed)
{
    static point_pass pass;
    static const point_input inputs[] = {{"tms", TYN_IMAGE_3D, TYN_USE_SAMPLED},
                                         {"lut_block", TYN_BUFFER, TYN_USE_UNIFORM}};
    point_pass_init(&pass, tms_eval_spirv, sizeof tms_eval_spirv, inputs, 2);
    tyn_graph_begin(t->graph);
    tyn_ref lut[SCATTER_LUT_NUM_PORTS] = {{0}}, refs[4] = {{0}};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_scatter_lut, lut_params, lut), TYN_OK);
    refs[0] = lut[SCATTER_LUT_PORT_TMS];
    refs[1] = lut[SCATTER_LUT_PORT_LUT_BLOCK];
    refs[2] = gpu_buffer(t, "points", points, count * sizeof *points);
    point_pass_params params = {count, sizeof(float), mixed, pass.results};
    assert_int_equal(tyn_graph_add(t->graph, &pass.desc, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "results", refs[3], true);
    gpu_run(t);
    return gpu_map(t, "results");
}

static double random_depth(double f, uint32_t *seed)
{
    return 4 * expm1(random_unit(seed) * log1p(15 / (1 - f) / 4));
}

static const float gs[][3] = {{-0.5f, 0, 0.3f}, {0.7f, 0.9f, 0.95f}, {0.99f, 0.99f, -0.9f}};
enum { SETS = sizeof gs / sizeof *gs, ANGLES = 60, DEPTHS = 6 };

// Points of one channel and cone: DEPTHS depths with ANGLES angles each.
static void fill_points(point *points, uint32_t channel, double g, double part, uint32_t *seed)
{
    for (int d = 0; d < DEPTHS; d++) {
        double tau = d == 0 ? 0 : random_depth(g > 0 ? g * g : 0, seed);
        for (int a = 0; a < ANGLES; a++) {
            double s = random_unit(seed), mu = 1 - 2 * s * s; // closer where it varies
            points[d * ANGLES + a] =
                (point){(float)tau, (float)(g < 0 ? -mu : mu), (float)part, channel, 0, 0};
        }
    }
}

// Largest error relative to the largest value at that depth. NaN and negative values count as 1e30.
static double worst_error(const lobe_series *s, const double *c, const point *points,
                          const float *got)
{
    double worst = 0;
    for (int d = 0; d < DEPTHS; d++) {
        double expected[ANGLES], peak = 0;
        for (int a = 0; a < ANGLES; a++) {
            expected[a] = lobe_kernel(s, c, points[d * ANGLES + a].tau, points[d * ANGLES + a].mu);
            peak = fmax(peak, expected[a]);
        }
        for (int a = 0; a < ANGLES; a++) {
            double value = got[d * ANGLES + a];
            double error = fabs(value - expected[a]) / peak;
            worst = maximum(worst, value >= 0 && error == error ? error : 1e30);
        }
    }
    return worst;
}

// At the cones that the table has everything is within 0.5 % of the peak; within 2 % where there is no
// cone, at the bends of the window, and where the cone is most of the sphere, the texels being wide at
// its edge. Between them the mix of two cones has softer edges. Strong backward peaks: three times that.
static void cones(void **state)
{
    gpu_test *t = *state;
    enum { CONES = 2 * TYN_TMS_CONES - 1 };
    static point points[3][CONES][DEPTHS * ANGLES];
    static lobe_series s;
    static double c[LOBE_TERMS];
    uint32_t seed = 5;
    for (int set = 0; set < SETS; set++) {
        tyn_scatter_lut_params params = {
            .mode = TYN_MEDIUM_DENSITY,
            .phase = {{.g = gs[set][0]}, {.g = gs[set][1]}, {.g = gs[set][2]}},
            .tms = 1};
        for (uint32_t ch = 0; ch < 3; ch++) {
            for (int i = 0; i < CONES; i++) {
                double sine = i / (CONES - 1.0);
                fill_points(points[ch][i], ch, gs[set][ch], sine * sine, &seed);
            }
        }
        const float *got = evaluate(t, &params, points[0][0], sizeof points / sizeof(point), 0);
        printf("built in %.2f ms\n", gpu_ms(t, "scatter_lut"));
        for (int ch = 0; ch < 3; ch++) {
            lobe_series_make(&s, gs[set][ch]);
            double at = 0, between = 0;
            for (int i = 0; i < CONES; i++) {
                lobe_cone(points[ch][i][0].part, s.terms, c);
                double error =
                    worst_error(&s, c, points[ch][i], got + (ch * CONES + i) * DEPTHS * ANGLES);
                float part = points[ch][i][0].part;
                bool sharp = part == 0 || part > 0.8f;
                if (i % 2 == 0) {
                    at = maximum(at, sharp ? error / 4 : error);
                } else if (!sharp) {
                    between = maximum(between, error);
                }
            }
            printf("g %5.2f: largest error %.3f %% of the peak; between cones %.2f %%\n", s.g,
                   100 * at, 100 * between);
            assert_true(within(at, s.g < -0.6 ? 0.015 : 0.005, NULL, "at cones, g %s -0.6",
                               s.g < -0.6 ? "below" : "from"));
            assert_true(within(between, s.g < -0.6 ? 0.15 : 0.04, NULL, "between cones, g %s -0.6",
                               s.g < -0.6 ? "below" : "from"));
        }
    }
}

// All directions together scatter everything, and the mean cosine is exact, for cones of any size.
static void sums_over_directions(void **state)
{
    gpu_test *t = *state;
    enum { CASES = 12, STEPS = 3000 };
    static point points[3][CASES][STEPS];
    static lobe_series s;
    uint32_t seed = 11;
    for (int set = 0; set < SETS; set++) {
        tyn_scatter_lut_params params = {
            .mode = TYN_MEDIUM_DENSITY,
            .phase = {{.g = gs[set][0]}, {.g = gs[set][1]}, {.g = gs[set][2]}},
            .tms = 1};
        for (uint32_t ch = 0; ch < 3; ch++) {
            double f = gs[set][ch] > 0 ? gs[set][ch] * gs[set][ch] : 0;
            for (int i = 0; i < CASES; i++) {
                double part = i == 0 ? 0 : i == 1 ? 1 : pow(random_unit(&seed), 3);
                double tau = random_depth(f, &seed);
                for (int k = 0; k < STEPS; k++) {
                    points[ch][i][k] = (point){
                        (float)tau, (float)cos(PI * (k + 0.5) / STEPS), (float)part, ch, 0, 0};
                }
            }
        }
        const float *got = evaluate(t, &params, points[0][0], sizeof points / sizeof(point), 0);
        for (int ch = 0; ch < 3; ch++) {
            lobe_series_make(&s, gs[set][ch]);
            double worst[2] = {0, 0};
            for (int i = 0; i < CASES; i++) {
                const point *p = points[ch][i];
                double sum = 0, first = 0;
                for (int k = 0; k < STEPS; k++) {
                    double theta = PI * (k + 0.5) / STEPS;
                    double w = 2 * PI * sin(theta) * PI / STEPS * got[(ch * CASES + i) * STEPS + k];
                    sum += w;
                    first += w * cos(theta);
                }
                double expected =
                    s.rest[1] / (1 - s.f) * (1 - p[0].part) * exp(-p[0].tau * (s.f - s.lobe[1]));
                worst[0] = maximum(worst[0], fabs(sum - 1));
                worst[1] = maximum(worst[1], fabs(first - expected));
            }
            printf("g %5.2f: sum off by %.2g, mean cosine by %.2g\n", s.g, worst[0], worst[1]);
            assert_within(worst[0], 0.003, NULL);
            assert_within(worst[1], 0.003, NULL);
        }
    }
}

// Rows for varying g: where it does not vary the result is that of the series.
static void spread_rows(void **state)
{
    gpu_test *t = *state;
    static const double spread[] = {-0.4, 0, 0.03, 0.2, 0.5, 0.77, 0.9, 0.94};
    static point points[DEPTHS * ANGLES];
    static lobe_series s;
    static double c[LOBE_TERMS];
    uint32_t seed = 3;
    tyn_scatter_lut_params params = {.mode = TYN_MEDIUM_COEFFICIENTS, .g_max = 0.95f, .tms = 1};
    for (size_t n = 0; n < sizeof spread / sizeof *spread; n++) {
        double g = spread[n];
        lobe_series_make(&s, g);
        fill_points(points, 0, g, 9 / 529.0, &seed);
        for (int i = 0; i < DEPTHS * ANGLES; i++) {
            points[i].g = (float)g;
            points[i].tau_p = points[i].tau * (float)(1 - s.f);
        }
        const float *got = evaluate(t, &params, points, DEPTHS * ANGLES, 1);
        if (n == 0) {
            printf("built in %.2f ms\n", gpu_ms(t, "scatter_lut"));
        }
        lobe_cone(points[0].part, s.terms, c);
        double error = worst_error(&s, c, points, got);
        printf("spread g %5.2f: largest error %.3f %% of the peak\n", g, 100 * error);
        assert_within(error, 0.03, NULL);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cones),
        cmocka_unit_test(sums_over_directions),
        cmocka_unit_test(spread_rows),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
