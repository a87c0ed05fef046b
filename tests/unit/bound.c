// bound.c -- tests/support/bound.h: which bounds hold, and which are too wide.
#include "bound.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static void holds(void **state)
{
    (void)state;
    assert_true(within(1, 1, NULL, "equal"));
    assert_false(within(1.01, 1, NULL, "beyond"));
    assert_false(within(NAN, 1, NULL, "no number"));
    assert_true(bounds_near(true)); // what is beyond its bound is not far below it
}

// Of checks of one name that which comes nearest to its bound decides.
static void near(void **state)
{
    (void)state;
    within(0.3, 1, NULL, "wide");
    assert_false(bounds_near(true));
    within(0.3, 1, NULL, "wide, on a device that is not judged");
    assert_true(bounds_near(false));
    within(0.3, 1, "a reason", "wide with a reason");
    assert_true(bounds_near(true));
    for (int k = 0; k < 3; k++) {
        within(k == 1 ? 0.04 : 0.01, 0.1, NULL, "in a loop");
    }
    assert_true(bounds_near(true));
    for (int k = 0; k < 2; k++) {
        within(k ? 0.04 : 0.01, 0.1, NULL, "case %d", k);
    }
    assert_false(bounds_near(true));
    assert_true(bounds_near(true)); // nothing of before is left
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(holds), cmocka_unit_test(near)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
