// light_points.c -- the middles of the cells of a grid over the media's box.
#include "gpu_test.h"
#include "passes/light_points/light_points.h"
#include "shaders/common/scene_args.h"
#include <math.h>
#include <string.h>

enum { X = 7, Y = 5, Z = 3 };

static void middles(void **state)
{
    gpu_test *t = *state;
    const struct medium_block medium = {.extent = {1.5f, 4, 0.25f}};
    tyn_graph_begin(t->graph);
    const tyn_light_points_params params = {{X, Y, Z}};
    tyn_ref refs[LIGHT_POINTS_NUM_PORTS] = {
        tyn_graph_upload_buffer(t->graph, "medium", &medium, sizeof medium, 0)};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_light_points, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "points", refs[LIGHT_POINTS_PORT_POINTS], true);
    gpu_run(t);
    const float *found = gpu_map(t, "points");
    for (int i = 0; i < X * Y * Z; i++) {
        const double right[3] = {(i % X + 0.5) / X * 1.5, (i / X % Y + 0.5) / Y * 4,
                                 (i / (X * Y) + 0.5) / Z * 0.25};
        for (int a = 0; a < 3; a++) {
            assert_true(fabs((double)found[3 * i + a] - right[a]) <= 1e-6 * (1 + right[a]));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(middles)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
