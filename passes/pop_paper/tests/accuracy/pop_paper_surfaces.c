// pop_paper_surfaces.c -- `pop-paper` where surfaces cast shadows, against the stored references of the bench (`path`):
// its grids start in the light that the shadow maps leave. Without that the pictures are 19 times too bright.
#include "bound.h"
#include "gpu_test.h"
#include "picture.h"
#include "sample_scene.h"
#include "todo.h"
#include <tyndall/io.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 128 };

static void load_reference(picture *p, const char *name, const gpu_test *t)
{
    char path[512];
    tyn_image_file file;
    snprintf(path, sizeof path, TYN_TEST_DATA "/../../tools/bench/references/%s-128x128.exr", name);
    assert_int_equal(tyn_exr_read(&file, path, &t->log), TYN_OK);
    assert_true(file.width == SIZE && file.height == SIZE);
    *p = (picture){SIZE, SIZE, calloc(3 * SIZE * SIZE, sizeof(float)), NULL};
    for (uint32_t c = 0; c < 3; c++) {
        const float *values =
            tyn_image_file_channel(&file, (const char *const[]){"R", "G", "B"}[c]);
        assert_non_null(values);
        for (uint32_t i = 0; i < SIZE * SIZE; i++) {
            p->rgb[3 * i + c] = values[i];
        }
    }
    tyn_image_file_finish(&file);
}

static void shadowed(void **state)
{
    // What is left comes of light that has turned, which no surface stops (passes/pop_paper/pop-paper.md, "Surfaces").
    static const struct {
        const char *name;
        double error, bias;
        const char *brighter; // why the bias is known to be more
    } scenes[] = {
        {"fog-hall", 0.6, 0.08,
         "since virtual lights carry further reflections, too; less was reflected before"},
        {"vpl-cave", 0.6, 0.6}};
    gpu_test *t = *state;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        tyn_scene scene;
        picture p, reference;
        sample_scene_load(&scene, scenes[i].name, t);
        load_reference(&reference, scenes[i].name, t);
        const tyn_view view = {
            .camera = scene.cameras[0], .width = SIZE, .height = SIZE, .no_background = true};
        picture_render(&p, t->dev, "pop-paper", &scene, &view, NULL, 0);
        const picture_error e = picture_compare(&p, &reference, 8);
        print_message("%s: rel_l1 %.1f %%, bias %+.1f %%\n", scenes[i].name, 100 * e.rel_l1,
                      100 * e.bias);
        assert_true(within(e.rel_l1, scenes[i].error, NULL, "%s", scenes[i].name));
        assert_true(todo_if(scenes[i].brighter,
                            within(fabs(e.bias), scenes[i].bias, NULL, "%s, bias", scenes[i].name),
                            scenes[i].brighter, "%s, bias", scenes[i].name));
        picture_free(&p);
        picture_free(&reference);
        tyn_scene_finish(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(shadowed)};
    setvbuf(stdout, NULL, _IOLBF, 0);
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
