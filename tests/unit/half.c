// half.c -- every half value survives the round trip; rounding and the ends of the range.
#include "base/half.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void round_trip(void **state)
{
    (void)state;
    for (uint32_t h = 0; h < 0x10000; h++) {
        float f = tyn_half_to_float((uint16_t)h);
        if (isnan(f)) {
            assert_int_equal(tyn_half_from_float(f) & 0x7c00, 0x7c00);
        } else {
            assert_int_equal(tyn_half_from_float(f), h);
        }
    }
}

static void rounding(void **state)
{
    (void)state;
    assert_int_equal(tyn_half_from_float(1.0f), 0x3c00);
    assert_int_equal(tyn_half_from_float(1.0f + 0x1p-11f), 0x3c00);     // tie to even
    assert_int_equal(tyn_half_from_float(1.0f + 3 * 0x1p-11f), 0x3c02); // tie to even
    assert_int_equal(tyn_half_from_float(65504.0f), 0x7bff);
    assert_int_equal(tyn_half_from_float(65519.9f), 0x7bff);
    assert_int_equal(tyn_half_from_float(65520.0f), 0x7c00);
    assert_int_equal(tyn_half_from_float(0x1p-25f), 0x0000);
    assert_int_equal(tyn_half_from_float(0x1.01p-25f), 0x0001);
    assert_int_equal(tyn_half_from_float(-0x1p-24f), 0x8001);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(round_trip), cmocka_unit_test(rounding)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
