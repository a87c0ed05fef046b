// refine_field.c -- results of probes as images: fluence, and flux turned from the world's axes to M's.
#include "gpu_test.h"
#include "numbers.h"
#include "passes/refined/refine_field/refine_field.h"
#include <math.h>
#include <tyndall/context.h>

enum { X = 3, Y = 4, Z = 2, N = X * Y * Z };

static void turned(void **state)
{
    gpu_test *t = *state;
    // The world's x is M's y, its y M's -x.
    const tyn_refine_field_params params = {{X, Y, Z}, {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};
    static tyn_probe_result results[N];
    for (int i = 0; i < N; i++) {
        for (int c = 0; c < 3; c++) {
            results[i].fluence[c] = (float)(100 * c + i);
            for (int a = 0; a < 3; a++) {
                results[i].flux[3 * a + c] = (float)(1000 * (a + 1) + 100 * c + i);
            }
        }
    }
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    static const char *const names[] = {"red", "green", "blue"};
    tyn_graph_begin(t->graph);
    refs[REFINE_FIELD_PORT_RESULTS] = gpu_buffer(t, "results", results, sizeof results);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_refine_field, &params, refs), TYN_OK);
    for (int c = 0; c < 3; c++) {
        tyn_graph_output(t->graph, names[c], refs[REFINE_FIELD_PORT_RED + c], true);
    }
    gpu_run(t);
    for (int c = 0; c < 3; c++) {
        const float(*image)[4] = (const float(*)[4])gpu_map(t, names[c]);
        for (int i = 0; i < N; i++) {
            const float own = (float)(100 * c + i),
                        expected[4] = {own, -2000 - own, 1000 + own, 3000 + own};
            for (int k = 0; k < 4; k++) {
                assert_true(image[i][k] == expected[k]);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(turned)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
