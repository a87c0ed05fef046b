// outputs.c -- what a host can take away: results and the light field in images of its own.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "built_in.h"
#include "base/half.h"
#include "bound.h"
#include "fog_host.h"
#include "numbers.h"
#include "skip.h"
#include "states.h"

// ---- results in images of the host --------------------------------------------------------------

static host_image result_image(fixture *f, VkFormat format, VkExtent3D size)
{
    return host_image_new(&f->host, format, size,
                          VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                              VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
}

static const struct {
    tyn_output output;
    VkFormat formats[2];
} results[3] = {
    {TYN_OUTPUT_RADIANCE, {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT}},
    {TYN_OUTPUT_TRANSMITTANCE, {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT}},
    {TYN_OUTPUT_DEPTH, {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT}},
};

static const char *const result_names[3] = {"radiance", "transmittance", "depth"};

static uint32_t texel_bytes(VkFormat format)
{
    return format == VK_FORMAT_R32G32B32A32_SFLOAT   ? 16
           : format == VK_FORMAT_R16G16B16A16_SFLOAT ? 8
                                                     : 4;
}

static float value_at(const host_buffer *buffer, VkFormat format, size_t i)
{
    return format == VK_FORMAT_R16G16B16A16_SFLOAT
               ? tyn_half_to_float(((const uint16_t *)buffer->data)[i])
               : ((const float *)buffer->data)[i];
}

// The host goes on from the states that it was promised: it copies them out.
static void images_of(fixture *f, const char *method, int round)
{
    tyn_scene scene;
    make_scene(&scene);
    tyn_context *ctx = new_context(f, method);
    const tyn_view view =
        make_view(TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE | TYN_OUTPUT_DEPTH);
    host_image image[3];
    host_buffer down[3];
    tyn_image lent[3];
    for (int i = 0; i < 3; i++) {
        const VkFormat format = results[i].formats[round];
        image[i] = result_image(f, format, (VkExtent3D){WIDTH, HEIGHT, 1});
        down[i] = host_buffer_new(&f->host, (VkDeviceSize)PIXELS * texel_bytes(format));
        image[i].state = nothing_yet;
    }
    tyn_frame frame = {.struct_size = sizeof frame,
                       .scene = &scene,
                       .view = &view,
                       .images = {&lent[0], &lent[1], &lent[2]}};
    // Twice: nothing has changed the second time, and the images may be others.
    for (int again = 0; again < 2; again++) {
        const VkCommandBuffer cmd = host_begin(&f->host, 0);
        for (int i = 0; i < 3; i++) {
            image[i].state = again ? image[i].state : nothing_yet;
            lent[i] = host_lend(&image[i], round ? general : copy_source);
        }
        if (!again) {
            assert_int_equal(tyn_context_prepare(ctx, &frame), TYN_OK);
        }
        frame.cmd = cmd;
        assert_int_equal(tyn_context_record(ctx, &frame), TYN_OK);
        for (int i = 0; i < 3; i++) {
            memset(down[i].data, 0xff, down[i].size);
            host_transition(&f->host, cmd, &image[i], copy_source);
            host_download(&f->host, cmd, &image[i], &down[i]);
        }
        host_submit(&f->host, 0);
        host_wait(&f->host, 0);
        for (int i = 0; i < 3; i++) {
            const VkFormat format = results[i].formats[round];
            const size_t channels = format == VK_FORMAT_R32_SFLOAT ? 1 : 4;
            const double rounding =
                format == VK_FORMAT_R16G16B16A16_SFLOAT ? 1e-3 : 0; // either way
            const float *right = tyn_context_output(ctx, results[i].output);
            double largest = 0;
            for (size_t k = 0; k < PIXELS * channels; k++) {
                const double expected = (double)right[k / channels * 4 + k % channels];
                const double found = (double)value_at(&down[i], format, k);
                largest = maximum(largest, expected);
                // Smaller than 6e-5 half floats have fewer bits.
                if (found != expected && // infinities
                    !(fabs(found - expected) <=
                      rounding * fabs(expected) + (rounding > 0 ? 6e-8 : 0))) {
                    fail_msg("%s, texel %zu channel %zu is %g, not %g", result_names[i],
                             k / channels, k % channels, found, expected);
                }
            }
            assert_true(largest > 0.05);
        }
    }
    for (int i = 0; i < 3; i++) {
        host_image_free(&f->host, &image[i]);
        host_buffer_free(&f->host, &down[i]);
    }
    tyn_context_destroy(&ctx);
    tyn_scene_finish(&scene);
    assert_int_equal(f->lines, 0);
}

static void images(void **state)
{
    images_of(*state, "pop", 0);
    images_of(*state, "pop", 1);
    images_of(*state, "single", 0);
}

// ---- the light field ----------------------------------------------------------------------------

enum { FIELD_X = 9, FIELD_Y = 7, FIELD_Z = 5, FIELD = FIELD_X * FIELD_Y * FIELD_Z };

// World position of a texture coordinate: the matrix is a similarity along each axis times a turn.
static void from_texture(const float m[16], const double at[3], float world[3])
{
    for (int k = 0; k < 3; k++) {
        double sum = 0;
        for (int i = 0; i < 3; i++) {
            const double length2 =
                (double)m[i] * m[i] + (double)m[4 + i] * m[4 + i] + (double)m[8 + i] * m[8 + i];
            sum += (double)m[4 * k + i] * (at[i] - (double)m[12 + i]) / length2;
        }
        world[k] = (float)sum;
    }
}

// Against probes at the middles of texels, of the mean fluence; `format` of the images.
static double light_error(fixture *f, const char *method, VkFormat format, bool unscattered)
{
    static const VkExtent3D size = {FIELD_X, FIELD_Y, FIELD_Z};
    tyn_scene scene;
    make_scene(&scene);
    tyn_context *ctx = new_context(f, method);
    tyn_view view = make_view(TYN_OUTPUT_LIGHT);
    host_image image[3];
    host_buffer down[3];
    tyn_image lent[3];
    const VkCommandBuffer cmd = host_begin(&f->host, 0);
    for (int i = 0; i < 3; i++) {
        image[i] = result_image(f, format, size);
        image[i].state = nothing_yet;
        down[i] = host_buffer_new(&f->host, (VkDeviceSize)FIELD * texel_bytes(format));
        lent[i] = host_lend(&image[i], copy_source);
    }
    tyn_frame frame = {.struct_size = sizeof frame,
                       .cmd = cmd,
                       .scene = &scene,
                       .view = &view,
                       .light = {&lent[0], &lent[1], &lent[2], unscattered}};
    float to_texture[16];
    assert_int_equal(tyn_context_prepare(ctx, &frame), TYN_OK);
    assert_int_equal(tyn_context_record(ctx, &frame), TYN_OK);
    assert_int_equal(tyn_context_light(ctx, to_texture), TYN_OK);
    for (int i = 0; i < 3; i++) {
        host_download(&f->host, cmd, &image[i], &down[i]);
    }
    host_submit(&f->host, 0);
    host_wait(&f->host, 0);

    static float points[FIELD][3];
    for (int i = 0; i < FIELD; i++) {
        const double at[3] = {(i % FIELD_X + 0.5) / FIELD_X,
                              (i / FIELD_X % FIELD_Y + 0.5) / FIELD_Y,
                              (i / (FIELD_X * FIELD_Y) + 0.5) / FIELD_Z};
        from_texture(to_texture, at, points[i]);
    }
    view.outputs = TYN_OUTPUT_PROBE;
    view.points = (const float(*)[3])points, view.num_points = FIELD;
    view.scattered_only = !unscattered;
    frame.light = (tyn_frame_lights){0};
    assert_int_equal(tyn_context_prepare(ctx, &frame), TYN_OK);
    frame.cmd = host_begin(&f->host, 0);
    assert_int_equal(tyn_context_record(ctx, &frame), TYN_OK);
    host_submit(&f->host, 0);
    host_wait(&f->host, 0);
    const tyn_probe_result *probes = tyn_context_output(ctx, TYN_OUTPUT_PROBE);
    double worst = 0, mean = 0;
    for (int i = 0; i < FIELD; i++) {
        for (int c = 0; c < 3; c++) {
            mean += (double)probes[i].fluence[c] / (3 * FIELD);
            for (int k = 0; k < 4; k++) {
                const float right = k == 0 ? probes[i].fluence[c] : probes[i].flux[3 * (k - 1) + c];
                const float found = value_at(&down[c], format, 4 * (size_t)i + (size_t)k);
                worst = maximum(worst, fabs((double)found - (double)right));
            }
        }
    }
    assert_true(mean > 0.01);
    for (int i = 0; i < 3; i++) {
        host_image_free(&f->host, &image[i]);
        host_buffer_free(&f->host, &down[i]);
    }
    tyn_context_destroy(&ctx);
    tyn_scene_finish(&scene);
    assert_int_equal(f->lines, 0);
    print_message("%s: %.2g of the mean fluence, %g\n", method, worst / mean, mean);
    return worst / mean;
}

static void light(void **state)
{
    fixture *f = *state;
    assert_true(light_error(f, "pop", VK_FORMAT_R32G32B32A32_SFLOAT, false) <= 2e-5);
    assert_true(light_error(f, "pop", VK_FORMAT_R32G32B32A32_SFLOAT, true) <= 2e-5);
    if (is_built_in("lpv")) {
        assert_true(light_error(f, "lpv", VK_FORMAT_R32G32B32A32_SFLOAT, false) <= 2e-5);
    }
    const double in_halves = light_error(f, "pop", VK_FORMAT_R16G16B16A16_SFLOAT, false);
    assert_within(in_halves, 3e-3, NULL);
}

// ---- misuse -------------------------------------------------------------------------------------

static bool spoil_images(tyn_frame *frame, tyn_view *view, tyn_image image[6], int fault)
{
    switch (fault) {
    case 0:
        view->outputs &= ~(uint32_t)TYN_OUTPUT_DEPTH; // its image is there
        break;
    case 1:
        image[0].format = VK_FORMAT_R8G8B8A8_UNORM;
        break;
    case 2:
        image[2].format = VK_FORMAT_R16G16B16A16_SFLOAT; // holds no distances
        break;
    case 3:
        image[1].extent.width++;
        break;
    case 4:
        image[1].usage = VK_IMAGE_USAGE_SAMPLED_BIT;
        break;
    case 5:
        image[0].view = VK_NULL_HANDLE;
        break;
    case 6:
        image[0].after.layout = VK_IMAGE_LAYOUT_UNDEFINED;
        break;
    case 7:
        frame->light.green = NULL;
        break;
    case 8:
        image[3].format = VK_FORMAT_R32_SFLOAT;
        break;
    case 9:
        image[4].format = VK_FORMAT_R16G16B16A16_SFLOAT;
        break;
    case 10:
        image[5].extent.depth++;
        break;
    case 11:
        for (int i = 3; i < 6; i++) {
            image[i].extent = (VkExtent3D){1024, 1024, 2};
        }
        break;
    case 12:
        image[5].usage = VK_IMAGE_USAGE_SAMPLED_BIT;
        break;
    default:
        return false;
    }
    return true;
}

static void bad_images(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_scene(&scene);
    tyn_context *ctx = new_context(f, "pop");
    host_image own[6];
    for (int i = 0; i < 6; i++) {
        own[i] = result_image(f, VK_FORMAT_R32G32B32A32_SFLOAT,
                              i < 3 ? (VkExtent3D){WIDTH, HEIGHT, 1} : (VkExtent3D){4, 4, 4});
        own[i].state = nothing_yet;
    }
    float matrix[16];
    assert_int_equal(tyn_context_light(ctx, matrix), TYN_ERR_PARAMS); // nothing is prepared
    assert_int_equal(f->lines, 1);
    for (int fault = 0;; fault++) {
        tyn_view view = make_view(TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE |
                                  TYN_OUTPUT_DEPTH | TYN_OUTPUT_LIGHT);
        tyn_image image[6];
        for (int i = 0; i < 6; i++) {
            host_image lent = own[i];
            image[i] = host_lend(&lent, general);
        }
        tyn_frame frame = {.struct_size = sizeof frame,
                           .scene = &scene,
                           .view = &view,
                           .images = {&image[0], &image[1], &image[2]},
                           .light = {&image[3], &image[4], &image[5], false}};
        const bool spoiled = spoil_images(&frame, &view, image, fault);
        f->lines = 0;
        assert_int_equal(tyn_context_prepare(ctx, &frame), spoiled ? TYN_ERR_PARAMS : TYN_OK);
        assert_int_equal(f->lines, spoiled);
        if (!spoiled) {
            break;
        }
    }
    tyn_context_destroy(&ctx);
    // A method without a field of light from all sides.
    ctx = new_context(f, "single");
    const tyn_view view = make_view(TYN_OUTPUT_LIGHT);
    const tyn_frame frame = {.struct_size = sizeof frame, .scene = &scene, .view = &view};
    assert_int_equal(tyn_context_prepare(ctx, &frame), TYN_ERR_PARAMS);
    assert_int_equal(f->lines, 1);
    assert_non_null(strstr(f->last_line, "'single' cannot make the output 'light'"));
    assert_non_null(strstr(f->last_line, "no probes"));
    assert_non_null(strstr(f->last_line, "pop, "));
    tyn_context_destroy(&ctx);
    for (int i = 0; i < 6; i++) {
        host_image_free(&f->host, &own[i]);
    }
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matrices),
        cmocka_unit_test(jitter),
        cmocka_unit_test(depth_under_matrices),
        cmocka_unit_test(bad_views),
        cmocka_unit_test(images),
        cmocka_unit_test(light),
        cmocka_unit_test(half_resolution),
        cmocka_unit_test(depth_with_stencil),
        cmocka_unit_test(refined_without_depth),
        cmocka_unit_test(bad_images),
    };
    return run_cases(tests, set_up, tear_down);
}
