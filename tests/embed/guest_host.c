// guest_host.c -- see guest_host.h.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <tyndall/offline.h>

#include "base/half.h"
#include "guest_host.h"
#include "numbers.h"
#include "offline_frame.h"
#include "skip.h"
#include "states.h"

static const float near_plane = 0.5f, far_plane = 50; // of the host's depth

static void on_log(void *user, tyn_log_level level, const char *message)
{
    fixture *f = user;
    f->errors += level == TYN_LOG_ERROR;
    if (!f->quiet || level != TYN_LOG_ERROR) {
        fprintf(stderr, "tyndall: %s\n", message);
    }
}

tyn_log log_of(fixture *f)
{
    return (tyn_log){on_log, f, TYN_LOG_WARN};
}

tyn_device *new_guest(fixture *f)
{
    tyn_device_params params = {.struct_size = sizeof(params), .log = log_of(f)};
    host_describe(&f->host, &params);
    tyn_device *dev = NULL;
    assert_int_equal(tyn_device_create(&params, &dev), TYN_OK);
    return dev;
}

// Two hazards on purpose, within a submission and between two: the layers must be listening, or their
// silence is worth nothing.
static void check_that_layers_listen(host *h)
{
    h->quiet = true;
    host_image image = host_image_new(h, VK_FORMAT_R32_SFLOAT, (VkExtent3D){8, 8, 1},
                                      VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    host_buffer buffer = host_buffer_new(h, 8 * 8 * 4);
    VkCommandBuffer cmd = host_begin(h, 0);
    host_transition(h, cmd, &image, copy_target);
    host_upload(h, cmd, &buffer, &image);
    host_upload(h, cmd, &buffer, &image);
    host_submit(h, 0);
    const uint32_t within = h->messages;
    cmd = host_begin(h, 1);
    host_upload(h, cmd, &buffer, &image);
    host_submit(h, 1);
    host_wait(h, 0);
    host_wait(h, 1);
    host_image_free(h, &image);
    host_buffer_free(h, &buffer);
    print_message("hazards found: %u within a submission, %u between two\n", within,
                  h->messages - within);
    assert_true(within > 0);
    h->messages = 0;
    h->quiet = false;
}

int set_up(void **state)
{
    fixture *f = calloc(1, sizeof(*f));
    *state = f;
    if (host_open(&f->host, true) != HOST_OK) {
        skip_all("the host has no device");
    }
    check_that_layers_listen(&f->host);
    f->guest = new_guest(f);
    assert_int_equal(tyn_device_open(tyn_device_open_params(.log = log_of(f)), &f->own), TYN_OK);
    assert_int_equal(tyn_settings_create(&f->settings), TYN_OK);
    const tyn_log log = log_of(f);
    assert_int_equal(tyn_settings_set(f->settings, "lattice.cells", "12", &log), TYN_OK);
    return 0;
}

int tear_down(void **state)
{
    fixture *f = *state;
    tyn_settings_destroy(&f->settings);
    tyn_device_destroy(&f->guest);
    tyn_device_destroy(&f->own);
    assert_null(f->guest);
    tyn_device_destroy(&f->guest); // of NULL: nothing happens
    host_close(&f->host);
    const uint32_t messages = f->host.messages;
    free(f);
    if (messages) { // cmocka does not count what a teardown of a group finds
        exit(EXIT_FAILURE);
    }
    return 0;
}

tyn_context *new_context(fixture *f, tyn_device *dev, const char *method)
{
    tyn_context *ctx = NULL;
    assert_int_equal(
        tyn_context_create(dev,
                           tyn_context_params(.method = method, .settings = f->settings,
                                              .frames_in_flight = HOST_SLOTS),
                           &ctx),
        TYN_OK);
    return ctx;
}

// ---- the scenes -------------------------------------------------------------------------------

static char *copy_text(const char *text)
{
    char *copy = malloc(strlen(text) + 1);
    strcpy(copy, text);
    return copy;
}

void make_smoke(tyn_scene *scene)
{
    tyn_scene_init(scene);
    scene->num_volumes = 1;
    scene->volumes = calloc(1, sizeof(tyn_volume));
    tyn_volume *v = &scene->volumes[0];
    *v = (tyn_volume){.name = copy_text("ball"), .size = {VOXELS, VOXELS, VOXELS}, .hash = 1};
    v->data = malloc(sizeof(float) * VOXELS * VOXELS * VOXELS);
    for (int z = 0, i = 0; z < VOXELS; z++) {
        for (int y = 0; y < VOXELS; y++) {
            for (int x = 0; x < VOXELS; x++, i++) {
                const float p[3] = {((float)x + 0.5f) / VOXELS * 2 - 1,
                                    ((float)y + 0.5f) / VOXELS * 2 - 1,
                                    ((float)z + 0.5f) / VOXELS * 2 - 1};
                const float r2 = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
                // What half floats hold exactly, so that a host's R16F image has the same values.
                v->data[i] = floorf(fmaxf(0, 1 - r2) * 64) / 64;
                v->max_density = fmaxf(v->max_density, v->data[i]);
            }
        }
    }
    scene->num_media = 1;
    scene->media[0] = (tyn_medium){.sigma_s = {3, 3.5f, 4},
                                   .sigma_a = {0.3f, 0.2f, 0.1f},
                                   .phase = {{.g = 0.6f}, {.g = 0.6f}, {.g = 0.6f}},
                                   .density_scale = 1,
                                   .volume = 0};
    scene->num_shapes = 1;
    scene->shapes[0] = (tyn_shape){.kind = TYN_SHAPE_BOX, .medium = 0};
    const float diagonal[4] = {2, 2, 2, 1};
    for (int i = 0; i < 4; i++) {
        scene->shapes[0].to_world[5 * i] = diagonal[i];
    }
    scene->num_lights = 1;
    scene->lights[0] = (tyn_light){
        .kind = TYN_LIGHT_DIRECTIONAL, .color = {3, 3, 2.5f}, .direction = {-0.6f, -0.8f, 0}};
}

void make_ink(tyn_scene *scene)
{
    make_smoke(scene);
    scene->media[0] = (tyn_medium){.sigma_a = {0.5f, 1, 2}, .density_scale = 1, .volume = -1};
    free(scene->volumes[0].name);
    free(scene->volumes[0].data);
    free(scene->volumes);
    scene->volumes = NULL;
    scene->num_volumes = 0;
}

tyn_view make_view(float x, uint32_t width, uint32_t height, uint32_t outputs)
{
    return (tyn_view){
        .camera = {.projection = TYN_PERSPECTIVE,
                   .position = {x, 0, 5},
                   .right = {1, 0, 0},
                   .up = {0, 1, 0},
                   .back = {0, 0, 1},
                   .yfov = 0.6f},
        .width = width,
        .height = height,
        .outputs = outputs,
        .no_background = true,
    };
}

void projection(const tyn_view *view, bool reverse_z, float m[16])
{
    const float focal = 1 / tanf(0.5f * view->camera.yfov);
    memset(m, 0, 16 * sizeof(float));
    m[0] = focal * (float)view->height / (float)view->width;
    m[5] = -focal;
    m[11] = -1;
    if (reverse_z) { // and an infinite far plane
        m[14] = near_plane;
    } else {
        m[10] = far_plane / (near_plane - far_plane);
        m[14] = near_plane * m[10];
    }
}

float depth_of(const float m[16], float distance)
{
    return (-distance * m[10] + m[14]) / (-distance * m[11] + m[15]);
}

// ---- a frame of the host ----------------------------------------------------------------------

target new_target(host *h, uint32_t width, uint32_t height, VkFormat color_format)
{
    const VkExtent3D extent = {width, height, 1};
    const VkDeviceSize pixels = (VkDeviceSize)width * height;
    return (target){
        .color =
            host_image_new(h, color_format, extent,
                           VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                               VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                               VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT),
        .depth = host_image_new(
            h, VK_FORMAT_D32_SFLOAT, extent,
            VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT),
        .color_up = host_buffer_new(h, pixels * 16),
        .depth_up = host_buffer_new(h, pixels * 4),
        .color_down = host_buffer_new(h, pixels * 16),
        .depth_down = host_buffer_new(h, pixels * 4),
        .half = color_format == VK_FORMAT_R16G16B16A16_SFLOAT,
    };
}

void free_target(host *h, target *t)
{
    host_image_free(h, &t->color);
    host_image_free(h, &t->depth);
    host_buffer_free(h, &t->color_up);
    host_buffer_free(h, &t->depth_up);
    host_buffer_free(h, &t->color_down);
    host_buffer_free(h, &t->depth_down);
}

void paint_backdrop(target *t, float far)
{
    const uint32_t width = t->color.extent.width, height = t->color.extent.height;
    for (uint32_t x = 0; x < width; x += 8) {
        const float shade = x / 8 % 2 ? 0.75f : 0.25f;
        const host_card stripe = {x, 0, 8, height, {shade, 1 - shade, 0.5f, 0.625f}, far};
        host_paint(&t->color_up, &t->depth_up, width, height, &stripe, 1);
    }
}

void pack(target *t)
{
    if (t->half) {
        const size_t values = (size_t)t->color.extent.width * t->color.extent.height * 4;
        const float *from = t->color_up.data;
        uint16_t *to = t->color_up.data;
        for (size_t i = 0; i < values; i++) { // in place: `to` never overtakes `from`
            to[i] = tyn_half_from_float(from[i]);
        }
    }
}

float color_at(const target *t, uint32_t x, uint32_t y, int channel)
{
    const size_t i = ((size_t)y * t->color.extent.width + x) * 4 + (size_t)channel;
    return t->half ? tyn_half_to_float(((const uint16_t *)t->color_down.data)[i])
                   : ((const float *)t->color_down.data)[i];
}

void begin_frame(fixture *f, VkCommandBuffer cmd, target *t, const frame_states *s)
{
    t->color.state = t->depth.state = nothing_yet;
    host_transition(&f->host, cmd, &t->color, copy_target);
    host_transition(&f->host, cmd, &t->depth, copy_target);
    host_upload(&f->host, cmd, &t->color_up, &t->color);
    host_upload(&f->host, cmd, &t->depth_up, &t->depth);
    host_transition(&f->host, cmd, &t->color, s->color_before);
    host_transition(&f->host, cmd, &t->depth, s->depth_before);
}

void end_frame(fixture *f, VkCommandBuffer cmd, target *t)
{
    host_transition(&f->host, cmd, &t->color, copy_source);
    host_transition(&f->host, cmd, &t->depth, copy_source);
    host_download(&f->host, cmd, &t->color, &t->color_down);
    host_download(&f->host, cmd, &t->depth, &t->depth_down);
}

tyn_result prepare_frame(tyn_context *ctx, const tyn_scene *scene, const tyn_view *view, target *t,
                         const frame_states *s, const float *m, const tyn_image *density)
{
    // Lend copies: prepare looks at formats and sizes only.
    host_image color = t->color, depth = t->depth;
    const tyn_image lent_color = host_lend(&color, s->color_after);
    const tyn_image lent_depth = host_lend(&depth, s->depth_after);
    tyn_frame frame = {.struct_size = sizeof(frame),
                       .scene = scene,
                       .view = view,
                       .densities = density,
                       .color = &lent_color,
                       .depth = s->no_depth ? NULL : &lent_depth};
    memcpy(frame.view_to_clip, m, sizeof(frame.view_to_clip));
    return tyn_context_prepare(ctx, &frame);
}

tyn_result record_frame(tyn_context *ctx, VkCommandBuffer cmd, const tyn_scene *scene,
                        const tyn_view *view, target *t, const frame_states *s, const float *m,
                        const tyn_image *density)
{
    host_image color = t->color, depth = t->depth;
    const tyn_image lent_color = host_lend(&color, s->color_after);
    const tyn_image lent_depth = host_lend(&depth, s->depth_after);
    tyn_frame frame = {.struct_size = sizeof(frame),
                       .cmd = cmd,
                       .scene = scene,
                       .view = view,
                       .densities = density,
                       .color = &lent_color,
                       .depth = s->no_depth ? NULL : &lent_depth};
    memcpy(frame.view_to_clip, m, sizeof(frame.view_to_clip));
    const tyn_result result = tyn_context_record(ctx, &frame);
    if (result == TYN_OK) { // a failing record leaves them as they were
        t->color.state = color.state;
        t->depth.state = s->no_depth ? t->depth.state : depth.state;
    }
    return result;
}

// ---- the reference ----------------------------------------------------------------------------

picture reference(fixture *f, const char *method, const tyn_scene *scene, tyn_view view)
{
    tyn_offline *off = NULL;
    assert_int_equal(
        tyn_offline_create(f->own, tyn_offline_params(.method = method, .settings = f->settings),
                           &off),
        TYN_OK);
    view.outputs = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE;
    offline_frame(off, scene, &view);
    const size_t size = (size_t)view.width * view.height * 4 * sizeof(float);
    picture p = {malloc(size), malloc(size)};
    memcpy(p.radiance, tyn_offline_output(off, TYN_OUTPUT_RADIANCE), size);
    memcpy(p.transmittance, tyn_offline_output(off, TYN_OUTPUT_TRANSMITTANCE), size);
    tyn_offline_destroy(&off);
    return p;
}

void free_picture(picture *p)
{
    free(p->radiance);
    free(p->transmittance);
}

static float painted(uint32_t x, int channel)
{
    const float shade = x / 8 % 2 ? 0.75f : 0.25f;
    const float color[4] = {shade, 1 - shade, 0.5f, 0.625f};
    return color[channel];
}

void check_composite(const target *t, const picture *p)
{
    const uint32_t width = t->color.extent.width, height = t->color.extent.height;
    const float tolerance = t->half ? 2e-3f : 2e-5f; // of a half float; of another order of sums
    float brightest = 0;
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            for (int c = 0; c < 3; c++) {
                const size_t i = ((size_t)y * width + x) * 4 + (size_t)c;
                const float right = painted(x, c) * p->transmittance[i] + p->radiance[i];
                const float found = color_at(t, x, y, c);
                brightest = maximum(brightest, p->radiance[i]);
                if (!(fabsf(found - right) <= tolerance * (1 + right))) {
                    fail_msg("pixel (%u, %u) channel %d is %g, not %g", x, y, c, (double)found,
                             (double)right);
                }
            }
            assert_true(color_at(t, x, y, 3) == painted(x, 3));
        }
    }
    assert_true(brightest > 0.05f); // there is smoke in the picture
    assert_memory_equal(t->depth_down.data, t->depth_up.data, t->depth_up.size);
}

