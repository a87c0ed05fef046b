// lpv.c -- which nodes run when something changes.
#include "what_runs.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void lpv(void **state)
{
    (void)state;
    static const char *const nodes[] = {"medium",
                                        "beam",
                                        "env_glow",
                                        "lattice_cells",
                                        "lattice_source",
                                        "lattice_ordinates",
                                        "lpv",
                                        "merge",
                                        "raymarch",
                                        NULL};
    static const what_runs_row rows[] = {
        {"first frame", change_nothing, "rrrrrrrrr"},
        {"nothing", change_nothing, "uuuuuuuuu"},
        {"camera moved", move_camera, "uuuuuuurr"},
        {"sun moved", turn_sun, "uruurrrrr"},
        {"sun dimmed", dim_sun, "uuuurrrrr"},
        {"map turned", turn_map, "uuuuurrrr"},
        {"coefficients", thin_medium, "rrurrrrrr"},
        {"grid", change_grid, "rrurrrrrr"},
        {"unlit", lights_out, "u-------r"},
        {"empty", take_medium, "--------r"},
        {NULL},
    };
    assert_true(what_runs("lpv", nodes, rows));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lpv)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
