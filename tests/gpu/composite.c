// composite.c -- color x transmittance + radiance, on float and half images.
#include "gpu_test.h"
#include "passes/composite/composite.h"
#include "base/half.h"
#include <math.h>
#include <string.h>

enum { W = 19, H = 11, N = W * H * 4 };

static tyn_ref add(gpu_test *t, bool half, tyn_ref radiance, tyn_ref transmittance, tyn_ref color)
{
    tyn_ref refs[COMPOSITE_NUM_PORTS] = {
        [COMPOSITE_PORT_RADIANCE] = radiance,
        [COMPOSITE_PORT_TRANSMITTANCE] = transmittance,
        [COMPOSITE_PORT_COLOR] = color,
    };
    tyn_composite_params params = {.half_color = half};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_composite, &params, refs), TYN_OK);
    return refs[COMPOSITE_PORT_COLOR];
}

static tyn_ref blank(gpu_test *t, bool half, tyn_extent extent)
{
    VkFormat format = half ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
    return tyn_graph_history_image(t->graph, "color", TYN_IMAGE_2D, format, extent, 1);
}

// A picture is laid over nothing, then a second one over it.
static void lay(gpu_test *t, bool half)
{
    float radiance[N], transmittance[N], color[N];
    for (int i = 0; i < N; i++) {
        radiance[i] = 0.01f * (float)(i % 37);
        transmittance[i] = (float)(i % 11) / 10.0f;
        color[i] = 0.25f * (float)(i % 23);
    }
    tyn_extent extent = {W, H, 1};
    tyn_graph_begin(t->graph);
    tyn_ref light = gpu_image(t, "radiance", TYN_IMAGE_2D, extent, 4, radiance);
    tyn_ref through = gpu_image(t, "transmittance", TYN_IMAGE_2D, extent, 4, transmittance);
    tyn_ref below = gpu_image(t, "below", TYN_IMAGE_2D, extent, 4, color);
    tyn_ref laid = add(t, half, below, through, blank(t, half, extent));
    laid = add(t, half, light, through, laid);
    tyn_graph_output(t->graph, "color", laid, true);
    gpu_run(t);
    const void *out = gpu_map(t, "color");
    for (int i = 0; i < N; i++) {
        float expected = i % 4 == 3 ? 0 : color[i] * transmittance[i] + radiance[i];
        float value =
            half ? tyn_half_to_float(((const uint16_t *)out)[i]) : ((const float *)out)[i];
        assert_true(fabsf(value - expected) <= (half ? 1e-3f : 1e-6f) * (1 + expected));
    }
}

static void full(void **state)
{
    lay(*state, false);
}

static void half(void **state)
{
    lay(*state, true);
}

static void other_size(void **state)
{
    gpu_test *t = *state;
    float texels[N] = {0};
    tyn_graph_begin(t->graph);
    tyn_ref refs[COMPOSITE_NUM_PORTS] = {
        gpu_image(t, "radiance", TYN_IMAGE_2D, (tyn_extent){W, H, 1}, 4, texels),
        gpu_image(t, "transmittance", TYN_IMAGE_2D, (tyn_extent){W, H, 1}, 4, texels),
        blank(t, false, (tyn_extent){W, H - 1, 1}),
    };
    t->quiet = true;
    tyn_composite_params params = {0};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_composite, &params, refs), TYN_ERR_PARAMS);
    assert_non_null(strstr(t->last_error, "19x10"));
    t->quiet = false;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(full), cmocka_unit_test(half),
                                       cmocka_unit_test(other_size)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
