// loaded_module.c -- a module that is loaded as a plugin makes the bytes of the one that is linked in.
//
// usage: test_gpu_loaded_module METHOD MODULE.so LINKED; LINKED is test_gpu_linked_module, this file with all modules, which
// writes its pixels to stdout.
#include "gpu_test.h"
#include "offline_frame.h"
#include "path_run.h"
#include "registry/built_in.h"
#include <stdio.h>
#include <string.h>

enum { SIZE = 32, VALUES = 4 * SIZE * SIZE };

static const char *method;

// A box under a sun, a lamp and a sky.
static void render(tyn_device *dev, float pixels[VALUES])
{
    tyn_scene scene;
    tyn_view view = {.outputs = TYN_OUTPUT_RADIANCE};
    const tyn_medium medium = grey_medium(6, 1, 0.5f);
    tyn_scene_init(&scene);
    scene_add_box(&scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, (uint32_t[]){1, 1, 1},
                  NULL);
    scene_add_sun(&scene, 0.3f, -0.8f, 0.5f, 1, 1, 1);
    scene_add_lamp(&scene, (float[]){0.4f, 1.3f, 0.5f}, 2);
    scene_set_sky(&scene, 0.2f);
    view_perspective(&view, (float[]){2.4f, 0.9f, 1.7f}, (float[]){0.5f, 0.5f, 0.5f}, 0.36f, SIZE);
    tyn_offline *off = scene_open(dev, method, NULL);
    offline_frame(off, &scene, &view);
    memcpy(pixels, tyn_offline_output(off, TYN_OUTPUT_RADIANCE), VALUES * sizeof *pixels);
    tyn_offline_destroy(&off);
    tyn_scene_finish(&scene);
}

#ifdef CORE_ALONE
static const char *module, *linked;

// In place of the library's list.
const tyn_plugin *const tyn_built_in[] = {&tyn_built_in_core, NULL};
const char tyn_left_out[] = "";

static void same_bytes(void **state)
{
    gpu_test *t = *state;
    static float loaded[VALUES], expected[VALUES + 1];
    tyn_method_info info;
    assert_false(tyn_method_named(method, &info));
    assert_int_equal(tyn_plugin_load(module, NULL), TYN_OK);
    assert_true(tyn_method_named(method, &info));
    assert_string_equal(info.plugin, method);
    render(t->dev, loaded);
    char command[8192];
    snprintf(command, sizeof command, "'%s' %s", linked, method);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    assert_int_equal(fread(expected, sizeof *expected, VALUES + 1, pipe), VALUES);
    assert_int_equal(pclose(pipe), 0);
    assert_memory_equal(loaded, expected, sizeof loaded);
}

int main(int argc, char **argv)
{
    if (argc != 4) {
        fprintf(stderr, "usage: test_gpu_loaded_module METHOD MODULE.so LINKED\n");
        return 2;
    }
    method = argv[1];
    module = argv[2];
    linked = argv[3];
    const struct CMUnitTest tests[] = {cmocka_unit_test(same_bytes)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
#else
int main(int argc, char **argv)
{
    static float pixels[VALUES];
    void *state = NULL;
    method = argc > 1 ? argv[1] : "";
    if (gpu_setup(&state)) {
        return 1;
    }
    render(((gpu_test *)state)->dev, pixels);
    const bool written = fwrite(pixels, sizeof pixels, 1, stdout) == 1;
    return gpu_teardown(&state) || !written;
}
#endif
