// outputs.c -- what a host can say of its view, and what it can take away: matrices in place of a camera, and results in
// images of its own.
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

#include "base/half.h"
#include "bound.h"
#include "host.h"
#include "numbers.h"
#include "skip.h"
#include "states.h"

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT };

typedef struct fixture {
    host host;
    tyn_device *dev;
    tyn_settings *settings;
    int lines; // of level error
} fixture;

static void on_log(void *user, tyn_log_level level, const char *message)
{
    fixture *f = user;
    f->lines += level == TYN_LOG_ERROR;
    print_message("  %s\n", message);
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof(*f));
    *state = f;
    if (host_open(&f->host, true) != HOST_OK) {
        skip_all("the host has no device");
    }
    tyn_device_params params = {.struct_size = sizeof(params), .log = {on_log, f, TYN_LOG_WARN}};
    host_describe(&f->host, &params);
    assert_int_equal(tyn_device_create(&params, &f->dev), TYN_OK);
    assert_int_equal(tyn_settings_create(&f->settings), TYN_OK);
    assert_int_equal(tyn_settings_set(f->settings, "lattice.cells", "12", &params.log), TYN_OK);
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    tyn_settings_destroy(&f->settings);
    tyn_device_destroy(&f->dev);
    host_close(&f->host);
    const uint32_t messages = f->host.messages;
    free(f);
    assert_int_equal(messages, 0);
    return bounds_near(true) ? 0 : 1;
}

static tyn_context *new_context(fixture *f, const char *method)
{
    tyn_context *ctx = NULL;
    assert_int_equal(
        tyn_context_create(f->dev,
                           tyn_context_params(.method = method, .settings = f->settings,
                                              .frames_in_flight = HOST_SLOTS, .readback = true),
                           &ctx),
        TYN_OK);
    f->lines = 0;
    return ctx;
}

// A box of 2 x 2 x 2 m of fog about the origin, turned about y, and a sun.
static void make_scene(tyn_scene *scene)
{
    tyn_scene_init(scene);
    scene->num_media = scene->num_shapes = scene->num_lights = 1;
    scene->media[0] = (tyn_medium){.sigma_s = {1.5f, 1.7f, 2},
                                   .sigma_a = {0.3f, 0.2f, 0.1f},
                                   .phase = {{.g = 0.4f}, {.g = 0.4f}, {.g = 0.4f}},
                                   .density_scale = 1,
                                   .volume = -1};
    scene->shapes[0] =
        (tyn_shape){.kind = TYN_SHAPE_BOX,
                    .to_world = {1.6f, 0, 1.2f, 0, 0, 2, 0, 0, -1.2f, 0, 1.6f, 0, 0.1f, 0, 0, 1}};
    scene->lights[0] = (tyn_light){
        .kind = TYN_LIGHT_DIRECTIONAL, .color = {3, 3, 2.5f}, .direction = {-0.6f, -0.8f, 0}};
}

// ---- the view -----------------------------------------------------------------------------------

static tyn_camera make_camera(bool orthographic)
{
    // From (0.3, 0.5, 5), turned by asin 0.28 about y.
    return (tyn_camera){.projection = orthographic ? TYN_ORTHOGRAPHIC : TYN_PERSPECTIVE,
                        .position = {1.6f, 0.2f, 5},
                        .right = {0.96f, 0, -0.28f},
                        .up = {0, 1, 0},
                        .back = {0.28f, 0, 0.96f},
                        .yfov = 0.6f,
                        .ymag = 1.4f};
}

static tyn_view make_view(uint32_t outputs)
{
    return (tyn_view){.width = WIDTH,
                      .height = HEIGHT,
                      .outputs = outputs,
                      .no_background = true,
                      .camera = make_camera(false)};
}

// The camera's matrices; `unit`: metres in a unit of view space.
static void set_world_to_view(tyn_frame *frame, const tyn_camera *c, float unit)
{
    const float *rows[3] = {c->right, c->up, c->back};
    memset(frame->world_to_view, 0, sizeof frame->world_to_view);
    for (int i = 0; i < 3; i++) {
        float moved = 0;
        for (int k = 0; k < 3; k++) {
            frame->world_to_view[4 * k + i] = rows[i][k] / unit;
            moved += rows[i][k] * c->position[k];
        }
        frame->world_to_view[12 + i] = -moved / unit;
    }
    frame->world_to_view[15] = 1;
}

enum { NEAR_FAR, REVERSED_INFINITE };

