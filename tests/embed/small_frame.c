// small_frame.c -- see small_frame.h.
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "skip.h"
#include "small_frame.h"
#include "states.h"

static void on_log(void *user, tyn_log_level level, const char *message)
{
    fixture *f = user;
    f->errors += level == TYN_LOG_ERROR;
    f->warnings += level == TYN_LOG_WARN;
    print_message("  %s\n", message);
}

static void submit(void *user, void (*run)(void *job), void *one)
{
    fixture *f = user;
    if (f->at_once) {
        run(one);
        return;
    }
    pthread_mutex_lock(&f->lock);
    assert_true(f->num_jobs < MAX_JOBS);
    f->jobs[f->num_jobs++] = (job){run, one};
    pthread_mutex_unlock(&f->lock);
}

// Runs jobs of the host's until there are none, or `most`.
uint32_t run_jobs(fixture *f, uint32_t most)
{
    uint32_t run = 0;
    for (; run < most; run++) {
        pthread_mutex_lock(&f->lock);
        const job next = f->num_jobs ? f->jobs[--f->num_jobs] : (job){NULL, NULL};
        pthread_mutex_unlock(&f->lock);
        if (!next.run) {
            break;
        }
        next.run(next.job);
    }
    return run;
}

void *run_all_jobs(void *user)
{
    run_jobs(user, UINT32_MAX);
    return NULL;
}

tyn_result try_device(fixture *f, device_choice c, tyn_device **dev)
{
    tyn_device_params params = {.struct_size = sizeof(params),
                                .compile_threads = c.threads,
                                .pipeline_cache = c.blob,
                                .pipeline_cache_size = c.blob_size,
                                .log = {on_log, f, TYN_LOG_WARN}};
    host_describe(&f->host, &params);
    params.jobs = c.jobs ? (tyn_jobs){submit, f} : (tyn_jobs){NULL, NULL};
    params.get_instance_proc_addr = kernel_driver_start(f->host.get_instance_proc_addr);
    return tyn_device_create(&params, dev);
}

tyn_device *new_device(fixture *f, device_choice c)
{
    tyn_device *dev = NULL;
    assert_int_equal(try_device(f, c, &dev), TYN_OK);
    return dev;
}

tyn_context *new_context(tyn_device *dev)
{
    tyn_context *ctx = NULL;
    assert_int_equal(tyn_context_create(
                         dev, tyn_context_params(.method = "single", .frames_in_flight = 1), &ctx),
                     TYN_OK);
    return ctx;
}

uint32_t compiled(tyn_device *dev)
{
    tyn_pipeline_stats stats;
    tyn_device_pipelines(dev, &stats);
    return stats.compiled;
}

// ---- frames -------------------------------------------------------------------------------------

// The images are in `before` as targets of copies; after the frame the colour is copied from, the depth read.
void lend(fixture *f, uint32_t slot, bool background, lent_frame *l)
{
    host_image color = f->color[slot], depth = f->depth;
    color.state = depth.state = copy_target;
    l->color = host_lend(&color, copy_source);
    l->depth = host_lend(&depth, depth_tested);
    l->frame = (tyn_frame){.struct_size = sizeof l->frame,
                           .scene = &f->scene,
                           .view = &f->view,
                           .color = &l->color,
                           .depth = &l->depth,
                           .background = background};
    l->frame.view_to_clip[0] = l->frame.view_to_clip[5] = 2;
    l->frame.view_to_clip[11] = -1;
    l->frame.view_to_clip[14] = 0.1f;
}

tyn_result prepare(fixture *f, tyn_context *ctx, bool background)
{
    lent_frame l;
    lend(f, 0, background, &l);
    return tyn_context_prepare(ctx, &l.frame);
}

// Records over the painted images, in a command buffer that was begun.
tyn_result record_into(fixture *f, tyn_context *ctx, uint32_t slot, VkCommandBuffer cmd,
                       bool background)
{
    lent_frame l;
    lend(f, slot, background, &l);
    l.frame.cmd = cmd;
    return tyn_context_record(ctx, &l.frame);
}

VkCommandBuffer begin(fixture *f, uint32_t slot)
{
    const VkCommandBuffer cmd = host_begin(&f->host, slot);
    f->color[slot].state = f->depth.state = nothing_yet;
    host_transition(&f->host, cmd, &f->color[slot], copy_target);
    host_transition(&f->host, cmd, &f->depth, copy_target);
    host_upload(&f->host, cmd, &f->up, &f->color[slot]);
    host_upload(&f->host, cmd, &f->depth_up, &f->depth);
    return cmd;
}

// The host goes on from the states it was promised.
void finish(fixture *f, uint32_t slot, VkCommandBuffer cmd)
{
    f->color[slot].state = copy_source;
    host_download(&f->host, cmd, &f->color[slot], &f->down[slot]);
    f->depth.state = depth_tested;
    host_transition(&f->host, cmd, &f->depth, copy_source);
    host_submit(&f->host, slot);
    host_wait(&f->host, slot);
}

