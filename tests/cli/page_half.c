// page_half.c -- half floats of the page's pictures against the engine's conversion, which shares no code.
#include "base/half.h"
#include "bench/html_picture.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

// Every half, what lies between two of them, and the ties.
static void test_every_half(void **state)
{
    (void)state;
    for (uint32_t h = 0; h < 0x7c00; h++) {
        const float here = tyn_half_to_float((uint16_t)h);
        const float next = h < 0x7bff ? tyn_half_to_float((uint16_t)(h + 1)) : 65536.0f;
        const float between[] = {0, 0.25f, 0.5f, 0.75f};
        for (int k = 0; k < 4; k++) {
            const float value = here + between[k] * (next - here);
            assert_int_equal(html_half(value), tyn_half_from_float(value));
            assert_int_equal(html_half(-value), tyn_half_from_float(-value));
        }
    }
}

static void test_not_finite(void **state)
{
    (void)state;
    assert_int_equal(html_half(INFINITY), 0x7c00);
    assert_int_equal(html_half(-INFINITY), 0xfc00);
    assert_int_equal(html_half(1e9f), 0x7c00);
    assert_true(isnan(tyn_half_to_float(html_half(NAN))));
    assert_int_equal(html_half(1e-9f), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_half),
        cmocka_unit_test(test_not_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
