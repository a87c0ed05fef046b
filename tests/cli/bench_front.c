// bench_front.c -- fronts, times at equal error and ranges of who is fastest, against figures done by hand.
#include "bench/front.h"
#include "numbers.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

enum { POP, PATH, SINGLE };

// pop: three settings, one of them beaten by the others. path: error 0.16 / sqrt(n) of n samples of 10 ms.
// single: fast and wrong.
static const front_point points[] = {
    {100, 0.05, POP, false}, {300, 0.03, POP, false},   {400, 0.04, POP, false},
    {10, 0.16, PATH, true},  {40, 0.08, PATH, true},    {160, 0.04, PATH, true},
    {640, 0.02, PATH, true}, {2560, 0.01, PATH, true},  {20, 0.6, SINGLE, false},
    {5, NAN, SINGLE, false}, {INFINITY, 0, POP, false}, {0, 0.001, POP, false},
};
enum { COUNT = sizeof points / sizeof points[0] };

static void pareto(void **state)
{
    (void)state;
    uint32_t front[COUNT];
    const uint32_t expected[] = {3, 4, 0, 5, 1, 6, 7};
    assert_int_equal(front_pareto(points, COUNT, front), 7);
    for (int i = 0; i < 7; i++) {
        assert_int_equal(front[i], expected[i]);
    }
    assert_int_equal(front_pareto(points, 0, front), 0);
    // of equal points one
    const front_point same[] = {{1, 1, 0, false}, {1, 1, 1, false}, {1, 2, 2, false}};
    assert_int_equal(front_pareto(same, 3, front), 1);
    assert_int_equal(front[0], 0);
}

static void settings(void **state)
{
    (void)state;
    front_time t = front_time_at(points, COUNT, POP, 0.045);
    assert_true(t.measured && t.point == 1); // the fastest that is good enough, not between two
    assert_near(t.ms, 300, 1e-9);
    t = front_time_at(points, COUNT, POP, 0.05);
    assert_true(t.measured && t.point == 0);
    t = front_time_at(points, COUNT, POP, 0.5);
    assert_near(t.ms, 100, 1e-9);
    t = front_time_at(points, COUNT, POP, 0.0299);
    assert_true(isnan(t.ms) && t.point < 0);
    t = front_time_at(points, COUNT, 77, 0.1);
    assert_true(isnan(t.ms));
}

static void samples(void **state)
{
    (void)state;
    // on a point, between two (log-log: exactly 1/sqrt(n) here), beyond both ends
    front_time t = front_time_at(points, COUNT, PATH, 0.08);
    assert_true(t.measured && t.point == 4);
    assert_near(t.ms, 40, 1e-9);
    t = front_time_at(points, COUNT, PATH, 0.05);
    assert_true(t.measured && t.point < 0);
    assert_near(t.ms, 10 * (0.16 / 0.05) * (0.16 / 0.05), 1e-6);
    t = front_time_at(points, COUNT, PATH, 0.32);
    assert_false(t.measured);
    assert_near(t.ms, 2.5, 1e-9);
    t = front_time_at(points, COUNT, PATH, 0.005);
    assert_false(t.measured);
    assert_near(t.ms, 10240, 1e-6);
    t = front_time_at(points, COUNT, PATH, 0);
    assert_true(isnan(t.ms));
    // another slope than 1/2: a biased end of the curve
    const front_point bent[] = {{1, 0.1, 0, true}, {10, 0.01, 0, true}, {100, 0.009, 0, true}};
    t = front_time_at(bent, 3, 0, 0.0316227766);
    assert_near(t.ms, 3.16227766, 1e-6);
    // a point that noise has lifted is not followed upwards
    const front_point noisy[] = {{1, 0.1, 0, true}, {4, 0.11, 0, true}, {16, 0.025, 0, true}};
    t = front_time_at(noisy, 3, 0, 0.05);
    assert_near(t.ms, 4, 1e-9);
    assert_true(t.measured);
}

