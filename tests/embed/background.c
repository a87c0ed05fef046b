// background.c -- kernels compiled beside the frames: by threads of the library's, by a host's jobs, from bytes that were kept.
//
// Between the library and the driver stands a driver of the test's, which can be slow, fail, and tell what it was given:
// when a kernel is compiled is then no accident.
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>
#include <tyndall/context.h>

#include "host.h"
#include "skip.h"
#include "states.h"

enum { SIDE = 32, MAX_JOBS = 256, HEADER = 56 };

// ---- the driver in between ----------------------------------------------------------------------

static struct {
    PFN_vkGetInstanceProcAddr instance_proc;
    PFN_vkGetDeviceProcAddr device_proc;
    PFN_vkCreateComputePipelines compute;
    PFN_vkCreatePipelineCache create_cache;
    atomic_int ms;        // that a kernel takes more
    atomic_int under_way; // kernels
    atomic_int most;      // of them at once
    atomic_int fail;      // so many more kernels
    bool cache;           // it has one: of these bytes
    bool refuses;         // to read any
    char kept[16];
    char given[16]; // at creation
    size_t given_size;
} driver;

static const VkPipelineCreationFeedbackCreateInfo *feedback_of(const void *chain)
{
    const VkBaseInStructure *s = chain;
    while (s && s->sType != VK_STRUCTURE_TYPE_PIPELINE_CREATION_FEEDBACK_CREATE_INFO) {
        s = s->pNext;
    }
    return (const VkPipelineCreationFeedbackCreateInfo *)s;
}

