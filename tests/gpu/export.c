// export.c -- a result in images of each format; what half floats do not hold becomes their largest.
#include "gpu_test.h"
#include "passes/export/export.h"
#include "base/half.h"
#include <math.h>
#include <string.h>

enum { W = 13, H = 9, N = W * H * 4 };

static void formats(void **state)
{
    gpu_test *t = *state;
    static const VkFormat kinds[] = {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT,
                                     VK_FORMAT_R32_SFLOAT};
    float texels[N];
    for (int i = 0; i < N; i++) {
        texels[i] = i == 40 ? 1e9f : 0.25f * (float)(i % 53); // which halves hold exactly
    }
    const tyn_extent extent = {W, H, 1};
    for (uint32_t kind = 0; kind < 3; kind++) {
        tyn_graph_begin(t->graph);
        const tyn_export_params params = {kind};
        tyn_ref refs[EXPORT_NUM_PORTS] = {
            gpu_image(t, "result", TYN_IMAGE_2D, extent, 4, texels),
            tyn_graph_history_image(t->graph, "host", TYN_IMAGE_2D, kinds[kind], extent, 1)};
        assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_export, &params, refs), TYN_OK);
        tyn_graph_output(t->graph, "host", refs[EXPORT_PORT_HOST], true);
        gpu_run(t);
        const void *out = gpu_map(t, "host");
        const int channels = kind == TYN_EXPORT_ONE ? 1 : 4;
        for (int i = 0; i < W * H * channels; i++) {
            const float right = texels[i / channels * 4 + i % channels];
            const float found = kind == TYN_EXPORT_HALF
                                    ? tyn_half_to_float(((const uint16_t *)out)[i])
                                    : ((const float *)out)[i];
            assert_true(found == (kind == TYN_EXPORT_HALF && right > 65504 ? 65504 : right));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(formats)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
