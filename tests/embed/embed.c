// embed.c -- Tyndall as a guest: a host with its own Vulkan device records frames into its own command
// buffers, over images in layouts of its choice, and finds them as promised.
//
// The host sees public headers only and enables the required features and no other. Validation and
// synchronization validation are on from its instance to its end; one message fails the test. A wrong
// layout, a missing barrier, or a barrier before the wrong stage shows there, because the host goes on
// from the state that was promised to it.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <tyndall/context.h>
#include <tyndall/offline.h>
#include <tyndall/extend/method.h>

#include "base/half.h"
#include "host.h"
#include "numbers.h"
#include "offline_frame.h"
#include "skip.h"
#include "states.h"

enum { WIDTH = 80, HEIGHT = 56, VOXELS = 24 };

// ---- the fixture ------------------------------------------------------------------------------

typedef struct fixture {
    host host;
    tyn_device *guest;
    tyn_device *own; // of the offline reference
    tyn_settings *settings;
    uint32_t errors; // lines of level error in the log
    bool quiet;      // they are expected
} fixture;

static void on_log(void *user, tyn_log_level level, const char *message)
{
    fixture *f = user;
    f->errors += level == TYN_LOG_ERROR;
    if (!f->quiet || level != TYN_LOG_ERROR) {
        fprintf(stderr, "tyndall: %s\n", message);
    }
}

static tyn_log log_of(fixture *f)
{
    return (tyn_log){on_log, f, TYN_LOG_WARN};
}

static tyn_device *new_guest(fixture *f)
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

static int set_up(void **state)
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

static int tear_down(void **state)
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

static tyn_context *new_context(fixture *f, tyn_device *dev, const char *method)
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

// A box of 2 m about the origin with a soft ball of smoke in it, and a sun.
static void make_smoke(tyn_scene *scene)
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

// The same box, filled evenly with something that only absorbs: transmittance has a closed form.
static void make_ink(tyn_scene *scene)
{
    make_smoke(scene);
    scene->media[0] = (tyn_medium){.sigma_a = {0.5f, 1, 2}, .density_scale = 1, .volume = -1};
    free(scene->volumes[0].name);
    free(scene->volumes[0].data);
    free(scene->volumes);
    scene->volumes = NULL;
    scene->num_volumes = 0;
}

// A view of `width` x `height` pixels along -z from (x, 0, 5).
static tyn_view make_view(float x, uint32_t width, uint32_t height, uint32_t outputs)
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

// How the host made its depth: Vulkan clip space, y down.
static const float near_plane = 0.5f, far_plane = 50;

static void projection(const tyn_view *view, bool reverse_z, float m[16])
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

// The depth-buffer value of a plane at `distance` in front of the camera.
static float depth_of(const float m[16], float distance)
{
    return (-distance * m[10] + m[14]) / (-distance * m[11] + m[15]);
}

// ---- a frame of the host ----------------------------------------------------------------------

typedef struct target {
    host_image color, depth;
    host_buffer color_up, depth_up, color_down, depth_down;
    bool half;
} target;

static target new_target(host *h, uint32_t width, uint32_t height, VkFormat color_format)
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

static void free_target(host *h, target *t)
{
    host_image_free(h, &t->color);
    host_image_free(h, &t->depth);
    host_buffer_free(h, &t->color_up);
    host_buffer_free(h, &t->depth_up);
    host_buffer_free(h, &t->color_down);
    host_buffer_free(h, &t->depth_down);
}

// A backdrop of stripes at the value `far` of the depth buffer.
static void paint_backdrop(target *t, float far)
{
    const uint32_t width = t->color.extent.width, height = t->color.extent.height;
    for (uint32_t x = 0; x < width; x += 8) {
        const float shade = x / 8 % 2 ? 0.75f : 0.25f;
        const host_card stripe = {x, 0, 8, height, {shade, 1 - shade, 0.5f, 0.625f}, far};
        host_paint(&t->color_up, &t->depth_up, width, height, &stripe, 1);
    }
}

// What was painted as floats, if the image holds halves.
static void pack(target *t)
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

static float color_at(const target *t, uint32_t x, uint32_t y, int channel)
{
    const size_t i = ((size_t)y * t->color.extent.width + x) * 4 + (size_t)channel;
    return t->half ? tyn_half_to_float(((const uint16_t *)t->color_down.data)[i])
                   : ((const float *)t->color_down.data)[i];
}

