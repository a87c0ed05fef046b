// gradient.c -- which nodes of method `gradient` run when something changes, on a device that only writes down what it is told.
#include "what_runs.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void changes(void **state)
{
    (void)state;
    static const char *const nodes[] = {"medium",   "env_importance", "median_cut", "light_list",
                                        "gradient", "raymarch",       NULL};
    // Eq 6 has the transmittance to the eye, and phase functions its direction: a camera that moves makes samples anew.
    static const what_runs_row rows[] = {
        {"first frame", change_nothing, "rrrrrr"},
        {"nothing", change_nothing, "uuuuuu"},
        {"map turned", turn_map, "uuurrr"},
        {"map dimmed", dim_map, "uuurrr"},
        {"sun dimmed", dim_sun, "uuurrr"},
        {"sun moved", turn_sun, "uuurrr"},
        {"camera moved", move_camera, "uuuurr"},
        {"another map", change_map, "urrrrr"},
        {"coefficients", thin_medium, "ruuurr"},
        {"grid", change_grid, "ruuurr"},
        {"unlit", lights_out, "u----r"},
        {"empty", take_medium, "-----r"},
        {NULL},
    };
    assert_true(what_runs("gradient", nodes, rows));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(changes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
