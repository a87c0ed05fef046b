// rig.c -- see rig.h.
#include "rig.h"
#include "solids.h"
#include "states.h"
#include "vulkan_tap.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { VOXELS = 12, MAP = 8 };

static void on_log(void *user, tyn_log_level level, const char *message)
{
    rig *r = user;
    if (level == TYN_LOG_ERROR) {
        r->errors++;
        snprintf(r->last_error, sizeof r->last_error, "%s", message);
    }
    if (!r->quiet || level != TYN_LOG_ERROR) {
        fprintf(stderr, "tyndall: %s\n", message);
    }
}

tyn_log rig_log(rig *r)
{
    return (tyn_log){on_log, r, TYN_LOG_WARN};
}

static void make_ball(tyn_scene *scene)
{
    scene->num_volumes = 1;
    scene->volumes = calloc(1, sizeof(tyn_volume));
    tyn_volume *v = &scene->volumes[0];
    *v = (tyn_volume){.size = {VOXELS, VOXELS, VOXELS}, .hash = 1};
    v->data = malloc(sizeof(float) * VOXELS * VOXELS * VOXELS);
    for (int z = 0, i = 0; z < VOXELS; z++) {
        for (int y = 0; y < VOXELS; y++) {
            for (int x = 0; x < VOXELS; x++, i++) {
                const float p[3] = {(float)(2 * x + 1) / VOXELS - 1,
                                    (float)(2 * y + 1) / VOXELS - 1,
                                    (float)(2 * z + 1) / VOXELS - 1};
                const float left = 1 - (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
                v->data[i] = left > 0 ? left : 0;
                v->max_density = v->data[i] > v->max_density ? v->data[i] : v->max_density;
            }
        }
    }
    scene->num_media = 1;
    scene->media[0] = (tyn_medium){.sigma_s = {3, 3.5f, 4},
                                   .sigma_a = {0.3f, 0.2f, 0.1f},
                                   .phase = {{.g = 0.6f}, {.g = 0.6f}, {.g = 0.6f}},
                                   .density_scale = 1};
    scene->num_shapes = 1;
    scene->shapes[0] = (tyn_shape){.kind = TYN_SHAPE_BOX};
    for (int i = 0; i < 4; i++) {
        scene->shapes[0].to_world[5 * i] = i < 3 ? 2 : 1;
    }
}

static void make_lights(tyn_scene *scene)
{
    scene->num_lights = 2;
    scene->lights[0] = (tyn_light){
        .kind = TYN_LIGHT_DIRECTIONAL, .color = {3, 3, 2.5f}, .direction = {-0.6f, -0.8f, 0}};
    scene->lights[1] = (tyn_light){
        .kind = TYN_LIGHT_POINT, .color = {0.5f, 0.4f, 0.3f}, .position = {0.8f, 1.4f, 0.2f}};
    tyn_environment *env = &scene->environment;
    env->present = true;
    env->size[0] = 2 * MAP;
    env->size[1] = MAP;
    env->hash = 1;
    env->data = malloc(sizeof(float[3]) * 2 * MAP * MAP);
    for (int i = 0; i < 2 * MAP * MAP; i++) {
        const float sky = i < MAP * MAP ? 0.3f : 0.05f; // rows from the top
        env->data[3 * i] = env->data[3 * i + 1] = sky;
        env->data[3 * i + 2] = 1.5f * sky;
    }
}

bool rig_open(rig *r, bool validation)
{
    *r = (rig){0};
    if (host_open(&r->host, validation) != HOST_OK) {
        return false;
    }
    const tyn_log log = rig_log(r);
    assert_int_equal(tyn_settings_create(&r->settings), TYN_OK);
    assert_int_equal(tyn_settings_set(r->settings, "lattice.cells", "8", &log), TYN_OK);
    assert_int_equal(tyn_settings_set(r->settings, "shadow_map.sun_texels", "64", &log), TYN_OK);
    tyn_scene_init(&r->scene);
    make_ball(&r->scene);
    make_lights(&r->scene);
    const uint32_t grey = solids_material(&r->scene, (float[]){0.5f, 0.5f, 0.5f}, (float[3]){0});
    solids_quad(&r->scene, (float[]){-2, -0.9f, -2}, (float[]){0, 0, 4}, (float[]){4, 0, 0}, grey);
    r->view = (tyn_view){.camera = {.projection = TYN_PERSPECTIVE,
                                    .position = {0, 0, 5},
                                    .right = {1, 0, 0},
                                    .up = {0, 1, 0},
                                    .back = {0, 0, 1},
                                    .yfov = 0.6f},
                         .outputs = TYN_OUTPUT_COMPOSITE,
                         .no_background = true};
    rig_resize(r, RIG_WIDTH, RIG_HEIGHT);
    return true;
}

static void free_picture(rig *r)
{
    if (r->color.image) {
        host_image_free(&r->host, &r->color);
        host_buffer_free(&r->host, &r->black);
        host_buffer_free(&r->host, &r->picture);
    }
}

void rig_resize(rig *r, uint32_t width, uint32_t height)
{
    free_picture(r);
    r->view.width = width;
    r->view.height = height;
    r->color =
        host_image_new(&r->host, VK_FORMAT_R32G32B32A32_SFLOAT, (VkExtent3D){width, height, 1},
                       VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                           VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    const VkDeviceSize bytes = (VkDeviceSize)width * height * 16;
    r->black = host_buffer_new(&r->host, bytes);
    r->picture = host_buffer_new(&r->host, bytes);
    memset(r->black.data, 0, bytes);
}

void rig_close(rig *r)
{
    free_picture(r);
    tyn_scene_finish(&r->scene);
    tyn_settings_destroy(&r->settings);
    host_close(&r->host);
    assert_int_equal(r->host.messages, 0);
}

tyn_result rig_device(rig *r, bool tap, const tyn_allocator *allocator, tyn_device **out)
{
    tyn_device_params params = {.struct_size = sizeof params, .log = rig_log(r)};
    host_describe(&r->host, &params);
    if (tap) {
        params.get_instance_proc_addr = tap_open(params.get_instance_proc_addr);
    }
    if (allocator) {
        params.allocator = *allocator;
    }
    return tyn_device_create(&params, out);
}

tyn_result rig_context(rig *r, tyn_device *dev, const char *method, tyn_context **out)
{
    return tyn_context_create(dev,
                              tyn_context_params(.method = method, .settings = r->settings,
                                                 .frames_in_flight = HOST_SLOTS),
                              out);
}

tyn_result rig_prepare(rig *r, tyn_context *ctx)
{
    host_image copy = r->color;
    const tyn_image lent = host_lend(&copy, drawn_to);
    return tyn_context_prepare(ctx,
                               tyn_frame(.scene = &r->scene, .view = &r->view, .color = &lent));
}

VkCommandBuffer rig_begin(rig *r, uint32_t slot)
{
    const VkCommandBuffer cmd = host_begin(&r->host, slot);
    r->color.state = nothing_yet;
    host_transition(&r->host, cmd, &r->color, copy_target);
    host_upload(&r->host, cmd, &r->black, &r->color);
    host_transition(&r->host, cmd, &r->color, drawn_to);
    return cmd;
}

tyn_result rig_record(rig *r, tyn_context *ctx, VkCommandBuffer cmd)
{
    host_image copy = r->color;
    const tyn_image lent = host_lend(&copy, drawn_to);
    return tyn_context_record(
        ctx, tyn_frame(.cmd = cmd, .scene = &r->scene, .view = &r->view, .color = &lent));
}

void rig_end(rig *r, uint32_t slot)
{
    host_transition(&r->host, r->host.commands[slot], &r->color, copy_source);
    host_download(&r->host, r->host.commands[slot], &r->color, &r->picture);
    host_submit(&r->host, slot);
    host_wait(&r->host, slot);
}

void rig_frame(rig *r, tyn_context *ctx)
{
    assert_int_equal(rig_prepare(r, ctx), TYN_OK);
    const VkCommandBuffer cmd = rig_begin(r, 0);
    assert_int_equal(rig_record(r, ctx, cmd), TYN_OK);
    rig_end(r, 0);
}

double rig_light(const rig *r)
{
    const float *pixels = r->picture.data;
    double sum = 0;
    for (uint32_t i = 0; i < 4 * r->view.width * r->view.height; i++) {
        sum += i % 4 < 3 ? (double)pixels[i] : 0;
    }
    return sum;
}

void rig_expect_silence(const rig *r)
{
    assert_int_equal(r->host.messages, 0);
    assert_int_equal(r->errors, 0);
}