static void ranges(void **state)
{
    (void)state;
    front_range r[8];
    // At 3 % pop takes 300 ms and path 284; at 5 % pop takes 100 and path 102.4, at 5.06 % path takes 100: too
    // narrow to be told. With 80 ms pop is the faster from 5 to 5.66 %.
    assert_int_equal(front_ranges(points, COUNT, r, 8), 1);
    assert_true(r[0].line == PATH && r[0].lowest && r[0].highest);
    front_point faster[COUNT];
    for (int i = 0; i < COUNT; i++) {
        faster[i] = points[i];
    }
    faster[0].ms = 80;
    assert_int_equal(front_ranges(faster, COUNT, r, 8), 3);
    assert_int_equal(r[0].line, PATH);
    assert_true(r[0].lowest && !r[0].highest);
    assert_near(r[0].low, 0.01, 1e-4);
    assert_int_equal(r[1].line, POP);
    assert_near(r[1].low, 0.05, 6e-4);
    assert_near(r[1].high, 0.0566, 6e-4);
    assert_int_equal(r[2].line, PATH); // its first sample, 10 ms, is faster than single
    assert_true(r[2].highest && !r[2].lowest);
    // what is extrapolated wins nothing: 20 ms is the least that path takes
    const front_point few[] = {{20, 0.02, 0, true}, {10, 0.5, 1, false}};
    assert_int_equal(front_ranges(few, 2, r, 8), 2);
    assert_int_equal(r[0].line, 0);
    assert_int_equal(r[1].line, 1);
    assert_near(r[1].low, 0.5, 6e-3);
    assert_int_equal(front_ranges(few, 0, r, 8), 0);
    assert_int_equal(front_ranges(few, 2, r, 1), 1);
}

// What is slow and wrong has its range where nothing else is so fast, however large its error is.
static void large_errors(void **state)
{
    (void)state;
    const front_point far[] = {{1, 2.0, POP, false}, {10, 0.6, PATH, true}};
    front_range r[2];
    assert_int_equal(front_ranges(far, 2, r, 2), 2);
    assert_int_equal(r[1].line, POP);
    assert_near(r[1].low, 2, 0.02);
    assert_true(r[0].lowest && !r[0].highest && r[1].highest);
}

// Errors that the reference's noise of 3 % hides stand at 3 %: all that is known of them.
static void below_the_noise(void **state)
{
    (void)state;
    const front_point noisy[] = {{30, 0.03, POP, false, true},  {90, 0.03, POP, false, true},
                                 {10, 0.1, PATH, true, false},  {40, 0.05, PATH, true, false},
                                 {160, 0.03, PATH, true, true}, {640, 0.03, PATH, true, true}};
    uint32_t front[6];
    assert_int_equal(front_pareto(noisy, 6, front), 2);
    assert_int_equal(front[1], 0);
    // between a point and a bound one by the rule of samples, then at the bound; below it nothing is known
    front_time t = front_time_at(noisy, 6, PATH, 0.04);
    assert_near(t.ms, 40 * (0.05 / 0.04) * (0.05 / 0.04), 1e-9);
    assert_near(front_time_at(noisy, 6, PATH, 0.03).ms, 160, 1e-9);
    assert_true(isnan(front_time_at(noisy, 6, PATH, 0.02).ms));
    assert_true(isnan(front_time_at(noisy, 6, POP, 0.02).ms));
    front_range r[4];
    assert_int_equal(front_ranges(noisy, 6, r, 4), 2);
    assert_true(r[0].line == POP && !r[0].lowest);
    assert_near(r[0].low, 0.03, 1e-6);
    assert_near(r[0].high, 0.1 / sqrt(3), 6e-4);
    assert_true(r[1].line == PATH && r[1].highest);
}

// The first of all ranges, too, may be too narrow to be told.
static void first_sliver(void **state)
{
    (void)state;
    const front_point narrow[] = {{100, 0.002, PATH, true, true},
                                  {50, 0.00205, POP, false, false},
                                  {10, 0.1, SINGLE, false, false}};
    front_range r[4];
    assert_int_equal(front_ranges(narrow, 3, r, 4), 2);
    assert_int_equal(r[0].line, POP);
    assert_true(!r[0].lowest && !r[0].highest);
    assert_near(r[0].low, 0.002, 1e-6);
    assert_int_equal(r[1].line, SINGLE);
    assert_true(r[1].highest);
    // one that has no lower end is not narrow
    front_point open[3] = {narrow[0], narrow[1], narrow[2]};
    open[0].bound = false;
    assert_int_equal(front_ranges(open, 3, r, 4), 3);
    assert_true(r[0].line == PATH && r[0].lowest);
    // two that are narrow, and nothing beside them
    assert_int_equal(front_ranges(narrow, 2, r, 4), 1);
    assert_true(r[0].line == POP && r[0].highest);
}

static void means(void **state)
{
    (void)state;
    // What is left out of a mean is taken out by who knows why: no value makes the mean of the others.
    const double values[] = {2, 8, NAN, 2, 0, 2, -1, 2, INFINITY};
    assert_near(front_geometric_mean(values, 2), 4, 1e-12);
    for (int i = 1; i < 9; i += 2) {
        assert_true(isnan(front_geometric_mean(values + i, 2)));
    }
    assert_true(isnan(front_geometric_mean(values, 0)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pareto), cmocka_unit_test(settings),     cmocka_unit_test(samples),
        cmocka_unit_test(ranges), cmocka_unit_test(large_errors), cmocka_unit_test(below_the_noise),
        cmocka_unit_test(means),  cmocka_unit_test(first_sliver),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
