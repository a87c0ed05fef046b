// failures.c -- every call of Vulkan that can fail does, one at a time: an error and a line of the log; then the same call
// succeeds and the picture is the same bit by bit, or all is destroyed; nothing is left behind, and the layers are silent.
//
// A trial costs a frame or more, so each step tries calls evenly spaced; TYN_FAIL_ALL=1 tries them all, TYN_FAIL_STEP=NAME of
// that step, TYN_FAIL_SHARE=2/5 the second fifth of them.
#include "rig.h"
#include "skip.h"
#include "states.h"
#include "vulkan_tap.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <tyndall/offline.h>
#include <cmocka.h>

enum { MAX_JOBS = 256, TRIALS = 3 }; // of each step and error, in the short run

typedef struct trial {
    rig r;
    const char *method;
    PFN_vkGetInstanceProcAddr tapped;
    tyn_device *dev, *warm; // warm: has its kernels
    tyn_context *ctx;
    tyn_offline *off;
    VkCommandBuffer cmd;
    struct {
        void (*run)(void *job);
        void *job;
    } jobs[MAX_JOBS];
    uint32_t num_jobs;
    void *blob;
    size_t blob_size;
    void *expected; // the picture, of `bytes`
    size_t bytes;
} trial;

// ---- devices ------------------------------------------------------------------------------------

static void queue_job(void *user, void (*run)(void *job), void *job)
{
    trial *t = user;
    assert_true(t->num_jobs < MAX_JOBS);
    t->jobs[t->num_jobs].run = run;
    t->jobs[t->num_jobs++].job = job;
}

static void run_jobs(trial *t)
{
    for (uint32_t i = 0; i < t->num_jobs; i++) {
        t->jobs[i].run(t->jobs[i].job);
    }
    t->num_jobs = 0;
}

static tyn_result create_device(trial *t, tyn_jobs jobs)
{
    tyn_device_params params = {.struct_size = sizeof params, .log = rig_log(&t->r), .jobs = jobs};
    host_describe(&t->r.host, &params);
    params.get_instance_proc_addr = t->tapped;
    return tyn_device_create(&params, &t->dev);
}

static tyn_result make_device(trial *t)
{
    return create_device(t, (tyn_jobs){0});
}

static tyn_result make_device_with_jobs(trial *t)
{
    return create_device(t, (tyn_jobs){queue_job, t});
}

// ---- steps --------------------------------------------------------------------------------------

static void nothing(trial *t)
{
    (void)t;
}

static void with_device(trial *t)
{
    assert_int_equal(make_device(t), TYN_OK);
}

static void with_context(trial *t)
{
    if (!t->dev) {
        t->dev = t->warm;
    }
    assert_int_equal(rig_context(&t->r, t->dev, t->method, &t->ctx), TYN_OK);
}

static void with_new_device(trial *t)
{
    with_device(t);
    with_context(t);
}

static void with_jobs(trial *t)
{
    assert_int_equal(make_device_with_jobs(t), TYN_OK);
    with_context(t);
}

static void prepared(trial *t)
{
    with_context(t);
    assert_int_equal(rig_prepare(&t->r, t->ctx), TYN_OK);
}

static void begun(trial *t)
{
    prepared(t);
    t->cmd = rig_begin(&t->r, 0);
}

static void resized(trial *t)
{
    with_context(t);
    t->r.view.width = RIG_WIDTH - 8; // kept are the grids and maps
    rig_resize(&t->r, RIG_WIDTH - 8, RIG_HEIGHT);
    rig_frame(&t->r, t->ctx);
    rig_resize(&t->r, RIG_WIDTH, RIG_HEIGHT);
}

static void with_lamp_more(trial *t)
{
    with_context(t);
    t->r.scene.num_lights = 1;
    rig_frame(&t->r, t->ctx);
    t->r.scene.num_lights = 2;
}

static tyn_result create_context(trial *t)
{
    t->dev = t->warm;
    return rig_context(&t->r, t->dev, t->method, &t->ctx);
}

static tyn_result prepare(trial *t)
{
    return rig_prepare(&t->r, t->ctx);
}

static tyn_result record(trial *t)
{
    return rig_record(&t->r, t->ctx, t->cmd);
}

static tyn_result prepare_beside(trial *t)
{
    host_image copy = t->r.color;
    const tyn_image lent = host_lend(&copy, drawn_to);
    for (int i = 0; i < 4; i++) {
        const tyn_result result =
            tyn_context_prepare(t->ctx, tyn_frame(.scene = &t->r.scene, .view = &t->r.view,
                                                  .color = &lent, .background = true));
        run_jobs(t);
        if (result != TYN_PENDING) {
            return result;
        }
    }
    return TYN_PENDING;
}

static tyn_result read_cache(trial *t)
{
    t->dev = t->warm;
    size_t size = 0;
    tyn_result result = tyn_device_pipeline_cache(t->dev, NULL, &size);
    t->blob = realloc(t->blob, size ? size : 1);
    return result == TYN_OK ? tyn_device_pipeline_cache(t->dev, t->blob, &size) : result;
}

