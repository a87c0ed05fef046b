// record_time.c -- what recording an unchanged frame costs: processor time of the calling thread. The sample scene `smoke` by
// `pop` at 512x512, composited over a picture; the frames are submitted and waited for, so that the caches are as in use.
#include "bound.h"
#include "rig.h"
#include "skip.h"
#include <tyndall/io.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <time.h>
#include <cmocka.h>

enum { SIZE = 512, FRAMES = 101 };
static const double most_ms = 0.3;

static double processor_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void unchanged_frame(void **state)
{
    (void)state;
    rig r;
    if (!rig_open(&r, false)) {
        skip_all("the host has no device");
    }
    rig_resize(&r, SIZE, SIZE);
    tyn_scene_finish(&r.scene);
    tyn_scene_init(&r.scene);
    const tyn_log log = rig_log(&r);
    assert_int_equal(tyn_scene_load(&r.scene, TYN_SMOKE, NULL, &log), TYN_OK);
    if (r.scene.num_cameras) {
        r.view.camera = r.scene.cameras[0];
    }
    tyn_device *dev = NULL;
    tyn_context *ctx = NULL;
    assert_int_equal(rig_device(&r, false, NULL, &dev), TYN_OK);
    assert_int_equal(tyn_context_create(dev, tyn_context_params(.method = "pop"), &ctx), TYN_OK);
    rig_frame(&r, ctx);
    double times[FRAMES];
    for (uint32_t i = 0; i < FRAMES; i++) {
        const VkCommandBuffer cmd = rig_begin(&r, 0);
        const double start = processor_ms();
        assert_int_equal(rig_record(&r, ctx, cmd), TYN_OK);
        times[i] = processor_ms() - start;
        rig_end(&r, 0);
    }
    assert_true(rig_light(&r) > 1);
    qsort(times, FRAMES, sizeof times[0], by_size);
    print_message(
        "recording an unchanged frame: %.3f ms, of %d the quickest %.3f, the slowest %.3f\n",
        times[FRAMES / 2], FRAMES, times[0], times[FRAMES - 1]);
    assert_within(times[FRAMES / 2], most_ms, BOUND_PROMISE);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    rig_expect_silence(&r);
    rig_close(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(unchanged_frame)};
    return cmocka_run_group_tests_name("embed_record_time", tests, NULL, NULL);
}
