// views.c -- matrices in place of a camera, and jitter.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "bound.h"
#include "fog_host.h"
#include "numbers.h"

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

void matrices(void **state)
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

// How far a picture that jitter moves by whole pixels is off the still one moved by them, of the brightest.
static double moved_by(fixture *f, tyn_frame frame, const char *sparse, uint32_t pixels)
{
    const tyn_log log = {0};
    assert_int_equal(tyn_settings_set(f->settings, "raymarch.sparse", sparse, &log), TYN_OK);
    tyn_context *ctx = new_context(f, "pop");
    float *still = radiance_of(f, ctx, frame);
    frame.jitter[0] = (float)pixels;
    float *moved = radiance_of(f, ctx, frame);
    const double off = difference(moved, WIDTH, 0, WIDTH - pixels, still, WIDTH, pixels, false);
    free(still);
    free(moved);
    tyn_context_destroy(&ctx);
    assert_int_equal(tyn_settings_set(f->settings, "raymarch.sparse", "1", &log), TYN_OK);
    return off;
}

void jitter(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_scene(&scene);
    const tyn_view view = make_view(TYN_OUTPUT_RADIANCE);
    tyn_frame frame = {.scene = &scene, .view = &view};
    const double every_ray = moved_by(f, frame, "0", 1), by_a_pixel = moved_by(f, frame, "1", 1),
                 by_a_tile = moved_by(f, frame, "1", 8);
    tyn_context *ctx = new_context(f, "pop");
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
    print_message("jitter: %.2g against a picture shifted by a pixel with a march of every ray, "
                  "%.2g without, %.2g by 8, %.2g against the matrix\n",
                  every_ray, by_a_pixel, by_a_tile, as_matrix);
    // The march begins within its first step by the pixel, in tiles of 8 x 8 (raymarch_pixel.glsl): rays that are the same
    // then take their samples elsewhere. Rays of the sparse march begin at every fourth pixel of the screen: it is .040 off
    // the march of every ray at most, in the still picture and in the moved one.
    assert_within(every_ray, 2.5e-3, NULL);
    assert_within(by_a_pixel, 0.045, NULL);
    assert_true(by_a_tile <= 2e-5);
    assert_true(as_matrix <= 2e-5);
    free(asked);
    free(given);
    tyn_context_destroy(&ctx);
    tyn_scene_finish(&scene);
    assert_int_equal(f->lines, 0);
}

static const tyn_image no_image; // matrices are looked at first

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
    case 9: // an oblique near plane, with depth alone
        frame->view_to_clip[2] = 0.25f;
        frame->depth = &no_image;
        break;
    default:
        return false;
    }
    return true;
}

void bad_views(void **state)
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
        if (frame.depth) {
            assert_non_null(strstr(f->last_line, "oblique"));
            frame.depth = NULL; // nothing is read by that plane
            assert_int_equal(tyn_context_prepare(ctx, &frame), TYN_OK);
        }
    }
    tyn_context_destroy(&ctx);
    tyn_scene_finish(&scene);
}