static void finish_frame(trial *t)
{
    if (!t->cmd) {
        t->cmd = rig_begin(&t->r, 0);
        assert_int_equal(rig_record(&t->r, t->ctx, t->cmd), TYN_OK);
    }
    rig_end(&t->r, 0);
    t->cmd = VK_NULL_HANDLE;
}

static void frame(trial *t)
{
    if (!t->ctx) {
        with_context(t);
    }
    rig_frame(&t->r, t->ctx);
}

static tyn_result open_own(trial *t)
{
    return tyn_device_open(
        tyn_device_open_params(.log = rig_log(&t->r), .get_instance_proc_addr = t->tapped),
        &t->dev);
}

static void with_warm(trial *t)
{
    t->dev = t->warm;
}

static tyn_result create_offline(trial *t)
{
    return tyn_offline_create(
        t->dev, tyn_offline_params(.method = t->method, .settings = t->r.settings), &t->off);
}

static void with_offline(trial *t)
{
    with_warm(t);
    assert_int_equal(create_offline(t), TYN_OK);
}

static tyn_view offline_view(const trial *t)
{
    static const float points[1][3] = {{0.2f, 0.1f, 0}};
    tyn_view view = t->r.view;
    view.outputs = TYN_OUTPUT_RADIANCE;
    if (strcmp(t->method, "single")) { // which has no probes
        view.outputs |= TYN_OUTPUT_PROBE;
        view.points = points;
        view.num_points = 1;
    }
    return view;
}

static tyn_result render_offline(trial *t)
{
    const tyn_view view = offline_view(t);
    return tyn_offline_frame(t->off, &t->r.scene, &view, false);
}

static void offline_picture(trial *t)
{
    if (!t->off) {
        assert_int_equal(create_offline(t), TYN_OK);
    }
    if (!tyn_offline_output(t->off, TYN_OUTPUT_RADIANCE)) {
        assert_int_equal(render_offline(t), TYN_OK);
    }
    memcpy(t->r.picture.data, tyn_offline_output(t->off, TYN_OUTPUT_RADIANCE), t->bytes);
}

typedef struct step {
    const char *name, *method; // method: of the long run; else "single", which has few kernels
    void (*before)(trial *t);
    tyn_result (*call)(trial *t);
    void (*picture)(trial *t); // after the call; NULL: none
    bool retries;              // by itself, so that one failure is no error
    uint32_t least;            // calls there are at least
    uint32_t
        costly; // each trial compiles kernels anew: in the short run this call alone fails, or none
} step;

static const step steps[] = {
    {"device", "single", nothing, make_device, NULL, false, 4},
    {"cache", "single", nothing, read_cache, NULL, false, 2},
    {"context", "pop", nothing, create_context, frame, false, 0},
    {"kernels", "single", with_new_device, prepare, NULL, false, 40, 2},
    {"beside", "single", with_jobs, prepare_beside, NULL, false, 40, UINT32_MAX},
    {"prepare", "pop", with_context, prepare, finish_frame, false, 20},
    {"record", "pop", begun, record, finish_frame, false, 8},
    {"resize", "pop", resized, prepare, finish_frame, true, 4},
    {"lamp", "pop", with_lamp_more, prepare, finish_frame, true, 1},
};

// Of devices that Tyndall opens.
static const step own_steps[] = {
    {"open", "single", nothing, open_own, NULL, false, 6},
    {"offline", "single", with_warm, create_offline, NULL, false, 3},
    {"rendering", "pop", with_offline, render_offline, offline_picture, false, 20},
};

static void clear_away(trial *t)
{
    tap_fail(0, VK_SUCCESS, false);
    if (t->cmd) {
        rig_end(&t->r, 0); // holds what was appended before the failure
        t->cmd = VK_NULL_HANDLE;
    }
    tyn_offline_destroy(&t->off);
    tyn_context_destroy(&t->ctx);
    if (t->dev != t->warm) {
        tyn_device_destroy(&t->dev);
    }
    t->dev = NULL;
    run_jobs(t);
}

// Nothing, or a call without which Tyndall does as well.
static bool may_do_without(void)
{
    return !strcmp(tap_failed(), "vkGetQueryPoolResults") ||
           !strcmp(tap_failed(), "vkEnumerateDeviceExtensionProperties");
}