static void set_view_to_clip(tyn_frame *frame, const tyn_camera *c, float aspect, int depth)
{
    float *m = frame->view_to_clip;
    memset(m, 0, 16 * sizeof *m);
    if (c->projection == TYN_ORTHOGRAPHIC) {
        m[0] = 1 / (c->ymag * aspect);
        m[5] = -1 / c->ymag;
        m[10] = depth == NEAR_FAR ? -0.1f : 0.1f; // 10 m
        m[14] = depth == NEAR_FAR ? 0 : 1;
        m[15] = 1;
        return;
    }
    const float focal = 1 / tanf(0.5f * c->yfov), nearest = 0.5f, farthest = 50;
    m[0] = focal / aspect;
    m[5] = -focal;
    m[10] = depth == NEAR_FAR ? farthest / (nearest - farthest) : 0;
    m[14] = depth == NEAR_FAR ? nearest * m[10] : nearest;
    m[11] = -1;
}

// Records and runs a frame; its radiance, four floats a pixel, which the caller frees.
static float *radiance_of(fixture *f, tyn_context *ctx, tyn_frame frame)
{
    frame.struct_size = sizeof frame;
    assert_int_equal(tyn_context_prepare(ctx, &frame), TYN_OK);
    frame.cmd = host_begin(&f->host, 0);
    assert_int_equal(tyn_context_record(ctx, &frame), TYN_OK);
    host_submit(&f->host, 0);
    host_wait(&f->host, 0);
    const size_t bytes = (size_t)frame.view->width * frame.view->height * 4 * sizeof(float);
    float *copy = malloc(bytes);
    memcpy(copy, tyn_context_output(ctx, TYN_OUTPUT_RADIANCE), bytes);
    return copy;
}

// Largest difference of columns [first, end) of `a` from those of `b` that lie `aside` columns to the right, of the
// brightest value. Rows of `b` may run up.
static double difference(const float *a, uint32_t a_width, uint32_t first, uint32_t end,
                         const float *b, uint32_t b_width, uint32_t aside, bool upside_down)
{
    double worst = 0, brightest = 0;
    for (uint32_t y = 0; y < HEIGHT; y++) {
        for (uint32_t x = first; x < end; x++) {
            for (uint32_t c = 0; c < 3; c++) {
                const double in_a = (double)a[4 * (y * a_width + x) + c];
                const uint32_t row = upside_down ? HEIGHT - 1 - y : y;
                const double in_b = (double)b[4 * (row * b_width + x + aside) + c];
                brightest = maximum(brightest, in_b);
                worst = maximum(worst, fabs(in_a - in_b));
            }
        }
    }
    assert_true(brightest > 0.01);
    return worst / brightest;
}

static void matrices(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_scene(&scene);
    tyn_context *ctx = new_context(f, "pop");
    // A ray through the middle of every pixel, so that pictures that are upside down are of the same rays.
    assert_int_equal(tyn_context_set(ctx, "raymarch.sparse", "0"), TYN_OK);
    assert_int_equal(tyn_context_set(ctx, "raymarch.antialias", "0"), TYN_OK);
    tyn_view view = make_view(TYN_OUTPUT_RADIANCE), blind = view;
    memset(&blind.camera, 0, sizeof blind.camera); // it is not read
    const float aspect = (float)WIDTH / HEIGHT;
    double as_camera = 0, upside_down = 0;
    for (int parallel = 0; parallel < 2; parallel++) {
        view.camera = make_camera(parallel);
        float *expected = radiance_of(f, ctx, (tyn_frame){.scene = &scene, .view = &view});
        for (int kind = 0; kind < 4; kind++) {
            tyn_frame frame = {.scene = &scene, .view = &blind};
            const float unit = kind == 2 ? 0.01f : 1; // a view space of centimetres
            tyn_camera c = view.camera;
            set_world_to_view(&frame, &c, unit);
            c.ymag /= unit;
            set_view_to_clip(&frame, &c, aspect, kind == 0 ? NEAR_FAR : REVERSED_INFINITE);
            if (kind == 3) { // drawn upside down
                frame.view_to_clip[5] *= -1;
            }
            float *found = radiance_of(f, ctx, frame);
            const double off = difference(found, WIDTH, 0, WIDTH, expected, WIDTH, 0, kind == 3);
            print_message("%s, kind %d: %.2g of the brightest\n",
                          parallel ? "orthographic" : "perspective", kind, off);
            if (kind == 3) {
                upside_down = maximum(upside_down, off);
            } else {
                as_camera = maximum(as_camera, off);
            }
            free(found);
        }
        free(expected);
    }
    assert_true(as_camera <= 2e-5);
    assert_within(upside_down, 1.5e-3, NULL); // the march starts by a pattern of pixels

    // The right half of a picture twice as wide, seen off-axis.
    view.camera = make_camera(false);
    view.width = 2 * WIDTH;
    float *wide = radiance_of(f, ctx, (tyn_frame){.scene = &scene, .view = &view});
    tyn_frame off_axis = {.scene = &scene, .view = &blind};
    set_world_to_view(&off_axis, &view.camera, 1);
    set_view_to_clip(&off_axis, &view.camera, aspect, NEAR_FAR);
    off_axis.view_to_clip[8] = 1; // clip x moves left by w
    float *half = radiance_of(f, ctx, off_axis);
    const double off_axis_error = difference(half, WIDTH, 0, WIDTH, wide, 2 * WIDTH, WIDTH, false);
    print_message("off-axis: %.2g of the brightest\n", off_axis_error);
    assert_true(off_axis_error <= 2e-5);
    free(wide);
    free(half);
    tyn_context_destroy(&ctx);
    tyn_scene_finish(&scene);
    assert_int_equal(f->lines, 0);
}

