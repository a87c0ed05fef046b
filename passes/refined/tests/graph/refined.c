// refined.c -- which nodes of method `refined` run when something changes, on a device that only writes down what it is told.
#include "what_runs.h"
#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void absorb_only(stage *s)
{
    memset(s->scene.media[0].sigma_s, 0, sizeof s->scene.media[0].sigma_s);
    memset(s->scene.media[0].sigma_a, 0, sizeof s->scene.media[0].sigma_a);
    s->scene.media[0].sigma_a[0] = 3;
}

// So thin that next to nothing scatters twice, under a map of which pop does not follow all light.
static void scatter_little(stage *s)
{
    s->scene.media[0].sigma_s[0] = 0.004f;
}

static void take_map(stage *s)
{
    s->scene.environment.present = false;
}

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
        {"absorbs", absorb_only, "rrr-r"},
        {"scatters little", scatter_little, "rrrrr"},
        {"without map", take_map, "r-r-r"},
        {"empty", take_medium, "--r-r"},
        {NULL},
    };
    assert_true(what_runs("refined", nodes, rows));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(changes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
