// refine_points.c -- places of the field: middles of cells of a grid over a box, x fastest.
#include "gpu_test.h"
#include "numbers.h"
#include "passes/refined/refine_points/refine_points.h"
#include <math.h>

static void middles(void **state)
{
    gpu_test *t = *state;
    const tyn_refine_points_params params = {{5, 3, 7}, {2, 0.5f, 1.4f}};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_refine_points, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "points", refs[REFINE_POINTS_PORT_POINTS], true);
    gpu_run(t);
    const float(*points)[3] = (const float(*)[3])gpu_map(t, "points");
    double worst = 0;
    for (uint32_t i = 0; i < 5 * 3 * 7; i++) {
        const uint32_t at[3] = {i % 5, i / 5 % 3, i / 15};
        for (int a = 0; a < 3; a++) {
            const double middle = (at[a] + 0.5) * (double)params.extent[a] / params.size[a];
            worst = maximum(worst, fabs((double)points[i][a] - middle));
        }
    }
    assert_true(worst < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(middles)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
