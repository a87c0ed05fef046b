// metrics.c -- the error measures against values worked out by hand.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>
#include "metrics.h"
#include "numbers.h"

#define NEAR(value, expected) assert_near(value, expected, 1e-6)

// Two pixels, a row of them: R, G and B differ so that pooling shows.
static const float xr[2] = {1, 2}, xg[2] = {0, 0}, xb[2] = {3, 1};
static const float rr[2] = {1, 1}, rg[2] = {0, 2}, rb[2] = {2, 1};
static const metrics_image image = {2, 1, {xr, xg, xb}, {0}};
static const metrics_image reference = {2, 1, {rr, rg, rb}, {0}};

static void pools_channels(void **state)
{
    (void)state;
    metrics m;
    assert_int_equal(metrics_compare(&image, &reference, 1, &m), METRICS_OK);
    const double mean = 7.0 / 6, floor = 0.01 * mean * mean;
    NEAR(m.mean, mean);
    NEAR(m.rel_l1, 4.0 / 7); // |0| + |1| + |0| + |-2| + |1| + |0| over 1 + 1 + 0 + 2 + 2 + 1
    NEAR(m.rmse, 1.0);       // 0 + 1 + 0 + 4 + 1 + 0 over 6
    NEAR(m.rel_rmse, sqrt(6.0 / 11));
    NEAR(m.rel_mse, (1 / (1 + floor) + 4 / (4 + floor) + 1 / (4 + floor)) / 6);
    NEAR(m.smape, (2.0 / 3 + 2 + 0.4) / 6); // both 0 in the first green pixel: counts as 0
    NEAR(m.bias, 0.0);                      // 7 / 7 - 1
    NEAR(m.p95, 2 / (2 + 0.01 * mean));     // of six values the largest
    assert_false(m.has_n);
    NEAR(m.error, m.rel_l1);
    assert_int_equal(m.nan, 0);
}

static void averages_blocks(void **state)
{
    (void)state;
    metrics m;
    assert_int_equal(metrics_compare(&image, &reference, 2, &m), METRICS_OK);
    NEAR(m.rel_l1, 2 / 3.5); // blocks 1.5 0 2 against 1 1 1.5
    NEAR(m.rmse, sqrt((0.25 + 1 + 0.25) / 3));
    NEAR(m.smape, (2 * 0.5 / 2.5 + 2 * 1.0 / 1 + 2 * 0.5 / 3.5) / 3);
}

// A block at the edge weighs as many pixels as it holds.
static void weighs_edge_blocks(void **state)
{
    (void)state;
    const float x[3] = {1, 2, 4}, r[3] = {1, 1, 1};
    const metrics_image a = {3, 1, {x, x, x}, {0}}, b = {3, 1, {r, r, r}, {0}};
    metrics m;
    assert_int_equal(metrics_compare(&a, &b, 2, &m), METRICS_OK);
    NEAR(m.rel_l1, (2 * 0.5 + 1 * 3.0) / 3); // blocks 1.5 (two pixels) and 4 (one)
    NEAR(m.bias, 4.0 / 3);                   // whatever the block
    NEAR(m.p95, 3 / 1.01);
    assert_int_equal(metrics_compare(&a, &b, UINT32_MAX, &m), METRICS_OK);
    NEAR(m.rel_l1, 4.0 / 3);
}

static void explains_noise(void **state)
{
    (void)state;
    const float se[2] = {0.1f, 0.1f}, se_r[2] = {0.2f, 0.2f};
    metrics_image a = image, b = reference;
    for (int c = 0; c < 3; c++) {
        a.se[c] = se;
    }
    metrics m;
    const double mean_abs = sqrt(2 / acos(-1.0));
    assert_int_equal(metrics_compare(&a, &b, 1, &m), METRICS_OK);
    assert_true(m.has_n);
    NEAR(m.n, mean_abs * 0.6 / 7);
    NEAR(m.error, sqrt(16.0 / 49 - m.n * m.n));
    assert_int_equal(metrics_compare(&a, &b, 2, &m), METRICS_OK);
    NEAR(m.n,
         mean_abs * 3 * sqrt(0.02) / 2 / 3.5); // two independent pixels in each of three blocks
    for (int c = 0; c < 3; c++) {
        b.se[c] = se_r;
    }
    assert_int_equal(metrics_compare(&a, &b, 1, &m), METRICS_OK);
    NEAR(m.n, mean_abs * 6 * sqrt(0.05) / 7); // both carry errors: they add up in squares
    assert_int_equal(metrics_compare(&b, &b, 1, &m), METRICS_OK);
    NEAR(m.rel_l1, 0);
    NEAR(m.error, 0); // less than the noise explains: not negative, not NaN
}

