// composite.c -- color x transmittance + radiance, on float and half images, and on images twice as large.
#include "gpu_test.h"
#include "passes/composite/composite.h"
#include "base/half.h"
#include "bound.h"
#include "numbers.h"
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

// ---- twice as large -----------------------------------------------------------------------------

enum { FULL_W = 2 * W, FULL_H = 2 * H, EDGE = 17 };
static const float nearest = 0.25f; // of a reversed, infinite depth: depth = nearest / distance

// A wall on the left, nearly level, before one far behind; the edge cuts a pixel of the small picture in two.
static double distance_at(int x, int y)
{
    return x < EDGE ? 2 + 0.002 * x : 5 + 0.01 * y;
}

static float radiance_at(int x)
{
    return 2 * x < EDGE ? 1 : 5;
}

static float transmittance_at(int x)
{
    return 2 * x < EDGE ? 0.9f : 0.2f;
}

// Of the joint bilateral filter (Kopf et al. 2007): bilinear weights times 1 / (1 + (relative difference / 2 %)^2).
static void twin(int x, int y, bool deep, double *light, double *passed)
{
    double weights = 0;
    *light = *passed = 0;
    for (int j = 0; j < H; j++) {
        for (int i = 0; i < W; i++) {
            const double dx = fabs(2 * i + 0.5 - x) / 2, dy = fabs(2 * j + 0.5 - y) / 2;
            // Beyond the rim the outermost pixel stands for those that are not there.
            const bool rim_x = (i == 0 && x < 2 * i + 1) || (i == W - 1 && x > 2 * i);
            const bool rim_y = (j == 0 && y < 2 * j + 1) || (j == H - 1 && y > 2 * j);
            double weight = (rim_x ? 1 : maximum(1 - dx, 0)) * (rim_y ? 1 : maximum(1 - dy, 0));
            if (deep) {
                const double here = distance_at(x, y), there = distance_at(2 * i, 2 * j);
                // Of 1 / distance, to the larger of both.
                const double off = fabs(here - there) / maximum(here, there) / 0.02;
                weight /= 1 + off * off;
            }
            *light += weight * (double)radiance_at(i);
            *passed += weight * (double)transmittance_at(i);
            weights += weight;
        }
    }
    *light /= weights;
    *passed /= weights;
}

static void joint_of(gpu_test *t, bool deep)
{
    static float radiance[N], transmittance[N], small_depth[W * H], depth[FULL_W * FULL_H];
    static float below[FULL_W * FULL_H * 4], none[FULL_W * FULL_H * 4];
    for (int i = 0; i < N; i++) {
        const int x = i / 4 % W;
        radiance[i] = radiance_at(x);
        transmittance[i] = transmittance_at(x);
    }
    for (int i = 0; i < W * H; i++) {
        small_depth[i] = (float)((double)nearest / distance_at(2 * (i % W), 2 * (i / W)));
    }
    for (int i = 0; i < FULL_W * FULL_H; i++) {
        depth[i] = (float)((double)nearest / distance_at(i % FULL_W, i / FULL_W));
        for (int c = 0; c < 4; c++) {
            below[4 * i + c] = 0.25f * (float)(i % 23);
        }
    }
    const tyn_extent small = {W, H, 1}, large = {FULL_W, FULL_H, 1};
    tyn_graph_begin(t->graph);
    // The host's picture, laid over what the image held before, of which nothing is left.
    tyn_ref laid = add(t, false, gpu_image(t, "below", TYN_IMAGE_2D, large, 4, below),
                       gpu_image(t, "none", TYN_IMAGE_2D, large, 4, none), blank(t, false, large));
    tyn_ref refs[COMPOSITE_NUM_PORTS] = {
        [COMPOSITE_PORT_RADIANCE] = gpu_image(t, "radiance", TYN_IMAGE_2D, small, 4, radiance),
        [COMPOSITE_PORT_TRANSMITTANCE] =
            gpu_image(t, "transmittance", TYN_IMAGE_2D, small, 4, transmittance),
        [COMPOSITE_PORT_COLOR] = laid,
    };
    tyn_composite_params params = {.joint = 1};
    if (deep) {
        refs[COMPOSITE_PORT_HALF_DEPTH] =
            gpu_image(t, "half_depth", TYN_IMAGE_2D, small, 1, small_depth);
        refs[COMPOSITE_PORT_FULL_DEPTH] = gpu_image(t, "depth", TYN_IMAGE_2D, large, 1, depth);
        memcpy(params.depth, (float[4]){0, nearest, -1, 0}, sizeof params.depth);
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_composite, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "color", refs[COMPOSITE_PORT_COLOR], true);
    gpu_run(t);
    const float *out = gpu_map(t, "color");
    double worst = 0, blurred = 0;
    for (int i = 0; i < FULL_W * FULL_H; i++) {
        const int x = i % FULL_W;
        double light, passed;
        twin(x, i / FULL_W, deep, &light, &passed);
        const double under = (double)below[4 * i], found = (double)out[4 * i];
        worst = maximum(worst, fabs(found - (under * passed + light)));
        // Of what is on this side of the edge in the small picture, in parts of the step across it.
        const bool left = x < EDGE;
        const double own = under * (left ? 0.9 : 0.2) + (left ? 1 : 5);
        const double other = under * (left ? 0.2 : 0.9) + (left ? 5 : 1);
        blurred = maximum(blurred, fabs(found - own) / fabs(other - own));
    }
    print_message("%s: %.2g off its twin, %.2g of the step at the edge blurred\n",
                  deep ? "with depth" : "without", worst, blurred);
    assert_true(worst <= 1e-5);
    if (deep) {
        assert_within(blurred, 6e-3, NULL);
    } else {
        assert_true(blurred > 0.5);
    }
}

static void edges_are_kept(void **state)
{
    joint_of(*state, true);
}

static void without_depth_is_bilinear(void **state)
{
    joint_of(*state, false);
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
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(full), cmocka_unit_test(half), cmocka_unit_test(edges_are_kept),
        cmocka_unit_test(without_depth_is_bilinear), cmocka_unit_test(other_size)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
