// bench_flicker.c -- flicker: nothing for what moves smoothly, 1.95 s for noise, unknown where a value is not finite.
#include "bench/flicker.h"
#include "numbers.h"
#include <math.h>
#include <stdlib.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

enum { W = 64, H = 32 };
static float picture[4 * W * H];

static void fill(float value)
{
    for (int i = 0; i < 4 * W * H; i++) {
        picture[i] = i % 4 == 3 ? 77.0f : value; // the fourth is not looked at
    }
}

static double of_values(const float *values, int count)
{
    flicker f;
    assert_true(flicker_open(&f, W, H));
    for (int i = 0; i < count; i++) {
        fill(values[i]);
        flicker_add(&f, picture);
    }
    const double value = flicker_value(&f);
    flicker_close(&f);
    return value;
}

static void smooth_and_not(void **state)
{
    (void)state;
    assert_true(isnan(of_values((const float[]){1, 2}, 2)));
    assert_near(of_values((const float[]){1, 2, 3, 4, 5}, 5), 0, 1e-9);
    // |1 - 4 + 1| / 2, and with its neighbours: (2 + 2 + 2) / (2 + 1 + 2)
    assert_near(of_values((const float[]){1, 2, 1}, 3), 1, 1e-6);
    assert_near(of_values((const float[]){1, 2, 1, 2, 1}, 5), 6.0 / 5, 1e-6);
    assert_near(of_values((const float[]){1, 2, 4, 8}, 4), 3.0 / 6, 1e-6);
    assert_true(isnan(of_values((const float[]){0, 0, 0}, 3)));
}

static double normal(void)
{
    double sum = -6;
    for (int i = 0; i < 12; i++) {
        sum += rand() / (double)RAND_MAX;
    }
    return sum;
}

static void noise(void **state)
{
    (void)state;
    flicker f;
    srand(1);
    assert_true(flicker_open(&f, W, H));
    for (int k = 0; k < 8; k++) {
        for (int i = 0; i < 4 * W * H; i++) {
            picture[i] = (float)(1 + 0.01 * normal());
        }
        flicker_add(&f, picture);
    }
    assert_near(flicker_value(&f), 0.0195, 0.0006);
    flicker_close(&f);
}

static void check_not_finite(float value)
{
    flicker f;
    assert_true(flicker_open(&f, W, H));
    for (int k = 0; k < 4; k++) {
        fill(k == 1 ? 2 : 1);
        picture[5] = k == 2 ? value : 1;
        flicker_add(&f, picture);
    }
    assert_true(isnan(flicker_value(&f)));
    flicker_close(&f);
}

static void not_finite(void **state)
{
    (void)state;
    check_not_finite(NAN);
    check_not_finite(INFINITY);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smooth_and_not),
        cmocka_unit_test(noise),
        cmocka_unit_test(not_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
