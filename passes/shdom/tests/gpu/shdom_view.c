// shdom_view.c -- light towards the eye of a source function that is equal everywhere and in all directions.
//
// In closed form: S / sigma_s, and of the light behind a cell, S / sigma_t* (1 - e^-tau*), the share f = g^bands goes on.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "passes/shdom/shdom_view/shdom_view.h"
#include "shaders/common/counters.h"
#include "shaders/common/scene_args.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { N = 10, CELLS = N * N * N, BANDS = 3, SIDE = N + 2 };

static const struct medium_block medium = {
    .extent = {1, 1, 1}, .size = {1, 1, 1}, .num_shapes = 1, .voxel = {1, 1, 1}, .max_density = 1};

// The picture's light at the middle of the cells along z, of a medium of sigma_s 6, sigma_a 2 and this g.
static const float *run(gpu_test *t, float g, const float forward[3])
{
    struct camera_block camera = {.orthographic = 1};
    memcpy(camera.forward, forward, sizeof camera.forward);
    static float cells[CELLS][4], sent[16 * CELLS];
    for (int i = 0; i < CELLS; i++) {
        cells[i][0] = 6 * (1 - g * g);
        cells[i][1] = 2;
        cells[i][2] = g / (1 + g);
        sent[i] = 3.5449077f * 5; // a source function of 5
    }
    tyn_graph_begin(t->graph);
    tyn_shdom_view_params p;
    tyn_pass_defaults(&tyn_pass_shdom_view, &p);
    p.bands = BANDS;
    p.channels = 1;
    p.tint[0] = 1;
    p.tint[1] = 0.5f;
    p.grey = 1;
    tyn_ref refs[SHDOM_VIEW_NUM_PORTS] = {
        [SHDOM_VIEW_PORT_MEDIUM] = gpu_buffer(t, "medium", &medium, sizeof medium),
        [SHDOM_VIEW_PORT_CAMERA] = gpu_buffer(t, "camera", &camera, sizeof camera),
        [SHDOM_VIEW_PORT_CELLS] =
            gpu_image(t, "cells", TYN_IMAGE_3D, (tyn_extent){N, N, N}, 4, &cells[0][0]),
        [SHDOM_VIEW_PORT_SENT_0] = gpu_buffer(t, "sent", sent, sizeof sent)};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_shdom_view, &p, refs), TYN_OK);
    tyn_graph_output(t->graph, "seen", refs[SHDOM_VIEW_PORT_INSCATTER], true);
    tyn_graph_output(t->graph, "counters", refs[SHDOM_VIEW_PORT_COUNTERS], true);
    gpu_run(t);
    assert_int_equal(gpu_non_finite(t), 0);
    return gpu_map(t, "seen");
}

static void closed_form(void **state)
{
    static const float gs[] = {0, 0.6f, 0.9f}, forward[2][3] = {{0, 0, -1}, {0, 0.8f, 0.6f}};
    double worst = 0;
    for (int i = 0; i < 6; i++) {
        const double g = (double)gs[i % 3], f = pow(g, BANDS), extinction = 2 + (1 - f) * 6;
        const float *d = forward[i / 3];
        const float *seen = run(*state, gs[i % 3], d);
        for (int z = 0; z < N; z++) {
            const double p[3] = {0.45, 0.45, (z + 0.5) / N}; // away from the eye, along `forward`
            double way = 9;
            for (int a = 0; a < 3; a++) {
                const double to = d[a] > 0 ? 1 - p[a] : p[a];
                way = d[a] != 0 && to / fabs((double)d[a]) < way ? to / fabs((double)d[a]) : way;
            }
            const double expected = 5.0 / 6 + f * 5 / extinction * (1 - exp(-extinction * way));
            const float *s = seen + 4 * (((z + 1) * SIDE + N / 2) * SIDE + N / 2);
            worst = maximum(worst, fabs((double)s[0] / expected - 1));
            worst = maximum(worst, fabs((double)s[1] / expected - 0.5));
            worst = maximum(worst, fabs((double)s[2]));
        }
    }
    print_message("worst cell: %.1e\n", worst);
    assert_true(worst <= 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(closed_form)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
