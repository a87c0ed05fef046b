// lost.c -- a submission fails and the device is lost: what was recorded for it is forgotten, nothing waits for it, one line is
// logged for the first call that the device refuses, and all can be destroyed; or the device lives and draws the same picture.
#include "offline_frame.h"
#include "rig.h"
#include "skip.h"
#include "states.h"
#include "vulkan_tap.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/offline.h>
#include <unistd.h>
#include <cmocka.h>

enum { PATIENCE = 60 }; // seconds until what waits for ever ends the test

typedef struct losing {
    rig r;
    tyn_device *dev;
    tyn_context *ctx;
    PFN_vkQueueSubmit2 submit; // through the tap
    void *expected;            // the picture without the lamp
} losing;

// One device for all cases: its kernels are compiled once.
static int open_losing(void **state)
{
    losing *l = *state = calloc(1, sizeof *l);
    if (!rig_open(&l->r, true)) {
        skip_all("the host has no device");
    }
    assert_int_equal(rig_device(&l->r, true, NULL, &l->dev), TYN_OK);
    const host *h = &l->r.host;
    const PFN_vkGetInstanceProcAddr tapped = tap_open(h->get_instance_proc_addr);
    const PFN_vkGetDeviceProcAddr get =
        (PFN_vkGetDeviceProcAddr)tapped(h->instance, "vkGetDeviceProcAddr");
    l->submit = (PFN_vkQueueSubmit2)get(h->device, "vkQueueSubmit2");
    return 0;
}

static int close_losing(void **state)
{
    losing *l = *state;
    rig_close(&l->r);
    free(l->expected);
    free(l);
    return 0;
}

static void shine(rig *r, bool on)
{
    static const float colors[2][3] = {{0, 0, 0}, {0.5f, 0.4f, 0.3f}};
    memcpy(r->scene.lights[1].color, colors[on], sizeof colors[on]);
}

static int begin_case(void **state)
{
    losing *l = *state;
    alarm(PATIENCE);
    l->r.errors = 0;
    l->r.quiet = false;
    assert_int_equal(rig_context(&l->r, l->dev, "single", &l->ctx), TYN_OK);
    shine(&l->r, false);
    rig_frame(&l->r, l->ctx);
    assert_true(rig_light(&l->r) > 0.1);
    l->expected = realloc(l->expected, l->r.picture.size);
    memcpy(l->expected, l->r.picture.data, l->r.picture.size);
    shine(&l->r, true);
    rig_frame(&l->r, l->ctx);
    rig_expect_silence(&l->r);
    l->r.quiet = true;
    return 0;
}

static int end_case(void **state)
{
    losing *l = *state;
    tap_fail(0, VK_SUCCESS, false);
    tyn_context_destroy(&l->ctx);
    assert_int_equal(l->r.host.messages, 0);
    alarm(0);
    return 0;
}

// A lamp goes out while a frame is under way, so that something waits to be destroyed; the submission of the next frame fails
// with `error`, as do all calls after it of a device that is lost.
static void fail_a_submission(losing *l, VkResult error)
{
    rig *r = &l->r;
    VkCommandBuffer cmd = rig_begin(r, 0);
    assert_int_equal(rig_record(r, l->ctx, cmd), TYN_OK);
    host_submit(&r->host, 0);
    shine(r, false);
    assert_int_equal(rig_prepare(r, l->ctx), TYN_OK);
    cmd = rig_begin(r, 1);
    assert_int_equal(rig_record(r, l->ctx, cmd), TYN_OK);
    assert_int_equal(r->host.vk.EndCommandBuffer(cmd), VK_SUCCESS);
    tap_clear();
    tap_fail(1, error, error == VK_ERROR_DEVICE_LOST);
    const VkSubmitInfo2 info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
        .commandBufferInfoCount = 1,
        .pCommandBufferInfos =
            &(VkCommandBufferSubmitInfo){.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                         .commandBuffer = cmd},
    };
    assert_int_equal(l->submit(r->host.queue, 1, &info, VK_NULL_HANDLE), error);
    host_wait(&r->host, 0); // the GPU is done with what came before
    tyn_context_forget(l->ctx);
}

static void the_device_lives(void **state)
{
    losing *l = *state;
    fail_a_submission(l, VK_ERROR_OUT_OF_DEVICE_MEMORY);
    rig_frame(&l->r, l->ctx);
    assert_memory_equal(l->r.picture.data, l->expected, l->r.picture.size);
    assert_int_equal(l->r.errors, 0);
}

static void the_device_is_lost(void **state)
{
    losing *l = *state;
    fail_a_submission(l, VK_ERROR_DEVICE_LOST);
    assert_int_equal(l->r.errors, 0); // the host's own failure
    assert_int_equal(rig_prepare(&l->r, l->ctx), TYN_ERR_DEVICE);
    assert_int_equal(l->r.errors, 1);
    assert_non_null(strstr(l->r.last_error, "device lost"));
    tyn_context_destroy(&l->ctx);
    assert_int_equal(tap_since().waits, 0);
    assert_int_equal(l->r.errors, 1);
}

// The last: the device goes as well.
static void destroyed_at_once(void **state)
{
    losing *l = *state;
    fail_a_submission(l, VK_ERROR_DEVICE_LOST);
    tyn_context_destroy(&l->ctx);
    tyn_device_destroy(&l->dev);
    assert_int_equal(tap_since().waits, 0);
    assert_int_equal(l->r.errors, 0);
    assert_int_equal(tap_live(), 0);
}

// Submissions of Tyndall's own.
static void offline(void **state)
{
    (void)state;
    rig r;
    if (!rig_open(&r, true)) {
        skip_all("the host has no device");
    }
    alarm(PATIENCE);
    tyn_device *dev = NULL;
    tyn_offline *off = NULL;
    assert_int_equal(tyn_device_open(tyn_device_open_params(.log = rig_log(&r),
                                                            .get_instance_proc_addr = tap_open(
                                                                r.host.get_instance_proc_addr)),
                                     &dev),
                     TYN_OK);
    assert_int_equal(tyn_offline_create(
                         dev, tyn_offline_params(.method = "single", .settings = r.settings), &off),
                     TYN_OK);
    tyn_view view = r.view;
    view.outputs = TYN_OUTPUT_RADIANCE;
    offline_frame(off, &r.scene, &view);
    r.quiet = true;
    // The calls of a frame one by one, until it is the submission that fails.
    bool found = false;
    for (uint32_t call = 1; !found; call++) {
        const uint32_t lines = r.errors;
        tap_clear();
        tap_fail(call, VK_ERROR_DEVICE_LOST, true);
        view.camera.position[0] += 0.01f;
        assert_int_equal(tyn_offline_frame(off, &r.scene, &view, false), TYN_ERR_DEVICE);
        found = !strcmp(tap_failed(), "vkQueueSubmit2");
        tap_fail(0, VK_SUCCESS, false);
        if (found) {
            assert_int_equal(r.errors, lines + 1);
            assert_int_equal(tap_since().waits, 0);
        } else {
            offline_frame(off, &r.scene, &view);
        }
    }
    tyn_offline_destroy(&off);
    tyn_device_destroy(&dev);
    assert_int_equal(tap_live(), 0);
    alarm(0);
    rig_close(&r);
}

int main(void)
{
#define CASE(name) cmocka_unit_test_setup_teardown(name, begin_case, end_case)
    const struct CMUnitTest tests[] = {CASE(the_device_lives), CASE(the_device_is_lost),
                                       CASE(destroyed_at_once), cmocka_unit_test(offline)};
    return run_cases(tests, open_losing, close_losing);
}