static void jitter(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_scene(&scene);
    tyn_context *ctx = new_context(f, "pop");
    const tyn_view view = make_view(TYN_OUTPUT_RADIANCE);
    tyn_frame frame = {.scene = &scene, .view = &view};
    float *still = radiance_of(f, ctx, frame);
    frame.jitter[0] = 1;
    float *moved = radiance_of(f, ctx, frame);
    const double by_a_pixel = difference(moved, WIDTH, 0, WIDTH - 1, still, WIDTH, 1, false);
    // With a matrix that holds the same: clip y of the picture's middle moves up by 2 / HEIGHT.
    frame.jitter[0] = 0.25f, frame.jitter[1] = -0.75f;
    float *asked = radiance_of(f, ctx, frame);
    frame.jitter[0] = frame.jitter[1] = 0;
    set_world_to_view(&frame, &view.camera, 1);
    set_view_to_clip(&frame, &view.camera, (float)WIDTH / HEIGHT, NEAR_FAR);
    frame.view_to_clip[8] = 2 * 0.25f / WIDTH;
    frame.view_to_clip[9] = 2 * -0.75f / HEIGHT;
    float *given = radiance_of(f, ctx, frame);
    const double as_matrix = difference(given, WIDTH, 0, WIDTH, asked, WIDTH, 0, false);
    print_message("jitter: %.2g against a shifted picture, %.2g against the matrix\n", by_a_pixel,
                  as_matrix);
    assert_within(by_a_pixel, 2.5e-3, NULL);
    assert_true(as_matrix <= 2e-5);
    free(still);
    free(moved);
    free(asked);
    free(given);
    tyn_context_destroy(&ctx);
    tyn_scene_finish(&scene);
    assert_int_equal(f->lines, 0);
}

// Each is refused with one line.
static bool spoil_view(tyn_frame *frame, int fault)
{
    switch (fault) {
    case 0:
        frame->view_to_clip[5] = NAN;
        break;
    case 1:
        frame->world_to_view[0] = INFINITY;
        break;
    case 2:
        memset(frame->view_to_clip, 0, sizeof frame->view_to_clip);
        break;
    case 3:
        frame->view_to_clip[0] = 0; // the picture is a line
        break;
    case 4:
        memset(frame->world_to_view, 0, 12 * sizeof(float));
        break;
    case 5:
        frame->world_to_view[3] = 1; // stored by rows, or no affine map
        break;
    case 6:
        frame->view_to_clip[4] = 1; // a picture whose sides are not at right angles
        break;
    case 7:
        frame->jitter[1] = NAN;
        break;
    case 8:
        frame->view_to_clip[11] = 0; // w is 0 everywhere
        break;
    default:
        return false;
    }
    return true;
}

static void bad_views(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_scene(&scene);
    tyn_context *ctx = new_context(f, "pop");
    const tyn_view view = make_view(TYN_OUTPUT_RADIANCE);
    for (int fault = 0;; fault++) {
        tyn_frame frame = {.struct_size = sizeof frame, .scene = &scene, .view = &view};
        set_world_to_view(&frame, &view.camera, 1);
        set_view_to_clip(&frame, &view.camera, (float)WIDTH / HEIGHT, NEAR_FAR);
        if (!spoil_view(&frame, fault)) {
            break;
        }
        f->lines = 0;
        assert_int_equal(tyn_context_prepare(ctx, &frame), TYN_ERR_PARAMS);
        assert_int_equal(f->lines, 1);
    }
    tyn_context_destroy(&ctx);
    tyn_scene_finish(&scene);
}

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
    assert_true(light_error(f, "lpv", VK_FORMAT_R32G32B32A32_SFLOAT, false) <= 2e-5);
    const double in_halves = light_error(f, "pop", VK_FORMAT_R16G16B16A16_SFLOAT, false);
    assert_within(in_halves, 3e-3, NULL);
}

// ---- half resolution ----------------------------------------------------------------------------