static void assert_no_measure(const metrics *m)
{
    const double all[] = {m->rel_l1, m->rmse, m->rel_rmse, m->rel_mse, m->smape,
                          m->bias,   m->n,    m->error,    m->p95};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        assert_true(isnan(all[i]));
    }
}

// What errors alone make of single pixels, without a reference.
static void expects_noise(void **state)
{
    (void)state;
    const float rgba[8] = {1, 0, -3, NAN, 2, 0, 1, NAN};
    const float error[8] = {0.1f, 0.2f, 0, NAN, 0.1f, 0.1f, 0.1f, NAN}, black[8] = {0};
    NEAR(metrics_expected(rgba, error, 2), sqrt(2 / acos(-1.0)) * 0.6 / 7);
    NEAR(metrics_expected(black, error, 2), 0.0);
}

static void has_no_measure_of_nan(void **state)
{
    (void)state;
    const float x[3] = {NAN, 2, 3}, r[3] = {1, INFINITY, 2}, even[3] = {1, 2, 2};
    const metrics_image a = {3, 1, {x, x, x}, {0}}, b = {3, 1, {r, r, r}, {0}};
    const metrics_image c = {3, 1, {even, even, even}, {0}};
    metrics m;
    assert_int_equal(metrics_compare(&a, &b, 1, &m), METRICS_OK);
    assert_int_equal(m.nan, 6);
    assert_no_measure(&m);
    assert_int_equal(metrics_compare(&a, &c, 3, &m), METRICS_OK);
    assert_int_equal(m.nan, 3);
    assert_no_measure(&m);
    assert_int_equal(metrics_compare(&c, &b, 3, &m), METRICS_OK);
    assert_int_equal(m.nan, 3);
    assert_no_measure(&m);
}

// A standard error that is not known is not 0.
static void has_no_error_within_unknown_noise(void **state)
{
    (void)state;
    const float se[2] = {0.1f, NAN};
    metrics_image a = image;
    a.se[0] = a.se[1] = a.se[2] = se;
    metrics m;
    assert_int_equal(metrics_compare(&a, &reference, 1, &m), METRICS_OK);
    assert_int_equal(m.nan, 0);
    NEAR(m.rel_l1, 4.0 / 7);
    assert_true(isnan(m.n) && isnan(m.error));
}

static void refuses_zero_reference(void **state)
{
    (void)state;
    const float zero[2] = {0};
    const metrics_image b = {2, 1, {zero, zero, zero}, {0}};
    metrics m;
    float heat[2];
    assert_int_equal(metrics_compare(&image, &b, 1, &m), METRICS_ZERO_REFERENCE);
    assert_int_equal(metrics_heat(&image, &b, 1, heat), METRICS_ZERO_REFERENCE);
}

static void draws_heat(void **state)
{
    (void)state;
    float heat[2];
    assert_int_equal(metrics_heat(&image, &reference, 1, heat), METRICS_OK);
    const double m = 0.01 * 7 / 6;
    NEAR(heat[0], (0 + 0 + 1 / (2 + m)) / 3);
    NEAR(heat[1], (1 / (1 + m) + 2 / (2 + m) + 0) / 3);
    assert_int_equal(metrics_heat(&image, &reference, 8, heat), METRICS_OK);
    NEAR(heat[0], heat[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pools_channels),
        cmocka_unit_test(averages_blocks),
        cmocka_unit_test(weighs_edge_blocks),
        cmocka_unit_test(explains_noise),
        cmocka_unit_test(expects_noise),
        cmocka_unit_test(has_no_measure_of_nan),
        cmocka_unit_test(has_no_error_within_unknown_noise),
        cmocka_unit_test(refuses_zero_reference),
        cmocka_unit_test(draws_heat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
