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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matrices),
        cmocka_unit_test(jitter),
        cmocka_unit_test(bad_views),
    };
    return run_cases(tests, set_up, tear_down);
}
