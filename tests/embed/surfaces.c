// surfaces.c -- a host whose scene has surfaces: what Tyndall rasterises into the host's command buffer, frame
// after frame, under validation and synchronization validation.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <tyndall/context.h>
#include <tyndall/registry.h>

#include "host.h"
#include "skip.h"
#include "solids.h"
#include "states.h"

enum { WIDTH = 64, HEIGHT = 48, FRAMES = 5 };

static uint32_t errors;

static void on_log(void *user, tyn_log_level level, const char *message)
{
    (void)user;
    errors += level == TYN_LOG_ERROR;
    fprintf(stderr, "tyndall: %s\n", message);
}

// A cube of fog, a card above its left half, a floor; a sun straight above and a lamp.
static void make_scene(tyn_scene *scene)
{
    tyn_scene_init(scene);
    scene->num_media = 1;
    scene->media[0] = (tyn_medium){.sigma_s = {0.5f, 0.5f, 0.5f}, .density_scale = 1, .volume = -1};
    scene->num_shapes = 1;
    scene->shapes[0] = (tyn_shape){.kind = TYN_SHAPE_BOX};
    for (int i = 0; i < 4; i++) {
        scene->shapes[0].to_world[5 * i] = i < 3 ? 2 : 1;
    }
    scene->num_lights = 2;
    scene->lights[0] =
        (tyn_light){.kind = TYN_LIGHT_DIRECTIONAL, .color = {3, 3, 3}, .direction = {0, -1, 0}};
    scene->lights[1] = (tyn_light){
        .kind = TYN_LIGHT_POINT, .color = {0.1f, 0.2f, 0.3f}, .position = {0.8f, -0.5f, 0}};
    const uint32_t m = solids_material(scene, (float[]){0.5f, 0.5f, 0.5f}, (float[3]){0});
    solids_quad(scene, (float[]){-1.5f, 1.2f, -1.5f}, (float[]){0, 0, 3}, (float[]){1.5f, 0, 0}, m);
    solids_quad(scene, (float[]){-2, -0.9f, -2}, (float[]){0, 0, 4}, (float[]){4, 0, 0}, m);
}

// Mean red of a part of the picture.
static double mean(const host_buffer *picture, uint32_t x0, uint32_t x1)
{
    double sum = 0;
    for (uint32_t y = 4; y < HEIGHT / 2; y++) {
        for (uint32_t x = x0; x < x1; x++) {
            sum += (double)((const float *)picture->data)[4 * (y * WIDTH + x)];
        }
    }
    return sum / ((double)(x1 - x0) * (HEIGHT / 2 - 4));
}

static void shadows_in_a_host(void **state)
{
    (void)state;
    host h = {0};
    if (host_open(&h, true) != HOST_OK) {
        skip_all("the host has no device");
    }
    tyn_device_params params = {.struct_size = sizeof params, .log = {on_log, NULL, TYN_LOG_WARN}};
    host_describe(&h, &params);
    tyn_device *dev = NULL;
    assert_int_equal(tyn_device_create(&params, &dev), TYN_OK);
    tyn_settings *settings = NULL;
    assert_int_equal(tyn_settings_create(&settings), TYN_OK);
    assert_int_equal(tyn_settings_set(settings, "lattice.cells", "8", &params.log), TYN_OK);
    assert_int_equal(tyn_settings_set(settings, "shadow_map.sun_texels", "256", &params.log),
                     TYN_OK);
    tyn_context *ctx = NULL;
    assert_int_equal(
        tyn_context_create(
            dev, tyn_context_params(.settings = settings, .frames_in_flight = HOST_SLOTS), &ctx),
        TYN_OK);
    const VkImageUsageFlags usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                    VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                    VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    host_image color =
        host_image_new(&h, VK_FORMAT_R32G32B32A32_SFLOAT, (VkExtent3D){WIDTH, HEIGHT, 1}, usage);
    host_buffer black = host_buffer_new(&h, WIDTH * HEIGHT * 16),
                down = host_buffer_new(&h, WIDTH * HEIGHT * 16);
    memset(black.data, 0, WIDTH * HEIGHT * 16);

    tyn_scene scene;
    make_scene(&scene);
    tyn_view view = {
        .camera = {.projection = TYN_PERSPECTIVE,
                   .position = {0, 0, 5},
                   .right = {1, 0, 0},
                   .up = {0, 1, 0},
                   .back = {0, 0, 1},
                   .yfov = 0.45f},
        .width = WIDTH,
        .height = HEIGHT,
        .outputs = TYN_OUTPUT_COMPOSITE,
        .no_background = true,
    };
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        const uint32_t slot = frame % HOST_SLOTS;
        view.camera.position[2] = 5 + 0.01f * (float)frame;
        scene.lights[0].direction[0] = 0.002f * (float)frame; // everything is drawn anew
        const VkCommandBuffer cmd = host_begin(&h, slot);
        color.state = nothing_yet;
        host_transition(&h, cmd, &color, copy_target);
        host_upload(&h, cmd, &black, &color);
        host_transition(&h, cmd, &color, drawn_to);
        const tyn_image lent = host_lend(&color, drawn_to);
        const tyn_frame f = {
            .struct_size = sizeof f, .cmd = cmd, .scene = &scene, .view = &view, .color = &lent};
        if (frame == 0) {
            assert_int_equal(tyn_context_prepare(ctx, &f), TYN_OK);
        }
        assert_int_equal(tyn_context_record(ctx, &f), TYN_OK);
        host_transition(&h, cmd, &color, copy_source);
        host_download(&h, cmd, &color, &down);
        host_submit(&h, slot);
        host_wait(&h, slot); // the image and the buffers are used by every frame
        const double shaded = mean(&down, 8, 26), lit = mean(&down, 38, 56);
        print_message("frame %u: %.4f under the card, %.4f beside it\n", frame, shaded, lit);
        assert_true(shaded > 0.005 && lit > 1.5 * shaded);
    }
    tyn_report report;
    tyn_context_report(ctx, &report);
    uint32_t drawn = 0;
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        drawn += !strcmp(report.nodes[i].name, "shadow_map") && report.nodes[i].dispatches == 7;
    }
    assert_int_equal(drawn, 1); // a sun and six faces

    tyn_context_destroy(&ctx);
    tyn_settings_destroy(&settings);
    host_wait(&h, 0);
    host_wait(&h, 1);
    host_image_free(&h, &color);
    host_buffer_free(&h, &black);
    host_buffer_free(&h, &down);
    tyn_device_destroy(&dev);
    host_close(&h);
    tyn_scene_finish(&scene);
    assert_int_equal(errors, 0);
    assert_int_equal(h.messages, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(shadows_in_a_host)};
    return run_cases(tests, NULL, NULL);
}
