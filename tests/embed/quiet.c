// quiet.c -- what `record` asks of Vulkan: it submits nothing, waits for nothing, and makes and allocates nothing.
#include "rig.h"
#include "skip.h"
#include "vulkan_tap.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

static void expect_quiet(const char *what, const char *method)
{
    const tap_counts c = tap_since();
    print_message("%-12s %-10s calls that may fail %3u, commands %4u\n", method, what, c.calls,
                  c.commands);
    assert_int_equal(c.creates, 0);
    assert_int_equal(c.memory, 0);
    assert_int_equal(c.submits, 0);
    assert_int_equal(c.waits, 0);
    assert_int_equal(c.frees, 0);
}

static void record_is_quiet(void **state)
{
    (void)state;
    rig r;
    if (!rig_open(&r, false)) {
        skip_all("the host has no device");
    }
    tyn_device *dev = NULL;
    assert_int_equal(rig_device(&r, true, NULL, &dev), TYN_OK);
    static const char *const methods[] = {"pop", "single"};
    for (size_t m = 0; m < sizeof methods / sizeof methods[0]; m++) {
        tyn_context *ctx = NULL;
        assert_int_equal(rig_context(&r, dev, methods[m], &ctx), TYN_OK);
        tap_clear();
        assert_int_equal(rig_prepare(&r, ctx), TYN_OK);
        assert_true(tap_since().creates > 20 && tap_since().memory > 0); // the tap hears
        for (int frame = 0; frame < 4; frame++) {
            r.view.camera.position[0] = frame < 2 ? 0 : 0.1f * (float)frame;
            const VkCommandBuffer cmd = rig_begin(&r, 0);
            tap_clear();
            assert_int_equal(rig_record(&r, ctx, cmd), TYN_OK);
            expect_quiet(frame == 0 ? "first" : frame == 1 ? "unchanged" : "moved", methods[m]);
            rig_end(&r, 0);
        }
        assert_true(rig_light(&r) > 1);
        tyn_context_destroy(&ctx);
    }
    tyn_device_destroy(&dev);
    rig_expect_silence(&r);
    rig_close(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(record_is_quiet)};
    return cmocka_run_group_tests_name("embed_quiet", tests, NULL, NULL);
}
