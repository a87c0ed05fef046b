// photon.c -- which nodes run when something changes.
#include "what_runs.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

// The first frame has photons of all generations. After a change some are traced in each frame, until none is of before it.
static void photon(void **state)
{
    (void)state;
    static const char *const nodes[] = {"medium",       "beam",         "lattice_cells",
                                        "photon_trace", "photon_cache", "photon_upsample",
                                        "photon_view",  "raymarch",     NULL};
    static const what_runs_row rows[] = {
        {"first frame", change_nothing, "rrrrrrrr"},  {"nothing", change_nothing, "uuuuuuuu"},
        {"camera moved", move_camera, "uuuuuurr"},    {"sun moved", turn_sun, "ururrrrr"},
        {"settled", change_nothing, "uuuuuuuu", 200}, {"sun dimmed", dim_sun, "uuurrrrr", 1},
        {"settled", change_nothing, "uuuuuuuu", 200}, {"map turned", turn_map, "uuurrrrr", 1},
        {"settled", change_nothing, "uuuuuuuu", 200}, {"coefficients", thin_medium, "rrrrrrrr"},
        {"settled", change_nothing, "uuuuuuuu", 200}, {"grid", change_grid, "rrrrrrrr"},
        {"settled", change_nothing, "uuuuuuuu", 200}, {"unlit", lights_out, "u------r"},
        {"empty", take_medium, "-------r"},           {NULL},
    };
    assert_true(what_runs("photon", nodes, rows));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(photon)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