tyn_result record(fixture *f, tyn_context *ctx, bool background)
{
    const VkCommandBuffer cmd = begin(f, 0);
    const tyn_result result = record_into(f, ctx, 0, cmd, background);
    assert_true(result >= 0); // the states are as promised
    finish(f, 0, cmd);
    return result;
}

void expect_untouched(const fixture *f)
{
    assert_memory_equal(f->down[0].data, f->up.data, f->up.size);
}

void expect_picture(const fixture *f, uint32_t slot)
{
    assert_memory_equal(f->down[slot].data, f->expected, f->up.size);
}

double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

void wait_for(tyn_context *ctx)
{
    const double start = now();
    while (tyn_context_pending(ctx)) {
        usleep(500);
        assert_true(now() - start < 120);
    }
}

int frame_set_up(void **state)
{
    fixture *f = calloc(1, sizeof(*f));
    *state = f;
    if (host_open(&f->host, true) != HOST_OK) {
        skip_all("the host has no device");
    }
    pthread_mutex_init(&f->lock, NULL);
    const VkExtent3D extent = {SIDE, SIDE, 1};
    const VkImageUsageFlags copied =
        VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    f->up = host_buffer_new(&f->host, SIDE * SIDE * 16);
    f->depth_up = host_buffer_new(&f->host, SIDE * SIDE * 4);
    for (uint32_t i = 0; i < HOST_SLOTS; i++) {
        f->color[i] = host_image_new(&f->host, VK_FORMAT_R32G32B32A32_SFLOAT, extent,
                                     VK_IMAGE_USAGE_STORAGE_BIT | copied);
        f->down[i] = host_buffer_new(&f->host, SIDE * SIDE * 16);
    }
    f->depth = host_image_new(&f->host, VK_FORMAT_D32_SFLOAT, extent,
                              VK_IMAGE_USAGE_SAMPLED_BIT |
                                  VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | copied);
    for (int i = 0; i < SIDE * SIDE * 4; i++) {
        ((float *)f->up.data)[i] = (float)(i % 7) / 8;
    }
    memset(f->depth_up.data, 0, f->depth_up.size); // nothing is in front
    tyn_scene_init(&f->scene);
    f->scene.num_media = f->scene.num_shapes = f->scene.num_lights = 1;
    f->scene.media[0] =
        (tyn_medium){.sigma_s = {0.05f, 0.1f, 0.2f}, .density_scale = 1, .volume = -1};
    f->scene.shapes[0] = (tyn_shape){.to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    f->scene.lights[0] = (tyn_light){.color = {3, 3, 3}, .direction = {0, -1, 0}};
    f->view = (tyn_view){.width = SIDE, .height = SIDE, .outputs = TYN_OUTPUT_COMPOSITE};
    f->view.no_background = true;
    tyn_camera_frame_scene(&f->view.camera, &f->scene);

    tyn_device *dev = new_device(f, (device_choice){0});
    tyn_context *ctx = new_context(dev);
    assert_int_equal(prepare(f, ctx, false), TYN_OK);
    assert_int_equal(tyn_context_pending(ctx), 0);
    assert_int_equal(record(f, ctx, false), TYN_OK);
    f->expected = malloc(f->up.size);
    memcpy(f->expected, f->down[0].data, f->up.size);
    assert_memory_not_equal(f->expected, f->up.data, f->up.size);
    print_message("%u kernels\n", compiled(dev));
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    return 0;
}

int frame_tear_down(void **state)
{
    fixture *f = *state;
    for (uint32_t i = 0; i < HOST_SLOTS; i++) {
        host_image_free(&f->host, &f->color[i]);
        host_buffer_free(&f->host, &f->down[i]);
    }
    host_image_free(&f->host, &f->depth);
    host_buffer_free(&f->host, &f->up);
    host_buffer_free(&f->host, &f->depth_up);
    kernel_driver_finish(f->host.device);
    host_close(&f->host);
    const uint32_t messages = f->host.messages;
    pthread_mutex_destroy(&f->lock);
    free(f->expected);
    free(f);
    if (messages) { // cmocka does not count what a teardown of a group finds
        exit(EXIT_FAILURE);
    }
    return 0;
}

int frame_reset(void **state)
{
    fixture *f = *state;
    f->errors = f->warnings = 0;
    f->num_jobs = 0;
    f->at_once = false;
    f->view.outputs = TYN_OUTPUT_COMPOSITE;
    kernel_driver_reset();
    return 0;
}

int frame_silent(void **state)
{
    fixture *f = *state;
    assert_int_equal(f->errors, 0);
    assert_int_equal(f->warnings, 0);
    assert_int_equal(f->num_jobs, 0);
    assert_int_equal(f->host.messages, 0);
    return 0;
}
