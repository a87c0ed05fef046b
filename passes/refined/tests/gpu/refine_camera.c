// refine_camera.c -- the camera of the image of samples: its rays are those of the picture.
#include "gpu_test.h"
#include "bound.h"
#include "numbers.h"
#include "passes/refined/refine_camera/refine_camera.h"
#include <math.h>

// How far beside the axis a position is, in M (camera_across of shaders/common/camera.glsl).
static void across(const struct camera_block *c, double x, double y, double out[2])
{
    const double s = 2 * (x + c->corner[0]) / (double)(c->size[0] + c->beyond[0]) - 1;
    const double t = 2 * (y + c->corner[1]) / (double)(c->size[1] + c->beyond[1]) - 1;
    out[0] = (s + (double)c->shift[0]) * (double)c->half_width;
    out[1] = ((double)c->shift[1] - t) * (double)c->half_height;
}

static void rays(void **state)
{
    gpu_test *t = *state;
    const struct camera_block views[] = {
        {.half_width = 0.7f, .half_height = 0.4f, .right = {1, 0, 0}, .size = {128, 72}},
        {.half_width = 0.7f, .half_height = 0.9f, .size = {101, 67}, .shift = {0.3f, -0.2f}},
        {.half_width = 2,
         .half_height = 1,
         .size = {37, 29},
         .corner = {20, 11},
         .beyond = {63, 40}},
    };
    double worst = 0;
    for (int i = 0; i < 3; i++) {
        for (uint32_t grid = 1; grid <= 16; grid *= 2) {
            tyn_refine_camera_params params = {.camera = views[i]};
            tyn_refine_camera(&views[i], grid, &params.camera);
            tyn_ref refs[TYN_MAX_PORTS] = {{0}};
            tyn_graph_begin(t->graph);
            assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_refine_camera, &params, refs),
                             TYN_OK);
            tyn_graph_output(t->graph, "camera", refs[REFINE_CAMERA_PORT_CAMERA], true);
            gpu_run(t);
            const struct camera_block *made = gpu_map(t, "camera");
            assert_int_equal(made->size[0], (views[i].size[0] + grid - 1) / grid);
            assert_int_equal(made->size[1], (views[i].size[1] + grid - 1) / grid);
            assert_true(made->right[0] == views[i].right[0]);
            for (int k = 0; k < 9; k++) {
                const double x = (k % 3) * 0.5 * views[i].size[0],
                             y = (k / 3) * 0.5 * views[i].size[1];
                double whole[2], part[2];
                across(&views[i], x, y, whole);
                across(made, x / grid, y / grid, part);
                worst = maximum(worst, hypot(whole[0] - part[0], whole[1] - part[1]));
            }
        }
    }
    assert_true(
        within(worst, 1e-6, BOUND_ROUNDING, "rays of the samples beside those of the picture"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rays)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