typedef struct frame_states {
    const char *name;
    tyn_sync color_before, color_after, depth_before, depth_after;
    bool no_depth;
    VkFormat color_format;
} frame_states;

static void begin_frame(fixture *f, VkCommandBuffer cmd, target *t, const frame_states *s)
{
    t->color.state = t->depth.state = nothing_yet;
    host_transition(&f->host, cmd, &t->color, copy_target);
    host_transition(&f->host, cmd, &t->depth, copy_target);
    host_upload(&f->host, cmd, &t->color_up, &t->color);
    host_upload(&f->host, cmd, &t->depth_up, &t->depth);
    host_transition(&f->host, cmd, &t->color, s->color_before);
    host_transition(&f->host, cmd, &t->depth, s->depth_before);
}

// The host goes on from where it was promised to find its images: it reads them.
static void end_frame(fixture *f, VkCommandBuffer cmd, target *t)
{
    host_transition(&f->host, cmd, &t->color, copy_source);
    host_transition(&f->host, cmd, &t->depth, copy_source);
    host_download(&f->host, cmd, &t->color, &t->color_down);
    host_download(&f->host, cmd, &t->depth, &t->depth_down);
}

static tyn_result prepare_frame(tyn_context *ctx, const tyn_scene *scene, const tyn_view *view,
                                target *t, const frame_states *s, const float *m,
                                const tyn_image *density)
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

static tyn_result record_frame(tyn_context *ctx, VkCommandBuffer cmd, const tyn_scene *scene,
                               const tyn_view *view, target *t, const frame_states *s,
                               const float *m, const tyn_image *density)
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

typedef struct picture {
    float *radiance, *transmittance; // four floats a pixel
} picture;

// The same view, offline, on a device of Tyndall's own.
static picture reference(fixture *f, const char *method, const tyn_scene *scene, tyn_view view)
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

static void free_picture(picture *p)
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

// Backdrop x transmittance + radiance everywhere, the host's alpha and depth as they were.
static void check_composite(const target *t, const picture *p)
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

static void expect_silence(const fixture *f)
{
    assert_int_equal(f->host.messages, 0);
    assert_int_equal(f->errors, 0);
}

// ---- tests ------------------------------------------------------------------------------------

static frame_states usual_states(void)
{
    return (frame_states){"attachments",
                          drawn_to,
                          drawn_to,
                          depth_tested,
                          depth_tested,
                          false,
                          VK_FORMAT_R32G32B32A32_SFLOAT};
}

// The usual images, with the backdrop at this depth, as the host has them before a frame.
static target painted_target(fixture *f, float depth)
{
    const frame_states s = usual_states();
    target t = new_target(&f->host, WIDTH, HEIGHT, s.color_format);
    paint_backdrop(&t, depth);
    t.color.state = s.color_before;
    t.depth.state = s.depth_before;
    return t;
}

