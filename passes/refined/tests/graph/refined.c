// refined.c -- which nodes of method `refined` run when something changes, on a device that only writes down what it is told.
#include "what_runs.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void changes(void **state)
{
    (void)state;
    static const char *const nodes[] = {"medium", "lattice", "raymarch", "path", "refine", NULL};
    static const what_runs_row rows[] = {
        {"first frame", change_nothing, "rrrrr"},
        {"nothing", change_nothing, "uuuuu"},
        {"sun dimmed", dim_sun, "urrrr"},
        {"camera moved", move_camera, "uurrr"},
        {"coefficients", thin_medium, "rrrrr"},
        {"empty", take_medium, "--rrr"},
        {NULL},
    };
    assert_true(what_runs("refined", nodes, rows));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(changes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