static VKAPI_ATTR VkResult VKAPI_CALL compile(VkDevice device, VkPipelineCache cache,
                                              uint32_t count,
                                              const VkComputePipelineCreateInfo *info,
                                              const VkAllocationCallbacks *callbacks,
                                              VkPipeline *out)
{
    const int others = atomic_fetch_add(&driver.under_way, 1);
    int most = driver.most;
    while (most < others + 1 && !atomic_compare_exchange_weak(&driver.most, &most, others + 1)) {
    }
    usleep(1000u * (unsigned)driver.ms);
    VkResult made = VK_ERROR_OUT_OF_HOST_MEMORY;
    if (driver.fail > 0) {
        driver.fail--;
    } else {
        made = driver.compute(device, cache, count, info, callbacks, out);
        const VkPipelineCreationFeedbackCreateInfo *feedback = feedback_of(info->pNext);
        if (driver.cache && feedback) {
            feedback->pPipelineCreationFeedback->flags =
                VK_PIPELINE_CREATION_FEEDBACK_VALID_BIT |
                (driver.given_size
                     ? VK_PIPELINE_CREATION_FEEDBACK_APPLICATION_PIPELINE_CACHE_HIT_BIT
                     : 0u);
        }
    }
    driver.under_way--;
    return made;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_cache(VkDevice device,
                                                   const VkPipelineCacheCreateInfo *info,
                                                   const VkAllocationCallbacks *callbacks,
                                                   VkPipelineCache *out)
{
    VkPipelineCacheCreateInfo passed = *info;
    driver.given_size = info->initialDataSize;
    if (driver.refuses && info->initialDataSize) {
        return VK_ERROR_INITIALIZATION_FAILED;
    }
    if (driver.cache) {
        const size_t size =
            driver.given_size < sizeof driver.given ? driver.given_size : sizeof driver.given;
        if (size) {
            memcpy(driver.given, info->pInitialData, size);
        }
        passed.initialDataSize = 0;
        passed.pInitialData = NULL;
    }
    return driver.create_cache(device, &passed, callbacks, out);
}

static VKAPI_ATTR VkResult VKAPI_CALL cache_data(VkDevice device, VkPipelineCache cache,
                                                 size_t *size, void *data)
{
    (void)device, (void)cache;
    const size_t room = *size;
    *size = data && room < sizeof driver.kept ? room / 8 * 8 : sizeof driver.kept;
    if (data) {
        memcpy(data, driver.kept, *size);
    }
    return *size < sizeof driver.kept ? VK_INCOMPLETE : VK_SUCCESS;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_proc(VkDevice device, const char *name)
{
    PFN_vkVoidFunction found = driver.device_proc(device, name);
    if (!strcmp(name, "vkCreateComputePipelines")) {
        driver.compute = (PFN_vkCreateComputePipelines)found;
        return (PFN_vkVoidFunction)compile;
    }
    if (!strcmp(name, "vkCreatePipelineCache")) {
        driver.create_cache = (PFN_vkCreatePipelineCache)found;
        return (PFN_vkVoidFunction)create_cache;
    }
    return driver.cache && !strcmp(name, "vkGetPipelineCacheData") ? (PFN_vkVoidFunction)cache_data
                                                                   : found;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_proc(VkInstance instance, const char *name)
{
    PFN_vkVoidFunction found = driver.instance_proc(instance, name);
    if (strcmp(name, "vkGetDeviceProcAddr") != 0) {
        return found;
    }
    driver.device_proc = (PFN_vkGetDeviceProcAddr)found;
    return (PFN_vkVoidFunction)device_proc;
}

// ---- the fixture --------------------------------------------------------------------------------

typedef struct job {
    void (*run)(void *job);
    void *job;
} job;

typedef struct fixture {
    host host;
    atomic_int errors, warnings; // lines of the log
    host_image color[HOST_SLOTS], depth;
    host_buffer up, down[HOST_SLOTS], depth_up;
    tyn_scene scene;
    tyn_view view;
    float *expected; // the picture of a frame whose kernels are compiled in the call
    // The host's job system: what was handed over and has not been run.
    job jobs[MAX_JOBS];
    uint32_t num_jobs;
    pthread_mutex_t lock;
    bool at_once; // run in submit
} fixture;

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
static uint32_t run_jobs(fixture *f, uint32_t most)
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

static void *run_all_jobs(void *user)
{
    run_jobs(user, UINT32_MAX);
    return NULL;
}

typedef struct device_choice {
    uint32_t threads;
    bool jobs;
    const void *blob;
    size_t blob_size;
} device_choice;

static tyn_result try_device(fixture *f, device_choice c, tyn_device **dev)
{
    tyn_device_params params = {.struct_size = sizeof(params),
                                .compile_threads = c.threads,
                                .pipeline_cache = c.blob,
                                .pipeline_cache_size = c.blob_size,
                                .log = {on_log, f, TYN_LOG_WARN}};
    host_describe(&f->host, &params);
    params.jobs = c.jobs ? (tyn_jobs){submit, f} : (tyn_jobs){NULL, NULL};
    params.get_instance_proc_addr = instance_proc;
    driver.instance_proc = f->host.get_instance_proc_addr;
    return tyn_device_create(&params, dev);
}

static tyn_device *new_device(fixture *f, device_choice c)
{
    tyn_device *dev = NULL;
    assert_int_equal(try_device(f, c, &dev), TYN_OK);
    return dev;
}

static tyn_context *new_context(tyn_device *dev)
{
    tyn_context *ctx = NULL;
    assert_int_equal(tyn_context_create(
                         dev, tyn_context_params(.method = "single", .frames_in_flight = 1), &ctx),
                     TYN_OK);
    return ctx;
}

static uint32_t compiled(tyn_device *dev)
{
    tyn_pipeline_stats stats;
    tyn_device_pipelines(dev, &stats);
    return stats.compiled;
}

// ---- frames -------------------------------------------------------------------------------------

typedef struct lent_frame {
    tyn_image color, depth;
    tyn_frame frame;
} lent_frame;

// The images are in `before` as targets of copies; after the frame the colour is copied from, the depth read.
static void lend(fixture *f, uint32_t slot, bool background, lent_frame *l)
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

static tyn_result prepare(fixture *f, tyn_context *ctx, bool background)
{
    lent_frame l;
    lend(f, 0, background, &l);
    return tyn_context_prepare(ctx, &l.frame);
}

// Records over the painted images, in a command buffer that was begun.
static tyn_result record_into(fixture *f, tyn_context *ctx, uint32_t slot, VkCommandBuffer cmd,
                              bool background)
{
    lent_frame l;
    lend(f, slot, background, &l);
    l.frame.cmd = cmd;
    return tyn_context_record(ctx, &l.frame);
}

static VkCommandBuffer begin(fixture *f, uint32_t slot)
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
static void finish(fixture *f, uint32_t slot, VkCommandBuffer cmd)
{
    f->color[slot].state = copy_source;
    host_download(&f->host, cmd, &f->color[slot], &f->down[slot]);
    f->depth.state = depth_tested;
    host_transition(&f->host, cmd, &f->depth, copy_source);
    host_submit(&f->host, slot);
    host_wait(&f->host, slot);
}

static tyn_result record(fixture *f, tyn_context *ctx, bool background)
{
    const VkCommandBuffer cmd = begin(f, 0);
    const tyn_result result = record_into(f, ctx, 0, cmd, background);
    assert_true(result >= 0); // the states are as promised
    finish(f, 0, cmd);
    return result;
}

static void expect_untouched(const fixture *f)
{
    assert_memory_equal(f->down[0].data, f->up.data, f->up.size);
}

static void expect_picture(const fixture *f, uint32_t slot)
{
    assert_memory_equal(f->down[slot].data, f->expected, f->up.size);
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

static void wait_for(tyn_context *ctx)
{
    const double start = now();
    while (tyn_context_pending(ctx)) {
        usleep(500);
        assert_true(now() - start < 120);
    }
}

static int set_up(void **state)
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
    f->scene.media[0] = (tyn_medium){.sigma_s = {1, 1.5f, 2}, .density_scale = 1, .volume = -1};
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

static int tear_down(void **state)
{
    fixture *f = *state;
    for (uint32_t i = 0; i < HOST_SLOTS; i++) {
        host_image_free(&f->host, &f->color[i]);
        host_buffer_free(&f->host, &f->down[i]);
    }
    host_image_free(&f->host, &f->depth);
    host_buffer_free(&f->host, &f->up);
    host_buffer_free(&f->host, &f->depth_up);
    host_close(&f->host);
    const uint32_t messages = f->host.messages;
    pthread_mutex_destroy(&f->lock);
    free(f->expected);
    free(f);
    assert_int_equal(messages, 0);
    return 0;
}

static int reset(void **state)
{
    fixture *f = *state;
    f->errors = f->warnings = 0;
    f->num_jobs = 0;
    f->at_once = false;
    f->view.outputs = TYN_OUTPUT_COMPOSITE;
    driver.ms = driver.fail = driver.most = 0;
    driver.cache = driver.refuses = false;
    return 0;
}

static int silent(void **state)
{
    fixture *f = *state;
    assert_int_equal(f->errors, 0);
    assert_int_equal(f->warnings, 0);
    assert_int_equal(f->num_jobs, 0);
    return 0;
}

// ---- who compiles -------------------------------------------------------------------------------

static void threads_compile_and_frames_leave_the_picture_alone(void **state)
{
    fixture *f = *state;
    for (uint32_t threads = 1; threads <= 3; threads += 2) {
        tyn_device *dev = new_device(f, (device_choice){.threads = threads});
        tyn_context *ctx = new_context(dev);
        driver.ms = 10;
        driver.most = 0;
        assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
        const uint32_t all = tyn_context_pending(ctx);
        uint32_t last = all, frames = 0;
        while (prepare(f, ctx, true) == TYN_PENDING) {
            const uint32_t left = tyn_context_pending(ctx);
            assert_true(left <= last);
            last = left;
            assert_int_equal(record(f, ctx, true), TYN_PENDING);
            expect_untouched(f);
            frames++;
            usleep(20000);
        }
        print_message("%u threads: %u kernels, %u frames meanwhile, %d at once\n", threads, all,
                      frames, driver.most);
        assert_true(all >= 5 && frames >= 2);
        assert_int_equal(driver.most, threads);
        assert_int_equal(compiled(dev), all);
        assert_int_equal(tyn_context_pending(ctx), 0);
        assert_int_equal(record(f, ctx, true), TYN_OK);
        expect_picture(f, 0);
        tyn_context_destroy(&ctx);
        tyn_device_destroy(&dev);
    }
}

static void jobs_of_the_host_compile(void **state)
{
    fixture *f = *state;
    tyn_device *dev = new_device(f, (device_choice){.jobs = true});
    tyn_context *ctx = new_context(dev);
    // A frame that was never prepared asks as well.
    assert_int_equal(record(f, ctx, true), TYN_PENDING);
    expect_untouched(f);
    const uint32_t all = tyn_context_pending(ctx);
    assert_int_equal(f->num_jobs, all);
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING); // asks for none twice
    assert_int_equal(f->num_jobs, all);
    assert_int_equal(compiled(dev), 0);
    assert_int_equal(run_jobs(f, 1), 1);
    assert_int_equal(tyn_context_pending(ctx), all - 1);
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, run_all_jobs, f), 0);
    run_all_jobs(f);
    pthread_join(thread, NULL);
    assert_int_equal(tyn_context_pending(ctx), 0);
    assert_int_equal(compiled(dev), all);
    // It is still to be prepared.
    assert_int_equal(record(f, ctx, true), TYN_PENDING);
    expect_untouched(f);
    assert_int_equal(prepare(f, ctx, true), TYN_OK);
    assert_int_equal(record(f, ctx, true), TYN_OK);
    expect_picture(f, 0);
    assert_int_equal(f->num_jobs, 0);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    // A job system without threads: the call is as if there were no background.
    f->at_once = true;
    dev = new_device(f, (device_choice){.jobs = true});
    ctx = new_context(dev);
    assert_int_equal(prepare(f, ctx, true), TYN_OK);
    assert_int_equal(record(f, ctx, true), TYN_OK);
    expect_picture(f, 0);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
}

static void frames_like_before_go_on(void **state)
{
    fixture *f = *state;
    tyn_device *dev = new_device(f, (device_choice){.jobs = true});
    tyn_context *ctx = new_context(dev);
    assert_int_equal(prepare(f, ctx, false), TYN_OK);
    assert_int_equal(record(f, ctx, false), TYN_OK);
    f->view.outputs = TYN_OUTPUT_COMPOSITE | TYN_OUTPUT_DISPLAY; // another kernel
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
    assert_true(tyn_context_pending(ctx) > 0);
    f->view.outputs = TYN_OUTPUT_COMPOSITE;
    assert_int_equal(record(f, ctx, true), TYN_OK);
    expect_picture(f, 0);
    // Without `background` the record of what is not prepared fails as it always did.
    f->view.outputs = TYN_OUTPUT_COMPOSITE | TYN_OUTPUT_DISPLAY;
    const VkCommandBuffer cmd = begin(f, 0);
    assert_int_equal(record_into(f, ctx, 0, cmd, false), TYN_ERR_PARAMS);
    assert_int_equal(f->errors, 1);
    f->errors = 0;
    host_submit(&f->host, 0);
    host_wait(&f->host, 0);
    run_all_jobs(f);
    assert_int_equal(prepare(f, ctx, true), TYN_OK);
    assert_int_equal(record(f, ctx, true), TYN_OK);
    expect_picture(f, 0);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
}

static void a_call_takes_what_is_queued(void **state)
{
    fixture *f = *state;
    tyn_device *dev = new_device(f, (device_choice){.jobs = true});
    tyn_context *waits = new_context(dev), *calls = new_context(dev);
    assert_int_equal(prepare(f, waits, true), TYN_PENDING);
    const uint32_t all = tyn_context_pending(waits);
    assert_int_equal(prepare(f, calls, false), TYN_OK);
    assert_int_equal(tyn_context_pending(waits), 0);
    assert_int_equal(run_jobs(f, UINT32_MAX), all); // which find nothing left
    assert_int_equal(compiled(dev), all);
    assert_int_equal(prepare(f, waits, true), TYN_OK);
    assert_int_equal(record(f, waits, true), TYN_OK);
    expect_picture(f, 0);
    tyn_context_destroy(&waits);
    tyn_context_destroy(&calls);
    tyn_device_destroy(&dev);
}

// ---- the end comes early ------------------------------------------------------------------------

static void destroyed_while_pending(void **state)
{
    fixture *f = *state;
    // The context: what nobody else wants is not compiled.
    tyn_device *dev = new_device(f, (device_choice){.jobs = true});
    tyn_context *ctx = new_context(dev), *other = new_context(dev);
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
    tyn_context_destroy(&ctx);
    run_all_jobs(f);
    assert_int_equal(compiled(dev), 0);
    // What another wants is.
    ctx = new_context(dev);
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
    assert_int_equal(prepare(f, other, true), TYN_PENDING);
    const uint32_t all = tyn_context_pending(other);
    tyn_context_destroy(&ctx);
    run_all_jobs(f);
    assert_int_equal(compiled(dev), all);
    assert_int_equal(prepare(f, other, true), TYN_OK);
    tyn_context_destroy(&other);
    tyn_device_destroy(&dev);
    // The device, before the host has run a job.
    dev = new_device(f, (device_choice){.jobs = true});
    ctx = new_context(dev);
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    assert_true(f->num_jobs > 0);
    run_all_jobs(f);
    // The device, while threads of the library's, or jobs, compile.
    for (int jobs = 0; jobs < 2; jobs++) {
        driver.ms = 100;
        dev = new_device(f, (device_choice){.jobs = jobs, .threads = 2});
        ctx = new_context(dev);
        assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
        pthread_t thread;
        if (jobs) {
            assert_int_equal(pthread_create(&thread, NULL, run_all_jobs, f), 0);
        }
        while (!driver.under_way) {
            usleep(500);
        }
        const double start = now();
        tyn_context_destroy(&ctx);
        tyn_device_destroy(&dev);
        assert_int_equal(driver.under_way, 0);
        print_message("%s: destroyed after %.2f s\n", jobs ? "jobs" : "threads", now() - start);
        if (jobs) {
            pthread_join(thread, NULL);
        }
    }
}

// ---- two threads --------------------------------------------------------------------------------

typedef struct user {
    pthread_t thread;
    fixture *f;
    tyn_context *ctx;
    VkCommandBuffer cmd;
    uint32_t slot;
    bool background;
    tyn_result result;
} user;

static void *use(void *arg)
{
    user *u = arg;
    lent_frame l;
    lend(u->f, u->slot, u->background, &l);
    l.frame.cmd = u->cmd;
    while ((u->result = tyn_context_prepare(u->ctx, &l.frame)) == TYN_PENDING) {
        usleep(1000);
    }
    if (u->result == TYN_OK) {
        u->result = tyn_context_record(u->ctx, &l.frame);
    }
    return NULL;
}

static void contexts_of_two_threads_share_pipelines(void **state)
{
    fixture *f = *state;
    for (int kind = 0; kind < 3; kind++) { // nobody, one, both in the background
        tyn_device *dev = new_device(f, (device_choice){.threads = 2});
        user users[HOST_SLOTS];
        driver.ms = 2;
        for (int i = 0; i < HOST_SLOTS; i++) {
            users[i] = (user){.f = f,
                              .ctx = new_context(dev),
                              .cmd = begin(f, (uint32_t)i),
                              .slot = (uint32_t)i,
                              .background = i < kind};
        }
        for (int i = 0; i < HOST_SLOTS; i++) {
            assert_int_equal(pthread_create(&users[i].thread, NULL, use, &users[i]), 0);
        }
        for (int i = 0; i < HOST_SLOTS; i++) {
            pthread_join(users[i].thread, NULL);
        }
        for (uint32_t i = 0; i < HOST_SLOTS; i++) {
            assert_int_equal(users[i].result, TYN_OK);
            finish(f, i, users[i].cmd);
            expect_picture(f, i);
            tyn_context_destroy(&users[i].ctx);
        }
        print_message("%d in the background: %u kernels\n", kind, compiled(dev));
        tyn_device_destroy(&dev);
    }
}

// ---- failure ------------------------------------------------------------------------------------

static void what_fails_beside_is_said_by_the_next_call(void **state)
{
    fixture *f = *state;
    tyn_device *dev = new_device(f, (device_choice){.threads = 1});
    tyn_context *ctx = new_context(dev);
    driver.fail = 1;
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
    wait_for(ctx);
    assert_int_equal(f->errors, 0); // not by another thread
    assert_int_equal(prepare(f, ctx, true), TYN_ERR_MEMORY);
    assert_int_equal(f->errors, 1);
    assert_int_equal(tyn_context_pending(ctx), 0);
    // The next call tries again.
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
    wait_for(ctx);
    assert_int_equal(prepare(f, ctx, true), TYN_OK);
    assert_int_equal(record(f, ctx, true), TYN_OK);
    expect_picture(f, 0);
    // Likewise in the call.
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    dev = new_device(f, (device_choice){0});
    ctx = new_context(dev);
    driver.fail = 1;
    assert_int_equal(prepare(f, ctx, false), TYN_ERR_MEMORY);
    assert_int_equal(f->errors, 2);
    assert_int_equal(prepare(f, ctx, false), TYN_OK);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    // Numbers of threads that there are not.
    assert_int_equal(try_device(f, (device_choice){.threads = 17}, &dev), TYN_ERR_PARAMS);
    assert_null(dev);
    assert_int_equal(f->errors, 3);
    f->errors = 0;
}

// ---- the blob -----------------------------------------------------------------------------------

static size_t get_blob(tyn_device *dev, char *blob, size_t room)
{
    size_t size = 0;
    assert_int_equal(tyn_device_pipeline_cache(dev, NULL, &size), TYN_OK);
    assert_true(size > HEADER && size <= room);
    size_t written = room;
    assert_int_equal(tyn_device_pipeline_cache(dev, blob, &written), TYN_OK);
    assert_int_equal(written, size);
    return size;
}

// The driver's own cache: what it gives is taken back without a word. That it is of use is the driver's affair.
static void blob_of_the_driver(void **state)
{
    fixture *f = *state;
    static char blob[16 << 20], again[16 << 20];
    size_t size = 0;
    double seconds[2];
    for (int warm = 0; warm < 2; warm++) {
        tyn_device *dev =
            new_device(f, (device_choice){.blob = warm ? blob : NULL, .blob_size = size});
        tyn_context *ctx = new_context(dev);
        assert_int_equal(prepare(f, ctx, false), TYN_OK);
        tyn_pipeline_stats stats;
        tyn_device_pipelines(dev, &stats);
        seconds[warm] = stats.seconds;
        assert_true(stats.compiled > 0 && stats.seconds > 0);
        print_message("%s: %u kernels, %u from the cache, %.4f s\n", warm ? "warm" : "cold",
                      stats.compiled, stats.from_cache, stats.seconds);
        if (!warm) {
            size = get_blob(dev, blob, sizeof blob);
            print_message("%zu bytes\n", size);
        } else {
            assert_true(get_blob(dev, again, sizeof again) >= size);
            assert_true(!stats.from_cache || seconds[1] < 0.5 * seconds[0]);
        }
        tyn_context_destroy(&ctx);
        tyn_device_destroy(&dev);
    }
}

static void blob_round_trip(void **state)
{
    fixture *f = *state;
    char blob[HEADER + sizeof driver.kept + 8];
    driver.cache = true;
    memcpy(driver.kept, "sixteen bytes...", sizeof driver.kept);
    tyn_device *dev = new_device(f, (device_choice){0});
    assert_int_equal(driver.given_size, 0);
    const size_t size = get_blob(dev, blob, sizeof blob);
    assert_int_equal(size, HEADER + sizeof driver.kept);
    // Room for a part: what the driver puts there is whole in itself.
    char part[HEADER + 11];
    size_t written = sizeof part;
    assert_int_equal(tyn_device_pipeline_cache(dev, part, &written), TYN_OK);
    assert_int_equal(written, HEADER + 8);
    // No room.
    written = HEADER - 1;
    assert_int_equal(tyn_device_pipeline_cache(dev, part, &written), TYN_ERR_PARAMS);
    assert_int_equal(written, 0);
    assert_int_equal(tyn_device_pipeline_cache(dev, part, NULL), TYN_ERR_PARAMS);
    assert_int_equal(f->errors, 2);
    f->errors = 0;
    tyn_device_destroy(&dev);

    dev = new_device(f, (device_choice){.blob = part, .blob_size = HEADER + 8});
    assert_int_equal(driver.given_size, 8);
    tyn_device_destroy(&dev);
    memset(driver.given, 0, sizeof driver.given);
    dev = new_device(f, (device_choice){.blob = blob, .blob_size = size});
    assert_int_equal(driver.given_size, sizeof driver.kept);
    assert_memory_equal(driver.given, driver.kept, sizeof driver.kept);
    tyn_context *ctx = new_context(dev);
    assert_int_equal(prepare(f, ctx, false), TYN_OK);
    tyn_pipeline_stats stats;
    tyn_device_pipelines(dev, &stats);
    assert_true(stats.compiled > 0);
    assert_int_equal(stats.from_cache, stats.compiled);
    assert_int_equal(record(f, ctx, false), TYN_OK);
    expect_picture(f, 0);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    // A driver that does not want what was its own.
    driver.refuses = true;
    dev = new_device(f, (device_choice){.blob = blob, .blob_size = size});
    assert_int_equal(f->warnings, 1);
    f->warnings = 0;
    tyn_device_destroy(&dev);
}

static void expect_ignored(fixture *f, const char *what, const char *blob, size_t size)
{
    print_message("%s\n", what);
    f->warnings = 0;
    driver.given_size = 99;
    tyn_device *dev = new_device(f, (device_choice){.blob = blob, .blob_size = size});
    assert_int_equal(driver.given_size, 0); // the driver does not see it
    assert_int_equal(f->warnings, 1);
    tyn_device_destroy(&dev);
    f->warnings = 0;
}

static void damaged_blobs_are_ignored(void **state)
{
    fixture *f = *state;
    enum { SIZE = HEADER + sizeof driver.kept };
    char blob[SIZE + 8] = {0}, bad[SIZE + 8];
    driver.cache = true;
    memcpy(driver.kept, "sixteen bytes...", sizeof driver.kept);
    tyn_device *dev = new_device(f, (device_choice){0});
    assert_int_equal(get_blob(dev, blob, sizeof blob), SIZE);
    tyn_device_destroy(&dev);
    const size_t lengths[] = {1, 7, HEADER - 1, HEADER, HEADER + 1, SIZE - 1, SIZE + 1};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        char *cut = malloc(lengths[i]); // so that what reads on is found
        memcpy(cut, blob, lengths[i]);
        char what[32];
        snprintf(what, sizeof what, "%zu of %d bytes", lengths[i], SIZE);
        expect_ignored(f, what, cut, lengths[i]);
        free(cut);
    }
    for (size_t i = 0; i < SIZE;
         i++) { // magic, version, ids, driver, uuid, size, checksum, content
        memcpy(bad, blob, SIZE);
        bad[i] ^= (char)(1 << i % 8);
        char what[32];
        snprintf(what, sizeof what, "byte %zu", i);
        expect_ignored(f, what, bad, SIZE);
    }
    memset(bad, 0, SIZE);
    expect_ignored(f, "zeros", bad, SIZE);
    dev = new_device(f, (device_choice){.blob = NULL, .blob_size = 100}); // none was given
    tyn_device_destroy(&dev);
    dev = new_device(f, (device_choice){.blob = blob, .blob_size = 0});
    tyn_device_destroy(&dev);
    assert_int_equal(f->warnings, 0);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, reset, silent)
    const struct CMUnitTest tests[] = {
        TEST(threads_compile_and_frames_leave_the_picture_alone),
        TEST(jobs_of_the_host_compile),
        TEST(frames_like_before_go_on),
        TEST(a_call_takes_what_is_queued),
        TEST(destroyed_while_pending),
        TEST(contexts_of_two_threads_share_pipelines),
        TEST(what_fails_beside_is_said_by_the_next_call),
        TEST(blob_of_the_driver),
        TEST(blob_round_trip),
        TEST(damaged_blobs_are_ignored),
    };
    return cmocka_run_group_tests_name("background", tests, set_up, tear_down);
}
