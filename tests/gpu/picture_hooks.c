// picture_hooks.c -- what stands between march and composite: it gets the layers of the march, asked for or not, and outputs
// are made of what it hands on; turned off it changes nothing.
#include "built_in.h"
#include "gpu_test.h"
#include "offline_frame.h"
#include "picture.h"
#include <string.h>
#include <tyndall/extend/method.h>

enum { SIZE = 16, VALUES = 4 * SIZE * SIZE };

// What the hook puts in place of the picture; 0: it is off.
static tyn_output shown;
static uint32_t times_declared;

static uint32_t reads(const tyn_job *job)
{
    (void)job;
    return shown ? TYN_OUTPUT_RADIANCE | shown : 0;
}

static void declare(tyn_graph *g, const tyn_job *job, tyn_picture *p)
{
    (void)g;
    (void)job;
    p->radiance = shown == TYN_OUTPUT_TRANSMITTANCE ? p->transmittance : p->depth;
    times_declared++;
}

static const tyn_picture_hook hook = {"test", reads, declare};

// A box of smoke before a sky, in a sun.
static void set_scene(tyn_scene *scene, tyn_view *view)
{
    tyn_scene_init(scene);
    const tyn_medium medium = grey_medium(1.5f, 0.5f, 0);
    scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
    scene_add_sun(scene, 1, 0, 0, 2, 2, 2);
    view_orthographic(view, (float[]){0.5f, 0.5f, 0.5f}, 0, 0, -1, (float[]){0, 1, 0}, 0.6f, SIZE);
}

// One output of a frame, of four floats or bytes a pixel. Gives the number of the report's warnings.
static uint32_t render(gpu_test *t, const char *method, uint32_t outputs, tyn_output wanted,
                       void *pixels, size_t size)
{
    tyn_scene scene;
    tyn_view view = {0};
    set_scene(&scene, &view);
    view.outputs = outputs;
    view.num_samples = 1;
    tyn_offline *off = scene_open(t->dev, method, NULL);
    if (shown == TYN_OUTPUT_DEPTH) { // which is infinite where there is nothing
        const tyn_result made = tyn_offline_frame(off, &scene, &view, false);
        assert_int_equal(made, TYN_OK);
    } else {
        offline_frame(off, &scene, &view);
    }
    memcpy(pixels, tyn_offline_output(off, wanted), size);
    tyn_report report;
    tyn_offline_report(off, &report);
    const uint32_t warnings = report.num_warnings;
    tyn_offline_destroy(&off);
    tyn_scene_finish(&scene);
    assert_int_equal(tyn_device_validation_messages(t->dev), 0);
    return warnings;
}

static const char *const marching[] = {"pop", "pop-paper", "lpv", "single", "constellation"};

static void layers_are_handed_on(void **state)
{
    gpu_test *t = *state;
    static const tyn_output layers[] = {TYN_OUTPUT_TRANSMITTANCE, TYN_OUTPUT_DEPTH};
    for (size_t m = 0; m < sizeof marching / sizeof *marching; m++) {
        for (size_t l = 0; l < 2 && is_built_in(marching[m]); l++) {
            static float expected[VALUES], plain[VALUES], seen[VALUES];
            shown = 0;
            render(t, marching[m], TYN_OUTPUT_RADIANCE | layers[l], layers[l], expected,
                   sizeof expected);
            render(t, marching[m], TYN_OUTPUT_RADIANCE, TYN_OUTPUT_RADIANCE, plain, sizeof plain);
            assert_int_equal(times_declared, 0);
            shown = layers[l];
            render(t, marching[m], TYN_OUTPUT_RADIANCE, TYN_OUTPUT_RADIANCE, seen, sizeof seen);
            assert_memory_equal(seen, expected, sizeof seen);
            assert_memory_not_equal(seen, plain, sizeof seen);
            assert_true(times_declared > 0);
            times_declared = 0;
        }
    }
    shown = 0;
}

static void display_follows(void **state)
{
    gpu_test *t = *state;
    static uint8_t plain[VALUES], seen[VALUES];
    render(t, "single", TYN_OUTPUT_DISPLAY, TYN_OUTPUT_DISPLAY, plain, sizeof plain);
    shown = TYN_OUTPUT_TRANSMITTANCE;
    render(t, "single", TYN_OUTPUT_DISPLAY, TYN_OUTPUT_DISPLAY, seen, sizeof seen);
    shown = 0;
    const size_t corner = 0, middle = 4 * (SIZE / 2 * SIZE + SIZE / 2);
    // Beside the box transmittance is 1, of which the curve makes .8 of white; within it is e^-2.
    assert_true(plain[corner] == 0 && seen[corner] > 200);
    assert_true(seen[middle] > 60 && seen[middle] < 140);
}

static void path_does_not_march(void **state)
{
    gpu_test *t = *state;
    static float plain[VALUES], seen[VALUES];
    const uint32_t before =
        render(t, "path", TYN_OUTPUT_RADIANCE, TYN_OUTPUT_RADIANCE, plain, sizeof plain);
    shown = TYN_OUTPUT_TRANSMITTANCE;
    const uint32_t after =
        render(t, "path", TYN_OUTPUT_RADIANCE, TYN_OUTPUT_RADIANCE, seen, sizeof seen);
    shown = 0;
    assert_memory_equal(plain, seen, sizeof seen);
    assert_int_equal(after, before + 1);
}

static int set_up(void **state)
{
    const int result = gpu_setup(state);
    return result ? result : tyn_picture_hook_register(&hook, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_are_handed_on),
        cmocka_unit_test(display_follows),
        cmocka_unit_test(path_does_not_march),
    };
    return cmocka_run_group_tests_name("picture_hooks", tests, set_up, gpu_teardown);
}
