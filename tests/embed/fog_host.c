// fog_host.c -- see fog_host.h.
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
#include "skip.h"

static void on_log(void *user, tyn_log_level level, const char *message)
{
    fixture *f = user;
    if (level == TYN_LOG_ERROR) {
        f->lines++;
        snprintf(f->last_line, sizeof f->last_line, "%s", message);
    }
    print_message("  %s\n", message);
}

int set_up(void **state)
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

int tear_down(void **state)
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

tyn_context *new_context(fixture *f, const char *method)
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

void make_scene(tyn_scene *scene)
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

tyn_camera make_camera(bool orthographic)
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

tyn_view make_view(uint32_t outputs)
{
    return (tyn_view){.width = WIDTH,
                      .height = HEIGHT,
                      .outputs = outputs,
                      .no_background = true,
                      .camera = make_camera(false)};
}

void set_world_to_view(tyn_frame *frame, const tyn_camera *c, float unit)
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

void set_view_to_clip(tyn_frame *frame, const tyn_camera *c, float aspect, int depth)
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
