// shdom.c -- which nodes run when something changes.
#include "what_runs.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void shdom(void **state)
{
    (void)state;
    static const char *const nodes[] = {
        "medium", "beam",       "lattice_cells", "lattice_ordinates",
        "shdom",  "shdom_view", "raymarch",      NULL};
    static const what_runs_row rows[] = {
        {"first frame", change_nothing, "rrrrrrr"}, {"nothing", change_nothing, "uuuuuuu"},
        {"camera moved", move_camera, "uuuuurr"},   {"sun moved", turn_sun, "ururrrr"},
        {"sun dimmed", dim_sun, "uuurrrr"},         {"map turned", turn_map, "uuurrrr"},
        {"another map", change_map, "uuurrrr"},     {"coefficients", thin_medium, "rrrrrrr"},
        {"grid", change_grid, "rrrrrrr"},           {"unlit", lights_out, "u-----r"},
        {"empty", take_medium, "------r"},          {NULL},
    };
    assert_true(what_runs("shdom", nodes, rows));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(shdom)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