// Prepares and records a frame over usual images, and waits for it.
static void run_frame(fixture *f, tyn_context *ctx, const tyn_scene *scene, const tyn_view *view,
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

static void images_in_any_layout(void **state)
{
    fixture *f = *state;
    const frame_states all[] = {
        {"attachment and read-only depth", drawn_to, drawn_to, depth_tested, depth_tested, false,
         VK_FORMAT_R32G32B32A32_SFLOAT},
        {"half floats", drawn_to, sampled, depth_tested, depth_tested, false,
         VK_FORMAT_R16G16B16A16_SFLOAT},
        {"general, then copied from", general, copy_source, depth_drawn, sampled, false,
         VK_FORMAT_R32G32B32A32_SFLOAT},
        {"copied from, then sampled", copy_source, sampled, general, general, false,
         VK_FORMAT_R32G32B32A32_SFLOAT},
        {"sampled, no depth", sampled, general, depth_drawn, depth_drawn, true,
         VK_FORMAT_R32G32B32A32_SFLOAT},
    };
    tyn_scene scene;
    make_smoke(&scene);
    const tyn_view view = make_view(0.2f, WIDTH, HEIGHT, TYN_OUTPUT_COMPOSITE);
    picture p = reference(f, "pop", &scene, view);
    float m[16];
    projection(&view, true, m);

    for (size_t i = 0; i < sizeof(all) / sizeof(all[0]); i++) {
        const frame_states *s = &all[i];
        print_message("  %s\n", s->name);
        tyn_context *ctx = new_context(f, f->guest, NULL);
        target t = new_target(&f->host, WIDTH, HEIGHT, s->color_format);
        paint_backdrop(&t, 0.0f);
        pack(&t);
        t.color.state = s->color_before;
        t.depth.state = s->depth_before;
        assert_int_equal(prepare_frame(ctx, &scene, &view, &t, s, m, NULL), TYN_OK);
        for (uint32_t repeat = 0; repeat < 3; repeat++) { // 2 and 3: nothing has changed
            const VkCommandBuffer cmd = host_begin(&f->host, repeat % HOST_SLOTS);
            begin_frame(f, cmd, &t, s);
            assert_int_equal(record_frame(ctx, cmd, &scene, &view, &t, s, m, NULL), TYN_OK);
            assert_int_equal(t.color.state.layout, s->color_after.layout);
            end_frame(f, cmd, &t);
            host_submit(&f->host, repeat % HOST_SLOTS);
            host_wait(&f->host, repeat % HOST_SLOTS);
            check_composite(&t, &p);
        }
        tyn_context_destroy(&ctx);
        free_target(&f->host, &t);
        expect_silence(f);
    }
    free_picture(&p);
    tyn_scene_finish(&scene);
}

// A card in front of an absorbing box, one inside it, one behind it: Beer and Lambert's law up to each.
static void surfaces_stop_the_light(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_ink(&scene);
    const tyn_view view = make_view(0, WIDTH, HEIGHT, TYN_OUTPUT_COMPOSITE);
    for (int reverse = 0; reverse < 2; reverse++) {
        float m[16];
        projection(&view, reverse, m);
        const float planes[3] = {3.5f, 5.25f, 8}; // the box is from 4 to 6
        const host_card cards[3] = {
            {26, 22, 10, 12, {0.5f, 0.5f, 0.5f, 1}, depth_of(m, planes[0])},
            {36, 22, 10, 12, {0.5f, 0.5f, 0.5f, 1}, depth_of(m, planes[1])},
            {46, 22, 10, 12, {0.5f, 0.5f, 0.5f, 1}, depth_of(m, planes[2])},
        };
        tyn_context *ctx = new_context(f, f->guest, "single");
        target t = painted_target(f, reverse ? 0.0f : 1.0f);
        host_paint(&t.color_up, &t.depth_up, WIDTH, HEIGHT, cards, 3);
        run_frame(f, ctx, &scene, &view, &t, m);

        for (int i = 0; i < 3; i++) {
            for (uint32_t y = cards[i].y + 1; y < cards[i].y + 11; y++) {
                for (uint32_t x = cards[i].x + 1; x < cards[i].x + 9; x++) {
                    // The ray through the middle of the pixel, z = -1 at unit distance.
                    const float tangent = tanf(0.5f * view.camera.yfov) / (0.5f * HEIGHT);
                    const float rx = ((float)x + 0.5f - 0.5f * WIDTH) * tangent;
                    const float ry = ((float)y + 0.5f - 0.5f * HEIGHT) * tangent;
                    const float inside = fminf(planes[i], 6) - fminf(planes[i], 4);
                    const float length = inside * sqrtf(1 + rx * rx + ry * ry);
                    for (int c = 0; c < 3; c++) {
                        const float right = 0.5f * expf(-scene.media[0].sigma_a[c] * length);
                        const float found = color_at(&t, x, y, c);
                        // Within 0.2 %: rays are jittered inside their pixel.
                        if (!(fabsf(found - right) <= 2e-3f * right)) {
                            fail_msg("card %d, pixel (%u, %u), channel %d: %g, not %g", i, x, y, c,
                                     (double)found, (double)right);
                        }
                    }
                }
            }
        }
        tyn_context_destroy(&ctx);
        free_target(&f->host, &t);
    }
    expect_silence(f);
    tyn_scene_finish(&scene);
}

// Two contexts on one device and one in between of another device object, frames in flight, a camera
// that moves, a resize in the middle, and everything destroyed in the order in which it was made.
static void contexts_share_a_device(void **state)
{
    fixture *f = *state;
    tyn_scene smoke, ink;
    make_smoke(&smoke);
    make_ink(&ink);
    ink.media[0].sigma_s[0] = ink.media[0].sigma_s[1] = ink.media[0].sigma_s[2] = 1;
    const frame_states s = usual_states();
    tyn_device *other = new_guest(f);
    tyn_context *first = new_context(f, f->guest, "pop");
    tyn_context *second = new_context(f, other, "single");

    tyn_view view;
    target targets[HOST_SLOTS][2];
    for (int round = 0; round < 2; round++) {
        const uint32_t width = round ? 48 : WIDTH, height = round ? 64 : HEIGHT;
        for (uint32_t slot = 0; slot < HOST_SLOTS; slot++) {
            for (int k = 0; k < 2; k++) {
                target *t = &targets[slot][k];
                *t = new_target(&f->host, width, height, s.color_format);
                paint_backdrop(t, 0.0f);
                t->color.state = s.color_before;
                t->depth.state = s.depth_before;
            }
        }
        view = make_view(0, width, height, TYN_OUTPUT_COMPOSITE);
        float m[16];
        projection(&view, true, m);
        assert_int_equal(prepare_frame(first, &smoke, &view, &targets[0][0], &s, m, NULL), TYN_OK);
        assert_int_equal(prepare_frame(second, &ink, &view, &targets[0][1], &s, m, NULL), TYN_OK);
        enum { FRAMES = 7 };
        for (uint32_t frame = 0; frame < FRAMES; frame++) {
            const uint32_t slot = frame % HOST_SLOTS;
            target *a = &targets[slot][0], *b = &targets[slot][1];
            view = make_view(0.1f * (float)(frame / 2), width, height, TYN_OUTPUT_COMPOSITE);
            const VkCommandBuffer cmd = host_begin(&f->host, slot);
            begin_frame(f, cmd, a, &s);
            begin_frame(f, cmd, b, &s);
            assert_int_equal(record_frame(first, cmd, &smoke, &view, a, &s, m, NULL), TYN_OK);
            assert_int_equal(record_frame(second, cmd, &ink, &view, b, &s, m, NULL), TYN_OK);
            end_frame(f, cmd, a);
            end_frame(f, cmd, b);
            host_submit(&f->host, slot);
        }
        for (uint32_t slot = 0; slot < HOST_SLOTS; slot++) {
            host_wait(&f->host, slot);
        }
        // The last frames of both slots.
        for (uint32_t frame = FRAMES - HOST_SLOTS; frame < FRAMES; frame++) {
            view = make_view(0.1f * (float)(frame / 2), width, height, TYN_OUTPUT_COMPOSITE);
            picture p = reference(f, "pop", &smoke, view), q = reference(f, "single", &ink, view);
            check_composite(&targets[frame % HOST_SLOTS][0], &p);
            check_composite(&targets[frame % HOST_SLOTS][1], &q);
            free_picture(&p);
            free_picture(&q);
        }
        for (uint32_t slot = 0; slot < HOST_SLOTS; slot++) {
            free_target(&f->host, &targets[slot][0]);
            free_target(&f->host, &targets[slot][1]);
        }
    }
    tyn_context_destroy(&first);
    tyn_context *third = new_context(f, other, "pop"); // never used
    tyn_context_destroy(&second);
    tyn_context_destroy(&third);
    tyn_context_destroy(&third); // of NULL: nothing happens
    tyn_device_destroy(&other);
    expect_silence(f);
    tyn_scene_finish(&smoke);
    tyn_scene_finish(&ink);
}

// Settings that change between frames give the pictures of contexts that were made with them.
static void settings_change(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_smoke(&scene);
    const tyn_view view = make_view(0.2f, WIDTH, HEIGHT, TYN_OUTPUT_COMPOSITE);
    float m[16];
    projection(&view, true, m);
    tyn_context *ctx = new_context(f, f->guest, "pop");
    target t = painted_target(f, 0.0f);
    // The last two are what it began with, which other tests want.
    static const char *const changes[][2] = {{"lattice.cells", "9"},
                                             {"raymarch.step", "0.75"},
                                             {"raymarch.step", "1"},
                                             {"lattice.cells", "12"}};
    for (size_t k = 0; k < sizeof changes / sizeof changes[0]; k++) {
        double value;
        const tyn_log log = log_of(f);
        assert_int_equal(tyn_context_set(ctx, changes[k][0], changes[k][1]), TYN_OK);
        assert_int_equal(tyn_context_get(ctx, changes[k][0], &value), TYN_OK);
        assert_true(value == strtod(changes[k][1], NULL));
        assert_int_equal(tyn_settings_set(f->settings, changes[k][0], changes[k][1], &log), TYN_OK);
        picture p = reference(f, "pop", &scene, view);
        run_frame(f, ctx, &scene, &view, &t, m);
        check_composite(&t, &p);
        free_picture(&p);
    }
    tyn_context_destroy(&ctx);
    free_target(&f->host, &t);
    expect_silence(f);
    tyn_scene_finish(&scene);
}

static bool hook_is_on;

static uint32_t hook_reads(const tyn_job *job)
{
    (void)job;
    return hook_is_on ? TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE : 0;
}

static void hook_declare(tyn_graph *g, const tyn_job *job, tyn_picture *made)
{
    (void)g;
    (void)job;
    made->radiance = made->transmittance;
}

// What a hook hands on is laid over the host's picture.
static void hooks_come_before_the_composite(void **state)
{
    static const tyn_picture_hook hook = {"embed", hook_reads, hook_declare};
    fixture *f = *state;
    tyn_scene scene;
    make_smoke(&scene);
    const tyn_view view = make_view(0.2f, WIDTH, HEIGHT, TYN_OUTPUT_COMPOSITE);
    float m[16];
    projection(&view, true, m);
    tyn_context *ctx = new_context(f, f->guest, "pop");
    target t = painted_target(f, 0.0f);
    picture p = reference(f, "pop", &scene, view);
    assert_int_equal(tyn_picture_hook_register(&hook, NULL), TYN_OK);
    for (int on = 0; on < 2; on++) {
        hook_is_on = on;
        if (on) {
            memcpy(p.radiance, p.transmittance, sizeof(float[4]) * WIDTH * HEIGHT);
        }
        run_frame(f, ctx, &scene, &view, &t, m);
        check_composite(&t, &p);
    }
    hook_is_on = false;
    free_picture(&p);
    tyn_context_destroy(&ctx);
    free_target(&f->host, &t);
    expect_silence(f);
    tyn_scene_finish(&scene);
}

// The density is an image of the host's, in a layout of its choice, and changes without notice.
static void density_of_the_host(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_smoke(&scene);
    const tyn_view view = make_view(0.2f, WIDTH, HEIGHT, TYN_OUTPUT_COMPOSITE);
    picture p = reference(f, "pop", &scene, view);

    host *h = &f->host;
    host_image density =
        host_image_new(h, VK_FORMAT_R16_SFLOAT, (VkExtent3D){VOXELS, VOXELS, VOXELS},
                       VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                           VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    const size_t voxels = (size_t)VOXELS * VOXELS * VOXELS;
    host_buffer up = host_buffer_new(h, voxels * 2);
    for (size_t i = 0; i < voxels; i++) {
        ((uint16_t *)up.data)[i] = tyn_half_from_float(scene.volumes[0].data[i]);
    }
    free(scene.volumes[0].data);
    scene.volumes[0].data = NULL;

    float m[16];
    projection(&view, true, m);
    const frame_states s = usual_states();
    tyn_context *ctx = new_context(f, f->guest, "pop");
    target t = painted_target(f, 0.0f);
    density.state = general;
    tyn_image lent = host_lend(&density, general);
    assert_int_equal(prepare_frame(ctx, &scene, &view, &t, &s, m, &lent), TYN_OK);
    for (uint32_t frame = 0; frame < 3; frame++) {
        const uint32_t slot = frame % HOST_SLOTS;
        const VkCommandBuffer cmd = host_begin(h, slot);
        density.state = frame ? density.state : nothing_yet;
        host_transition(h, cmd, &density, copy_target);
        host_upload(h, cmd, &up, &density);
        host_transition(h, cmd, &density, frame % 2 ? sampled : general);
        begin_frame(f, cmd, &t, &s);
        lent = host_lend(&density, frame % 2 ? general : sampled);
        assert_int_equal(record_frame(ctx, cmd, &scene, &view, &t, &s, m, &lent), TYN_OK);
        end_frame(f, cmd, &t);
        host_submit(h, slot);
        host_wait(h, slot); // the upload buffer and the target are used by every frame
        check_composite(&t, &p);
    }
    tyn_context_destroy(&ctx);
    free_target(h, &t);
    host_image_free(h, &density);
    host_buffer_free(h, &up);
    free_picture(&p);
    expect_silence(f);
    tyn_scene_finish(&scene);
}

// A record that cannot be done says so, appends nothing and leaves the images as they were.
static void failing_record_changes_nothing(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_smoke(&scene);
    const tyn_view view = make_view(0.2f, WIDTH, HEIGHT, TYN_OUTPUT_COMPOSITE);
    picture p = reference(f, "pop", &scene, view);
    float m[16];
    projection(&view, true, m);
    const frame_states s = usual_states();
    tyn_context *ctx = new_context(f, f->guest, "pop");
    target t = painted_target(f, 0.0f);
    target small = new_target(&f->host, WIDTH / 2, HEIGHT, s.color_format);

    f->quiet = true;
    VkCommandBuffer cmd = host_begin(&f->host, 0);
    begin_frame(f, cmd, &t, &s);
    // Never prepared.
    assert_int_not_equal(record_frame(ctx, cmd, &scene, &view, &t, &s, m, NULL), TYN_OK);
    assert_int_equal(prepare_frame(ctx, &scene, &view, &t, &s, m, NULL), TYN_OK);
    // Another size than was prepared.
    const tyn_view larger = make_view(0.2f, WIDTH * 2, HEIGHT, TYN_OUTPUT_COMPOSITE);
    assert_int_not_equal(record_frame(ctx, cmd, &scene, &larger, &t, &s, m, NULL), TYN_OK);
    // Other outputs than were prepared.
    const tyn_view other = make_view(0.2f, WIDTH, HEIGHT, TYN_OUTPUT_DEPTH | TYN_OUTPUT_COMPOSITE);
    assert_int_not_equal(record_frame(ctx, cmd, &scene, &other, &t, &s, m, NULL), TYN_OK);
    // An image of another size.
    small.color.state = s.color_before;
    small.depth.state = s.depth_before;
    assert_int_not_equal(record_frame(ctx, cmd, &scene, &view, &small, &s, m, NULL), TYN_OK);
    // A number that is none.
    tyn_scene broken = scene;
    broken.media[0].sigma_s[1] = NAN;
    assert_int_not_equal(record_frame(ctx, cmd, &broken, &view, &t, &s, m, NULL), TYN_OK);
    // A frame without what it requires.
    assert_int_not_equal(tyn_context_record(ctx, NULL), TYN_OK);
    assert_int_not_equal(tyn_context_record(ctx, tyn_frame(.cmd = cmd)), TYN_OK);
    assert_true(f->errors >= 5);
    f->quiet = false;
    f->errors = 0;

    // The command buffer is good, the images are as they were handed over.
    end_frame(f, cmd, &t);
    host_submit(&f->host, 0);
    host_wait(&f->host, 0);
    assert_memory_equal(t.color_down.data, t.color_up.data, t.color_up.size);
    assert_memory_equal(t.depth_down.data, t.depth_up.data, t.depth_up.size);

    // And the context still works.
    cmd = host_begin(&f->host, 1);
    begin_frame(f, cmd, &t, &s);
    assert_int_equal(record_frame(ctx, cmd, &scene, &view, &t, &s, m, NULL), TYN_OK);
    end_frame(f, cmd, &t);
    host_submit(&f->host, 1);
    host_wait(&f->host, 1);
    check_composite(&t, &p);

    tyn_context_destroy(&ctx);
    free_target(&f->host, &t);
    free_target(&f->host, &small);
    free_picture(&p);
    expect_silence(f);
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_in_any_layout),
        cmocka_unit_test(surfaces_stop_the_light),
        cmocka_unit_test(contexts_share_a_device),
        cmocka_unit_test(density_of_the_host),
        cmocka_unit_test(settings_change),
        cmocka_unit_test(failing_record_changes_nothing),
        cmocka_unit_test(hooks_come_before_the_composite),
    };
    return cmocka_run_group_tests_name("embed", tests, set_up, tear_down);
}