void expect_silence(const fixture *f)
{
    assert_int_equal(f->host.messages, 0);
    assert_int_equal(f->errors, 0);
}

frame_states usual_states(void)
{
    return (frame_states){"attachments",
                          drawn_to,
                          drawn_to,
                          depth_tested,
                          depth_tested,
                          false,
                          VK_FORMAT_R32G32B32A32_SFLOAT};
}

target painted_target(fixture *f, float depth)
{
    const frame_states s = usual_states();
    target t = new_target(&f->host, WIDTH, HEIGHT, s.color_format);
    paint_backdrop(&t, depth);
    t.color.state = s.color_before;
    t.depth.state = s.depth_before;
    return t;
}

void run_frame(fixture *f, tyn_context *ctx, const tyn_scene *scene, const tyn_view *view,
               target *t, const float m[16])
{
    const frame_states s = usual_states();
    assert_int_equal(prepare_frame(ctx, scene, view, t, &s, m, NULL), TYN_OK);
    const VkCommandBuffer cmd = host_begin(&f->host, 0);
    begin_frame(f, cmd, t, &s);
    assert_int_equal(record_frame(ctx, cmd, scene, view, t, &s, m, NULL), TYN_OK);
    end_frame(f, cmd, t);
    host_submit(&f->host, 0);
    host_wait(&f->host, 0);
}
