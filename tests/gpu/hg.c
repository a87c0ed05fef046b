// hg.c -- the phase function on the device against double precision, up to the ends of the range of g.
#include "gpu_test.h"
#include "point_pass.h"
#include "hg_eval.comp.h"
#include <float.h>
#include <math.h>
#include <stdio.h>

#define PI 3.14159265358979323846

typedef struct result {
    float phase, sample;
    float similar_sigma_s[3], similar_g[3], fraction[3], cosine[3];
} result;

static const float gs[] = {0,       1e-8f,   -1e-8f, 1e-3f, -1e-3f,  0.05f,    0.3f,      -0.3f,
                           0.6f,    -0.6f,   0.9f,   -0.9f, 0.99f,   -0.99f,   0.995f,    0.999f,
                           -0.999f, 0.9999f, 0.25f,  0.7f,  0.9998f, 0.99999f, -0.99999f, 0.85f};
static const float one_minus_mus[] = {0,     1e-10f, 1e-8f, 1e-6f,  1e-5f,   1e-4f, 1e-3f, 0.01f,
                                      0.03f, 0.1f,   0.3f,  0.5f,   0.8f,    1.0f,  1.2f,  1.5f,
                                      1.7f,  1.9f,   1.99f, 1.999f, 1.9999f, 2.0f};
static const float us[] = {0, 1e-6f, 1e-4f, 0.01f, 0.1f, 0.3f, 0.5f, 0.7f, 0.9f, 0.99f, 0.9999f};
enum {
    NUM_G = sizeof gs / sizeof *gs,
    NUM_MU = sizeof one_minus_mus / sizeof *one_minus_mus,
    NUM_U = sizeof us / sizeof *us,
    COUNT = NUM_G * NUM_MU,
};

static double phase(double g, double y) // y = 1 - mu
{
    return (1 - g * g) / (4 * PI * pow((1 - g) * (1 - g) + 2 * g * y, 1.5));
}

// 2 pi int p from cosine -1 to 1 - y in the textbook form, in long double.
static double fraction(double g, long double y)
{
    if (fabs(g) < 1e-6) {
        return (double)(0.5L * (2 - y) * (1 - 1.5L * (long double)g * y));
    }
    long double q = g, a = 1 + q, b = sqrtl((1 - q) * (1 - q) + 2 * q * y);
    return (double)((1 - q * q) / (2 * q) * (1 / b - 1 / a));
}

// 1 - mu below which the fraction 1 - u lies, by the textbook inverse in long double.
static double sample(long double g, long double u)
{
    long double s = (1 - g * g) / (1 - g + 2 * g * u);
    return fabsl(g) < 1e-6 ? (double)(2 - 2 * u) : (double)(1 - (1 + g * g - s * s) / (2 * g));
}

static void close_to(const char *what, double got, double want, double rel, double abs, double g,
                     double y)
{
    if (!(fabs(got - want) <= rel * fabs(want) + abs)) {
        fail_msg("%s(g %.9g, 1 - mu %.9g): %.9g, should be %.9g", what, g, y, got, want);
    }
}

static void pieces(void **state)
{
    gpu_test *t = *state;
    static float points[COUNT][4];
    for (int i = 0; i < COUNT; i++) {
        points[i][0] = gs[i / NUM_MU];
        points[i][1] = one_minus_mus[i % NUM_MU];
        points[i][2] = us[i % NUM_MU % NUM_U];
    }
    static point_pass pass;
    point_pass_init(&pass, hg_eval_spirv, sizeof hg_eval_spirv, NULL, 0);
    tyn_graph_begin(t->graph);
    tyn_ref refs[2] = {gpu_buffer(t, "points", points, sizeof points)};
    point_pass_params params = {COUNT, sizeof(result), 0, pass.results};
    assert_int_equal(tyn_graph_add(t->graph, &pass.desc, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "results", refs[pass.results], true);
    gpu_run(t);

    const result *r = gpu_map(t, "results");
    for (int i = 0; i < COUNT; i++) {
        double g = points[i][0], y = points[i][1], u = points[i][2];
        close_to("phase", r[i].phase, phase(g, y), 4e-6, 0, g, y);
        // A sample is rounded nine times, two of them a quotient's; its fraction of the light is off by what scatters between
        // the two angles.
        const double off = 9 * 0.5 * (double)FLT_EPSILON + 2 * gpu_ulps(t, GPU_QUOTIENT);
        double sy = r[i].sample;
        assert_true(sy >= 0 && sy <= 2 * (1 + off));
        if (g >= 0) { // the sample's own fraction is u again
            close_to("sample", fraction(g, (long double)sy), u, 0, off * sy * 2 * PI * phase(g, sy),
                     g, sy);
        } else { // 1 - mu cannot tell narrow backward angles apart: compare it as such
            close_to("sample", sy, sample(g, u), 0, 2 * off, g, u);
        }

        for (int c = 0; c < 3; c++) {
            double gc = c == 0 ? g : c == 1 ? -g : 0, f = gc > 0 ? gc * gc : 0;
            close_to("fraction", r[i].fraction[c], f, 1e-6, 0, gc, y);
            close_to("cosine", r[i].cosine[c], (gc - f) / (1 - f), 4e-6, 1e-30, gc, y);
            double s = gc > 0.995 ? 2 * (1 - gc) / (1 - 0.995) : 2;
            close_to("similar sigma_s", r[i].similar_sigma_s[c], s, 4e-5, 0, gc, y);
            close_to("similar g", r[i].similar_g[c], fmin(gc, 0.995), 1e-6, 0, gc, y);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pieces)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