static void fail_once(trial *t, const step *s, uint32_t number, VkResult error)
{
    const int before = tap_live();
    s->before(t);
    const uint32_t lines = t->r.errors;
    tap_clear();
    const bool lost = error == VK_ERROR_DEVICE_LOST;
    tap_fail(number, error, lost);
    const tyn_result result = s->call(t);
    const char *failed = tap_failed();
    const bool recovered = result == TYN_OK && (s->retries && !lost);
    if (!*failed || (result >= TYN_OK && !recovered && !may_do_without()) ||
        (result != TYN_OK && t->r.errors == lines)) {
        fail_msg("%s: call %u, '%s' with VkResult %d: the result is %d, %u lines", s->name, number,
                 failed, error, result, t->r.errors - lines);
    }
    assert_true(result == TYN_OK || result == (lost ? TYN_ERR_DEVICE : TYN_ERR_MEMORY));
    tap_fail(0, VK_SUCCESS, false);
    if (!lost) {
        if (result != TYN_OK) {
            assert_int_equal(s->call(t), TYN_OK);
        }
        if (s->picture) {
            s->picture(t);
            assert_memory_equal(t->r.picture.data, t->expected, t->bytes);
        }
    }
    clear_away(t);
    if (tap_live() != before) {
        fail_msg("%s: call %u, %s with VkResult %d: %d objects are left", s->name, number, failed,
                 error, tap_live() - before);
    }
}

// Numbers first, first + stride, ... of the calls to try.
typedef struct choice {
    bool all;
    uint32_t part, parts; // of `all`
} choice;

static choice read_choice(void)
{
    choice c = {.all = getenv("TYN_FAIL_ALL"), .part = 1, .parts = 1};
    const char *share = getenv("TYN_FAIL_SHARE");
    if (share && (sscanf(share, "%u/%u", &c.part, &c.parts) != 2 || !c.part || c.part > c.parts)) {
        fail_msg("TYN_FAIL_SHARE is '%s'; it must be like 2/5", share);
    }
    return c;
}

// Lets the chosen ones of `calls` calls fail in turn; how many those were.
static uint32_t fail_chosen(trial *t, const step *s, const choice *c, uint32_t calls)
{
    static const VkResult errors[] = {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY,
                                      VK_ERROR_DEVICE_LOST};
    if (s->costly && !c->all) {
        fail_once(t, s, s->costly, errors[0]);
        return 1;
    }
    const uint32_t stride = c->all ? c->parts : calls > TRIALS ? (calls + TRIALS - 1) / TRIALS : 1;
    uint32_t tried = 0;
    for (uint32_t e = 0; e < 3; e++) {
        for (uint32_t n = c->all ? c->part : 1 + e % stride; n <= calls; n += stride, tried++) {
            fail_once(t, s, n, errors[e]);
        }
    }
    return tried;
}

static void fail_every_call(const step *list, size_t num, bool of_host)
{
    trial t = {0};
    if (!rig_open(&t.r, true)) {
        skip_all("the host has no device");
    }
    rig *r = &t.r;
    r->quiet = true;
    const choice chosen = read_choice();
    const char *only = getenv("TYN_FAIL_STEP");
    uint32_t total = 0, tried = 0;
    t.bytes = r->picture.size;
    t.expected = malloc(t.bytes);
    t.tapped = tap_open(r->host.get_instance_proc_addr);
    assert_int_equal(of_host ? make_device(&t) : open_own(&t), TYN_OK);
    t.warm = t.dev;
    for (size_t i = 0; i < num; i++) {
        const step *s = &list[i];
        if ((only && strcmp(only, s->name)) || (s->costly == UINT32_MAX && !chosen.all)) {
            continue;
        }
        t.method = chosen.all ? s->method : "single";
        uint32_t calls = 0;
        for (int run = 0; run < (s->costly ? 1 : 2);
             run++) { // the first makes kernels for all that use `warm`
            t.dev = NULL;
            s->before(&t);
            tap_clear();
            const tyn_result result = s->call(&t);
            if (result != TYN_OK) {
                fail_msg("%s: %d, %s", s->name, result, r->last_error);
            }
            calls = tap_since().calls;
            if (s->picture) {
                s->picture(&t);
                memcpy(t.expected, r->picture.data, t.bytes);
                assert_true(rig_light(r) > 0.1);
            }
            clear_away(&t);
        }
        rig_expect_silence(r);
        assert_true(calls >= s->least);
        const time_t start = time(NULL);
        const uint32_t trials = fail_chosen(&t, s, &chosen, calls);
        print_message("%-10s %4u calls that may fail, %4u trials, %ld s\n", s->name, calls, trials,
                      (long)(time(NULL) - start));
        total += calls;
        tried += trials;
        r->errors = 0;
    }
    print_message("%u calls, %u trials\n", total, tried);
    tyn_device_destroy(&t.warm);
    assert_int_equal(tap_live(), 0);
    free(t.expected);
    free(t.blob);
    rig_close(r);
}

static void calls_on_a_device_of_the_host_fail(void **state)
{
    (void)state;
    fail_every_call(steps, sizeof steps / sizeof *steps, true);
}

static void calls_on_a_device_of_our_own_fail(void **state)
{
    (void)state;
    fail_every_call(own_steps, sizeof own_steps / sizeof *own_steps, false);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(calls_on_a_device_of_the_host_fail),
                                       cmocka_unit_test(calls_on_a_device_of_our_own_fail)};
    return cmocka_run_group_tests_name("embed_failures", tests, NULL, NULL);
}
