// threads.c -- two contexts on two threads, each on a device object of its own or both on one VkDevice's, and what is destroyed in
// odd orders: pictures as ever, validation silent.
#include "built_in.h"
#include "rig.h"
#include "skip.h"
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { FRAMES = 6 };

typedef struct worker {
    rig r;
    const char *method;
    double light[FRAMES];
    bool failed;
} worker;

// All of a life: devices, contexts, frames in which something moves, and the end.
static void *live(void *user)
{
    worker *w = user;
    tyn_device *dev = NULL;
    tyn_context *ctx = NULL;
    w->failed = rig_device(&w->r, false, NULL, &dev) != TYN_OK ||
                rig_context(&w->r, dev, w->method, &ctx) != TYN_OK;
    for (int i = 0; !w->failed && i < FRAMES; i++) {
        w->r.view.camera.position[0] = 0.05f * (float)i;
        w->failed = rig_prepare(&w->r, ctx) != TYN_OK;
        const VkCommandBuffer cmd = rig_begin(&w->r, 0);
        w->failed = w->failed || rig_record(&w->r, ctx, cmd) != TYN_OK;
        rig_end(&w->r, 0);
        w->light[i] = rig_light(&w->r);
    }
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    return NULL;
}

// What two threads do at the same time is what each does alone.
static void two_threads(void **state)
{
    (void)state;
    static worker alone[2], both[2];
    static const char *const methods[2] = {"pop", "single"};
    for (int k = 0; k < 2; k++) {
        if (!rig_open(&alone[k].r, true) || !rig_open(&both[k].r, true)) {
            skip_all("the host has no device");
        }
        alone[k].method = both[k].method = methods[k];
        live(&alone[k]);
    }
    pthread_t threads[2];
    for (int k = 0; k < 2; k++) {
        assert_int_equal(pthread_create(&threads[k], NULL, live, &both[k]), 0);
    }
    for (int k = 0; k < 2; k++) {
        pthread_join(threads[k], NULL);
    }
    for (int k = 0; k < 2; k++) {
        assert_false(alone[k].failed || both[k].failed);
        assert_memory_equal(alone[k].light, both[k].light, sizeof alone[k].light);
        assert_true(alone[k].light[0] > 1);
        rig_expect_silence(&alone[k].r);
        rig_expect_silence(&both[k].r);
        rig_close(&alone[k].r);
        rig_close(&both[k].r);
    }
}

// Contexts that were never used, images that go before their context, a context that is made twice on one device.
static void odd_orders(void **state)
{
    (void)state;
    rig r;
    assert_true(rig_open(&r, true));
    tyn_device *first = NULL, *second = NULL;
    tyn_context *a = NULL, *b = NULL, *never = NULL;
    assert_int_equal(rig_device(&r, false, NULL, &first), TYN_OK);
    assert_int_equal(rig_device(&r, false, NULL, &second), TYN_OK);
    assert_int_equal(rig_context(&r, first, "pop", &a), TYN_OK);
    assert_int_equal(rig_context(&r, second, "pop", &b), TYN_OK);
    assert_int_equal(rig_context(&r, first, is_built_in("lpv") ? "lpv" : "single", &never), TYN_OK);
    rig_frame(&r, a);
    const double light = rig_light(&r);
    rig_frame(&r, b);
    assert_true(rig_light(&r) == light);
    rig_resize(&r, RIG_WIDTH, RIG_HEIGHT); // the image that both have drawn to is gone
    tyn_context_destroy(&b);
    tyn_device_destroy(&second);
    rig_frame(&r, a);
    assert_true(rig_light(&r) == light);
    assert_int_equal(rig_prepare(&r, never), TYN_OK); // and never recorded
    tyn_context_destroy(&never);
    rig_frame(&r, a);
    assert_true(rig_light(&r) == light);
    tyn_context_destroy(&a);
    tyn_device_destroy(&first);
    rig_expect_silence(&r);
    rig_close(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(two_threads), cmocka_unit_test(odd_orders)};
    return cmocka_run_group_tests_name("embed_threads", tests, NULL, NULL);
}
