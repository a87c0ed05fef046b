// endurance.c -- memory that stays: frames of a sequence, pictures of other sizes, contexts made and destroyed.
//
// Of each, resident memory after the first tenth is that after the last within 1 %. Short runs by default; TYN_LONG=1 takes
// 2,000 frames, 500 sizes and 200 contexts.
#include "built_in.h"
#include "bound.h"
#include "rig.h"
#include "skip.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include <cmocka.h>

static rig r;

static uint32_t times(uint32_t few, uint32_t all)
{
    return getenv("TYN_LONG") ? all : few;
}

static double resident_mib(void)
{
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%*u %lu", &pages), 1);
    fclose(file);
    return (double)pages * (double)sysconf(_SC_PAGESIZE) / (1 << 20);
}

typedef struct memory {
    double begin, grown; // MiB after the first tenth, and since, over it
} memory;

static void look(memory *m, uint32_t i, uint32_t count, const char *what)
{
    const double now = resident_mib();
    if (i == (count + 9) / 10) {
        m->begin = now;
    }
    if (i == count) {
        m->grown = (now - m->begin) / m->begin;
        print_message("%s: %u, from %.1f to %.1f MiB\n", what, count, m->begin, now);
    }
}

static void expect_flat(const memory *m)
{
    assert_within(m->grown < 0 ? 0 : m->grown, 0.01, BOUND_PROMISE);
}

// Camera, lamp, map and density change in every frame.
static void sequence(void **state)
{
    (void)state;
    static const char *const methods[] = {"pop", "lpv", "constellation"};
    const uint32_t num_methods = getenv("TYN_LONG") ? 3 : 1, count = times(40, 2000);
    for (uint32_t k = 0; k < num_methods && is_built_in(methods[k]); k++) {
        tyn_device *dev = NULL;
        tyn_context *ctx = NULL;
        assert_int_equal(rig_device(&r, false, NULL, &dev), TYN_OK);
        assert_int_equal(rig_context(&r, dev, methods[k], &ctx), TYN_OK);
        memory m = {0};
        for (uint32_t i = 1; i <= count; i++) {
            const float t = 0.1f * (float)i;
            r.view.camera.position[0] = 0.3f * sinf(t);
            r.scene.lights[1].position[0] = 0.8f + 0.1f * sinf(t);
            r.scene.environment.rotation[1] = 0.1f * sinf(t);
            r.scene.environment.rotation[3] = sqrtf(1 - powf(0.1f * sinf(t), 2));
            r.scene.volumes[0].data[500] = 0.1f * (float)(i % 9);
            r.scene.volumes[0].hash = 1 + i;
            rig_frame(&r, ctx);
            look(&m, i, count, methods[k]);
        }
        assert_true(rig_light(&r) > 0);
        tyn_context_destroy(&ctx);
        tyn_device_destroy(&dev);
        expect_flat(&m);
    }
}

static void resizes(void **state)
{
    (void)state;
    const uint32_t count = times(40, 500);
    tyn_device *dev = NULL;
    tyn_context *ctx = NULL;
    assert_int_equal(rig_device(&r, false, NULL, &dev), TYN_OK);
    assert_int_equal(rig_context(&r, dev, "pop", &ctx), TYN_OK);
    memory m = {0};
    for (uint32_t i = 1; i <= count; i++) {
        rig_resize(&r, RIG_WIDTH + i % 7, RIG_HEIGHT + i % 5);
        rig_frame(&r, ctx);
        look(&m, i, count, "sizes");
    }
    rig_resize(&r, RIG_WIDTH, RIG_HEIGHT);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    expect_flat(&m);
}

static void contexts(void **state)
{
    (void)state;
    const uint32_t count = times(10, 200);
    tyn_device *dev = NULL;
    assert_int_equal(rig_device(&r, false, NULL, &dev), TYN_OK);
    memory m = {0};
    for (uint32_t i = 1; i <= count; i++) {
        tyn_context *ctx = NULL;
        assert_int_equal(rig_context(&r, dev, "single", &ctx), TYN_OK);
        rig_frame(&r, ctx);
        tyn_context_destroy(&ctx);
        look(&m, i, count, "contexts");
    }
    tyn_device_destroy(&dev);
    expect_flat(&m);
}

static int open_rig(void **state)
{
    (void)state;
    if (!rig_open(&r, false)) {
        skip_all("the host has no device");
    }
    return 0;
}

static int close_rig(void **state)
{
    (void)state;
    rig_close(&r);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sequence),
        cmocka_unit_test(resizes),
        cmocka_unit_test(contexts),
    };
    return run_cases(tests, open_rig, close_rig);
}
