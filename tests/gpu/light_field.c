// light_field.c -- every value of every probe is in its place, in floats and in halves, and fluxes are turned to the images' axes.
#include "gpu_test.h"
#include "passes/light_field/light_field.h"
#include "base/half.h"
#include <tyndall/context.h>
#include <math.h>
#include <string.h>

enum { X = 5, Y = 4, Z = 3, N = X * Y * Z };

static void places(void **state)
{
    gpu_test *t = *state;
    static tyn_probe_result probes[N];
    for (int i = 0; i < N; i++) {
        for (int c = 0; c < 3; c++) {
            probes[i].fluence[c] = (float)(i + 100 * c);
            for (int a = 0; a < 3; a++) {
                probes[i].flux[3 * a + c] = 0.5f * (float)(i + 100 * c + 300 * (a + 1) - 700);
            }
            probes[i].flux_se[3 * c] = probes[i].fluence_se[c] = -1; // is in no image
        }
    }
    const tyn_extent extent = {X, Y, Z};
    static const char *const names[3] = {"red", "green", "blue"};
    // The world's x is the images' y, its y their -x.
    static const int axes[3] = {1, 0, 2};
    static const float signs[3] = {-1, 1, 1};
    for (uint32_t half = 0; half < 2; half++) {
        tyn_graph_begin(t->graph);
        const tyn_light_field_params params = {half, {{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}}};
        tyn_ref refs[LIGHT_FIELD_NUM_PORTS] = {
            tyn_graph_upload_buffer(t->graph, "results", probes, sizeof probes, 0)};
        for (int c = 0; c < 3; c++) {
            refs[LIGHT_FIELD_PORT_RED + c] = tyn_graph_history_image(
                t->graph, names[c], TYN_IMAGE_3D,
                half ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT, extent, 1);
        }
        assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_light_field, &params, refs), TYN_OK);
        for (int c = 0; c < 3; c++) {
            tyn_graph_output(t->graph, names[c], refs[LIGHT_FIELD_PORT_RED + c], true);
        }
        gpu_run(t);
        for (int c = 0; c < 3; c++) {
            const void *out = gpu_map(t, names[c]);
            for (int i = 0; i < 4 * N; i++) {
                const tyn_probe_result *p = &probes[i / 4];
                const int axis = i % 4 - 1;
                const float right =
                    axis < 0 ? p->fluence[c] : signs[axis] * p->flux[3 * axes[axis] + c];
                const float found =
                    half ? tyn_half_to_float(((const uint16_t *)out)[i]) : ((const float *)out)[i];
                assert_true(found == right);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(places)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