// Black, with a card in front of a part of the fog: what is laid over it with a view of half the size, against one of the
// whole size.
static float *composite(fixture *f, tyn_context *ctx, const tyn_scene *scene, uint32_t divisor)
{
    const VkExtent3D size = {WIDTH, HEIGHT, 1};
    tyn_view view = make_view(TYN_OUTPUT_COMPOSITE);
    view.width /= divisor, view.height /= divisor;
    tyn_frame frame = {.struct_size = sizeof frame, .scene = scene, .view = &view};
    set_view_to_clip(&frame, &view.camera, (float)WIDTH / HEIGHT, REVERSED_INFINITE);
    host_image color = host_image_new(&f->host, VK_FORMAT_R32G32B32A32_SFLOAT, size,
                                      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                          VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    host_image depth = host_image_new(&f->host, VK_FORMAT_D32_SFLOAT, size,
                                      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    host_buffer up = host_buffer_new(&f->host, PIXELS * 16),
                deep = host_buffer_new(&f->host, PIXELS * 4),
                down = host_buffer_new(&f->host, PIXELS * 16);
    const host_card cards[2] = {{0, 0, WIDTH, HEIGHT, {0, 0, 0, 1}, 0},
                                {21, 13, 19, 23, {0, 0, 0, 1}, 0.5f / 4.6f}};
    host_paint(&up, &deep, WIDTH, HEIGHT, cards, 2);
    frame.cmd = host_begin(&f->host, 0);
    color.state = depth.state = nothing_yet;
    host_transition(&f->host, frame.cmd, &color, copy_target);
    host_transition(&f->host, frame.cmd, &depth, copy_target);
    host_upload(&f->host, frame.cmd, &up, &color);
    host_upload(&f->host, frame.cmd, &deep, &depth);
    const tyn_image lent_color = host_lend(&color, copy_source),
                    lent_depth = host_lend(&depth, sampled);
    frame.color = &lent_color, frame.depth = &lent_depth;
    assert_int_equal(tyn_context_prepare(ctx, &frame), TYN_OK);
    assert_int_equal(tyn_context_record(ctx, &frame), TYN_OK);
    host_download(&f->host, frame.cmd, &color, &down);
    host_submit(&f->host, 0);
    host_wait(&f->host, 0);
    float *copy = malloc(PIXELS * 16);
    memcpy(copy, down.data, PIXELS * 16);
    host_image_free(&f->host, &color);
    host_image_free(&f->host, &depth);
    host_buffer_free(&f->host, &up);
    host_buffer_free(&f->host, &deep);
    host_buffer_free(&f->host, &down);
    return copy;
}

static void half_resolution(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_scene(&scene);
    tyn_context *ctx = new_context(f, "pop");
    float *whole = composite(f, ctx, &scene, 1), *half = composite(f, ctx, &scene, 2);
    double sum = 0, edges = 0, mean = 0;
    uint32_t pixels = 0, near_edge = 0;
    for (uint32_t y = 8; y < HEIGHT - 8; y++) { // within the fog
        for (uint32_t x = 16; x < WIDTH - 16; x++) {
            const size_t i = 4 * ((size_t)y * WIDTH + x);
            const double off = fabs((double)half[i] - (double)whole[i]);
            const bool beside = (x >= 20 && x <= 21) || (x >= 39 && x <= 40);
            if (beside && y > 14 && y < 34) {
                edges += off;
                near_edge++;
            }
            sum += off;
            mean += (double)whole[i];
            pixels++;
        }
    }
    mean /= pixels;
    const double all = sum / pixels / mean, at_edges = edges / near_edge / mean;
    print_message("half resolution: %.2g of the mean off, %.2g at edges of depth\n", all, at_edges);
    assert_true(mean > 0.01);
    assert_within(all, 5e-2, NULL); // most of it at the outline of the fog
    assert_within(at_edges, 6e-2, NULL);
    free(whole);
    free(half);
    tyn_context_destroy(&ctx);
    tyn_scene_finish(&scene);
    assert_int_equal(f->lines, 0);
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
    ctx = new_context(f, "pop-paper");
    const tyn_view view = make_view(TYN_OUTPUT_LIGHT);
    const tyn_frame frame = {.struct_size = sizeof frame, .scene = &scene, .view = &view};
    assert_int_equal(tyn_context_prepare(ctx, &frame), TYN_ERR_PARAMS);
    assert_int_equal(f->lines, 1);
    tyn_context_destroy(&ctx);
    for (int i = 0; i < 6; i++) {
        host_image_free(&f->host, &own[i]);
    }
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matrices),   cmocka_unit_test(jitter), cmocka_unit_test(bad_views),
        cmocka_unit_test(images),     cmocka_unit_test(light),  cmocka_unit_test(half_resolution),
        cmocka_unit_test(bad_images),
    };
    return run_cases(tests, set_up, tear_down);
}
