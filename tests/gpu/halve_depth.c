// halve_depth.c -- of 2 x 2 texels the least on white squares of a chessboard, the largest on black ones.
#include "gpu_test.h"
#include "passes/halve_depth/halve_depth.h"

#include <math.h>
#include <string.h>

enum { W = 22, H = 14 };

static void chessboard(void **state)
{
    gpu_test *t = *state;
    float depth[W * H];
    for (int i = 0; i < W * H; i++) {
        depth[i] = (float)(i * 7919 % 1009) / 1009;
    }
    tyn_graph_begin(t->graph);
    const tyn_halve_depth_params params = {0};
    tyn_ref refs[HALVE_DEPTH_NUM_PORTS] = {
        gpu_image(t, "depth", TYN_IMAGE_2D, (tyn_extent){W, H, 1}, 1, depth)};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_halve_depth, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "half", refs[HALVE_DEPTH_PORT_HALF_DEPTH], true);
    gpu_run(t);
    const float *half = gpu_map(t, "half");
    for (int y = 0; y < H / 2; y++) {
        for (int x = 0; x < W / 2; x++) {
            float least = 2, most = -1;
            for (int k = 0; k < 4; k++) {
                const float d = depth[(2 * y + k / 2) * W + 2 * x + k % 2];
                least = d < least ? d : least;
                most = d > most ? d : most;
            }
            assert_true(half[y * (W / 2) + x] == ((x + y) % 2 ? most : least));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(chessboard)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
