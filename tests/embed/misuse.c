// misuse.c -- a host gives a context and its frames what they must not get: each is refused with one line, nothing is
// recorded, nothing crashes, and the frame that is right still is.
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
#include <tyndall/registry.h>

#include "host.h"
#include "skip.h"
#include "states.h"

enum { SIDE = 32, VOXELS = 8 };

typedef struct fixture {
    host host;
    tyn_device *dev;
    host_image color, depth, density;
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
    const VkExtent3D extent = {SIDE, SIDE, 1}, voxels = {VOXELS, VOXELS, VOXELS};
    f->color = host_image_new(&f->host, VK_FORMAT_R32G32B32A32_SFLOAT, extent,
                              VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    f->depth = host_image_new(&f->host, VK_FORMAT_D32_SFLOAT, extent,
                              VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    f->density = host_image_new(&f->host, VK_FORMAT_R16_SFLOAT, voxels,
                                VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    host_image_free(&f->host, &f->color);
    host_image_free(&f->host, &f->depth);
    host_image_free(&f->host, &f->density);
    tyn_device_destroy(&f->dev);
    host_close(&f->host);
    const uint32_t messages = f->host.messages;
    free(f);
    if (messages) { // cmocka does not count what a teardown of a group finds
        exit(EXIT_FAILURE);
    }
    return 0;
}

// A frame with all that a frame can have.
typedef struct whole_frame {
    tyn_volume volume;
    tyn_scene scene;
    tyn_view view;
    tyn_image color, depth, density;
    tyn_frame frame;
} whole_frame;

static void make_frame(fixture *f, whole_frame *w)
{
    memset(w, 0, sizeof *w);
    tyn_scene_init(&w->scene);
    w->volume = (tyn_volume){.size = {VOXELS, VOXELS, VOXELS}, .max_density = 1};
    w->scene.volumes = &w->volume;
    w->scene.num_volumes = w->scene.num_media = w->scene.num_shapes = w->scene.num_lights = 1;
    w->scene.media[0] = (tyn_medium){.sigma_s = {1, 1, 1}};
    w->scene.shapes[0] = (tyn_shape){.to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    w->scene.lights[0] = (tyn_light){.color = {1, 1, 1}, .direction = {0, -1, 0}};
    w->view = (tyn_view){.width = SIDE, .height = SIDE, .outputs = TYN_OUTPUT_COMPOSITE};
    tyn_camera_frame_scene(&w->view.camera, &w->scene);
    w->color = host_lend(&f->color, general);
    w->depth = host_lend(&f->depth, general);
    w->density = host_lend(&f->density, general);
    w->frame = (tyn_frame){.struct_size = sizeof w->frame,
                           .scene = &w->scene,
                           .view = &w->view,
                           .color = &w->color,
                           .depth = &w->depth,
                           .densities = &w->density};
    w->frame.view_to_clip[0] = w->frame.view_to_clip[5] = 2;
    w->frame.view_to_clip[11] = -1;
    w->frame.view_to_clip[14] = 0.1f;
}

// False: there is no such fault.
static bool spoil(whole_frame *w, int fault)
{
    static const float points[1][3] = {{0, 0, 0}};
    switch (fault) {
    case 0:
        w->frame.struct_size = 0;
        break;
    case 1:
        w->frame.scene = NULL;
        break;
    case 2:
        w->frame.view = NULL;
        break;
    case 3:
        w->view.width = 0;
        break;
    case 4:
        w->view.height = 20000;
        break;
    case 5:
        w->view.outputs = 1u << 30;
        break;
    case 6:
        w->view.outputs = TYN_OUTPUT_FLUXES;
        break; // of another method
    case 7:
        w->view.outputs |= TYN_OUTPUT_PROBE;
        break; // without points
    case 8:
        w->view.outputs |= TYN_OUTPUT_PROBE, w->view.points = points;
        break; // none of them
    case 9:
        w->frame.color = NULL;
        break;
    case 10:
        w->color.image = VK_NULL_HANDLE;
        break;
    case 11:
        w->color.view = VK_NULL_HANDLE;
        break;
    case 12:
        w->color.format = VK_FORMAT_R8G8B8A8_UNORM;
        break;
    case 13:
        w->color.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
        break;
    case 14:
        w->color.extent.width = 8;
        break;
    case 15:
        w->color.after = nothing_yet;
        break;
    case 16:
        w->depth.image = VK_NULL_HANDLE;
        break;
    case 17:
        w->depth.view = VK_NULL_HANDLE;
        break;
    case 18:
        w->depth.format = VK_FORMAT_R32_SFLOAT;
        break;
    case 19:
        w->depth.usage = VK_IMAGE_USAGE_STORAGE_BIT;
        break;
    case 20:
        w->depth.extent.height = 8;
        break;
    case 21:
        w->depth.after = nothing_yet;
        break;
    case 22:
        memset(w->frame.view_to_clip, 0, sizeof w->frame.view_to_clip);
        break;
    case 23:
        w->frame.view_to_clip[14] = NAN;
        break;
    case 24:
        w->frame.view_to_clip[11] = 0;
        break; // every z has one depth
    case 25:
        w->frame.densities = NULL;
        break;
    case 26:
        w->density.image = VK_NULL_HANDLE;
        break;
    case 27:
        w->density.view = VK_NULL_HANDLE;
        break;
    case 28:
        w->density.usage = VK_IMAGE_USAGE_STORAGE_BIT;
        break;
    case 29:
        w->density.extent.depth = 2;
        break;
    case 30:
        w->density.after = nothing_yet;
        break;
    case 31:
        memset(&w->view.camera, 0, sizeof w->view.camera);
        break;
    case 32:
        w->view.camera.projection = (tyn_projection)5;
        break;
    case 33:
        w->view.camera.yfov = NAN;
        break;
    case 34:
        w->volume.max_density = 0;
        break;
    case 35:
        w->scene.volumes = NULL;
        break;
    case 36:
        w->scene.num_shapes = 1000;
        break;
    case 37:
        w->scene.surfaces.num_triangles = 1;
        break;
    case 38:
        w->scene.surfaces.num_vertices = 3;
        break;
    case 39:
        w->scene.lights[0].direction[1] = 0;
        break;
    case 40:
        w->scene.shapes[0].medium = 3;
        break;
    case 41:
        w->scene.media[0].sigma_s[0] = INFINITY;
        break;
    case 42:
        w->scene.cameras = NULL, w->scene.num_cameras = 2;
        break;
    case 43:
        w->color.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
        break;
    case 44:
        w->depth.format = VK_FORMAT_D32_SFLOAT_S8_UINT;
        w->depth.aspect = VK_IMAGE_ASPECT_DEPTH_BIT; // without separateDepthStencilLayouts
        break;
    case 45:
        w->density.format = VK_FORMAT_R32_UINT;
        break;
    case 46:
        w->depth.image = w->color.image;
        break;
    case 47:
        w->frame.light.red = &w->color;
        break; // without its output
    case 48:
        w->view.whole[0] = w->view.whole[1] = SIDE - 1;
        break;
    case 49:
        w->view.whole[0] = 2 * SIDE; // by 0
        break;
    case 50:
        w->view.whole[0] = w->view.whole[1] = 2 * SIDE;
        w->view.corner[1] = UINT32_MAX;
        break;
    default:
        return false;
    }
    return true;
}

static void frames(void **state)
{
    fixture *f = *state;
    tyn_context *ctx = NULL;
    assert_int_equal(tyn_context_create(f->dev, tyn_context_params(), &ctx), TYN_OK);
    whole_frame w;
    make_frame(f, &w);
    assert_int_equal(tyn_context_prepare(ctx, &w.frame), TYN_OK);
    const VkCommandBuffer cmd = host_begin(&f->host, 0);
    int fault = 0;
    for (;; fault++) {
        make_frame(f, &w);
        if (!spoil(&w, fault)) {
            break;
        }
        for (int background = 0; background < 2; background++) {
            print_message("fault %d%s\n", fault, background ? " in the background" : "");
            w.frame.background = background;
            f->lines = 0;
            assert_true(tyn_context_prepare(ctx, &w.frame) < 0);
            assert_int_equal(f->lines, 1);
            w.frame.cmd = cmd;
            assert_true(tyn_context_record(ctx, &w.frame) < 0);
            assert_int_equal(f->lines, 2);
            assert_true(tyn_context_batch(ctx, &w.frame) >= 1);
            assert_int_equal(tyn_context_pending(ctx), 0);
        }
    }
    f->lines = 0;
    assert_true(tyn_context_prepare(ctx, NULL) < 0);
    assert_true(tyn_context_record(ctx, NULL) < 0);
    make_frame(f, &w);
    assert_true(tyn_context_record(ctx, &w.frame) < 0); // no command buffer
    assert_int_equal(f->lines, 3);
    // To be read, and without content.
    tyn_image *const read[] = {&w.color, &w.depth, &w.density};
    enum { READ = sizeof read / sizeof *read };
    for (int i = 0; i < READ; i++) {
        make_frame(f, &w);
        w.frame.cmd = cmd;
        read[i]->before = nothing_yet;
        assert_true(tyn_context_record(ctx, &w.frame) < 0);
        assert_int_equal(f->lines, 4 + i);
    }
    print_message("%d faults\n", fault + 3 + READ);
    // The context is as it was.
    f->lines = 0;
    make_frame(f, &w);
    w.frame.cmd = cmd;
    f->color.state = f->depth.state = f->density.state = nothing_yet;
    host_transition(&f->host, cmd, &f->color, general);
    host_transition(&f->host, cmd, &f->depth, general);
    host_transition(&f->host, cmd, &f->density, general);
    make_frame(f, &w);
    w.frame.cmd = cmd;
    assert_int_equal(tyn_context_prepare(ctx, &w.frame), TYN_OK);
    assert_int_equal(tyn_context_record(ctx, &w.frame), TYN_OK);
    host_submit(&f->host, 0);
    host_wait(&f->host, 0);
    assert_int_equal(f->lines, 0);
    tyn_context_destroy(&ctx);
}

static void contexts(void **state)
{
    fixture *f = *state;
    tyn_context *ctx = NULL;
    tyn_offline *off = NULL;
    f->lines = 0;
    assert_true(tyn_context_create(f->dev, NULL, &ctx) < 0);
    assert_true(tyn_context_create(f->dev, tyn_context_params(), NULL) < 0);
    assert_true(tyn_context_create(f->dev, &(tyn_context_params){.method = "pop"}, &ctx) < 0);
    assert_true(tyn_context_create(f->dev, tyn_context_params(.method = "none"), &ctx) < 0);
    assert_true(tyn_context_create(f->dev, tyn_context_params(.method = ""), &ctx) < 0);
    assert_true(tyn_context_create(f->dev, tyn_context_params(.frames_in_flight = 9), &ctx) < 0);
    assert_true(tyn_context_create(f->dev, tyn_context_params(.quality = (tyn_quality)9), &ctx) <
                0);
    assert_null(ctx);
    // A host's device has no queue of ours.
    assert_true(tyn_offline_create(f->dev, tyn_offline_params(), &off) < 0);
    assert_true(tyn_offline_create(f->dev, NULL, &off) < 0);
    assert_null(off);
    assert_int_equal(f->lines, 9);
    // Bytes of compiled kernels with no room for them.
    char room[8];
    size_t size = sizeof room;
    assert_true(tyn_device_pipeline_cache(f->dev, room, &size) < 0);
    assert_int_equal(size, 0);
    assert_true(tyn_device_pipeline_cache(f->dev, room, NULL) < 0);
    assert_int_equal(f->lines, 11);
    // Before there is a frame.
    assert_int_equal(tyn_context_create(f->dev, tyn_context_params(.readback = true), &ctx),
                     TYN_OK);
    tyn_report report;
    tyn_inspection inspection;
    double value;
    f->lines = 0;
    assert_true(tyn_context_set(ctx, "lattice.cells", "many") < 0);
    assert_true(tyn_context_set(ctx, "lattice", "8") < 0);
    assert_true(tyn_context_set(ctx, NULL, "8") < 0);
    assert_true(tyn_context_set(ctx, "lattice.cells", NULL) < 0);
    assert_true(tyn_context_set_quality(ctx, (tyn_quality)-1) < 0);
    assert_true(tyn_context_get(ctx, "lattice.size", &value) < 0);
    assert_true(tyn_context_get(ctx, "lattice.cells", NULL) < 0);
    assert_int_equal(f->lines, 7);
    assert_null(tyn_context_output(ctx, TYN_OUTPUT_RADIANCE));
    assert_null(tyn_context_output(ctx, (tyn_output)0));
    tyn_context_report(ctx, &report);
    assert_int_equal(report.num_nodes, 0);
    assert_int_equal(tyn_context_pending(ctx), 0);
    tyn_context_inspect(ctx, "no such pass");
    assert_false(tyn_context_inspection(ctx, &inspection));
    free(tyn_context_graph(ctx, false));
    tyn_context_destroy(&ctx);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames),
        cmocka_unit_test(contexts),
    };
    return cmocka_run_group_tests_name("misuse", tests, set_up, tear_down);
}
