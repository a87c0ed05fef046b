// phase_table.c -- tables of phase functions on the device: values against formulas, and what is drawn against them.
//
// Asserted: values are those of the formula at angles of all sizes; angles drawn from even numbers have its moments, and
// in 64 bins of equal probability, by the formula's own integral, as many as they should (chi^2).
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "phases.h"
#include "point_pass.h"
#include "scene/phase_table.h"
#include "phase_table_eval.comp.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846

typedef struct result {
    float phase, sample;
} result;

enum { VALUES = 512, DRAWN = 1 << 16, BINS = 64, FINE = 1 << 17, COUNT = VALUES + DRAWN };

// Angles below which k / BINS of the scattering is, by the trapezium rule in the square root of the angle.
static void make_bins(phases_kind kind, double edges[BINS + 1], double *mean_cosine)
{
    static double below[FINE + 1];
    double step = sqrt(PI) / FINE, last = 0, first = 0;
    below[0] = 0;
    *mean_cosine = 0;
    for (int i = 1; i <= FINE; i++) {
        const double root = i * step, theta = root * root;
        const double next = 4 * PI * root * sin(theta) * phases_value(theta, &kind);
        below[i] = below[i - 1] + 0.5 * step * (last + next);
        *mean_cosine += 0.5 * step * (first + next * cos(theta));
        last = next;
        first = next * cos(theta);
    }
    for (int k = 0, i = 0; k <= BINS; k++) {
        while (i < FINE && below[i] < below[FINE] * k / BINS) {
            i++;
        }
        edges[k] = pow(i * step, 2);
    }
    *mean_cosine /= below[FINE];
}

static void check_drawn(phases_kind kind, const result *drawn)
{
    double edges[BINS + 1], mean = 0, right, chi2 = 0;
    int counts[BINS] = {0};
    make_bins(kind, edges, &right);
    for (int i = 0; i < DRAWN; i++) {
        const double away = (double)drawn[i].sample;
        assert_true(away >= 0 && away <= 2.000001);
        mean += (1 - away) / DRAWN;
        const double theta = 2 * asin(fmin(sqrt(0.5 * away), 1));
        int bin = 0;
        while (bin + 1 < BINS && theta >= edges[bin + 1]) {
            bin++;
        }
        counts[bin]++;
    }
    const double expected = (double)DRAWN / BINS;
    for (int k = 0; k < BINS; k++) {
        chi2 += (counts[k] - expected) * (counts[k] - expected) / expected;
    }
    // Numbers that are evenly spaced, not random: a bin is off by a few at its edges, not by the root of its count.
    printf("%s: mean cosine %.6f of %.6f, chi^2 of %d bins %.3f\n", phases_name(kind), mean, right,
           BINS, chi2);
    const bool lines = kind == PHASES_ANGLES; // straight ones between the degrees given
    assert_true(fabs(mean - right) < (lines ? 5e-4 : 5e-5));
    if (lines) {
        const double chi2_of_lines = chi2;
        assert_within(chi2_of_lines, 0.15, NULL);
    } else {
        assert_within(chi2, 0.1, NULL);
    }
}

static void tables(void **state)
{
    gpu_test *t = *state;
    static float points[COUNT][4], rows[PHASES_COUNT][TYN_PHASE_NODES][4];
    static point_pass pass;
    const point_input inputs[1] = {{"phases", TYN_BUFFER, TYN_USE_TEXELS_VEC4}};
    for (int kind = 0; kind < PHASES_COUNT; kind++) {
        tyn_scene scene;
        tyn_scene_init(&scene);
        const tyn_phase phase = phases_add(&scene, (phases_kind)kind);
        tyn_phase_table_rows(&scene.phase_tables[phase.table - 1], rows[kind]);
        tyn_scene_finish(&scene);
    }
    point_pass_init(&pass, phase_table_eval_spirv, sizeof phase_table_eval_spirv, inputs, 1);
    for (int kind = 0; kind < PHASES_COUNT; kind++) {
        for (int i = 0; i < COUNT; i++) {
            // Angles down to a hundredth of a degree, straight on and straight back.
            const double theta = i < 2        ? i * PI
                                 : i < VALUES ? PI * pow(10, -4.25 * (i - 2) / (VALUES - 3))
                                              : 0;
            points[i][0] = (float)(2 * pow(sin(0.5 * theta), 2));
            points[i][1] = i < VALUES ? 0 : ((float)(i - VALUES) + 0.5f) / DRAWN;
            points[i][2] = (float)(kind + 1);
        }
        tyn_graph_begin(t->graph);
        tyn_ref refs[3] = {gpu_buffer(t, "phases", rows, sizeof rows),
                           gpu_buffer(t, "points", points, sizeof points)};
        point_pass_params params = {COUNT, sizeof(result), 0, pass.results};
        assert_int_equal(tyn_graph_add(t->graph, &pass.desc, &params, refs), TYN_OK);
        tyn_graph_output(t->graph, "results", refs[pass.results], true);
        gpu_run(t);
        const result *r = gpu_map(t, "results");
        double off = 0;
        for (int i = 0; i < VALUES; i++) {
            const double theta = 2 * asin(fmin(sqrt(0.5 * (double)points[i][0]), 1));
            const double value = phases_value(theta, &(phases_kind){(phases_kind)kind});
            off = maximum(off, fabs((double)r[i].phase / value - 1));
        }
        printf("%s: values within %.2g\n", phases_name((phases_kind)kind), off);
        if (kind == PHASES_ANGLES) {
            const double off_of_lines = off;
            assert_within(off_of_lines, 5e-3, NULL);
        } else {
            assert_within(off, 1e-4, NULL);
        }
        check_drawn((phases_kind)kind, r + VALUES);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(tables)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
