// raymarch_sparse.c -- the march at a lower resolution (raymarch.sparse) against the march of every pixel: all sample scenes.
//
// In fog-hall most of the difference is the dither of the march of every pixel (docs/measurements.md, "March").
#include "bound.h"
#include "gpu_test.h"
#include "picture.h"
#include "sample_scene.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 256, VALUES = 3 * SIZE * SIZE };

static const struct sparse_case {
    const char *name;
    double change, worst; // of the picture's light; of a pixel's, at most
} cases[] = {
    {"cube", 0.0004, 0.06},          {"smoke", 0.008, 0.19},    {"cloud", 0.0043, 0.075},
    {"smoke-sky", 0.0016, 0.07},     {"milk", 0.0014, 0.055},   {"cloud-sunset", 0.001, 0.055},
    {"plume-contrast", 0.0009, 0.3}, {"room", 0.0046, 0.085},   {"lantern", 0.003, 0.16},
    {"fog-hall", 0.0225, 1.5},       {"vpl-cave", 0.004, 0.33},
};

// How much of the picture's light changes, and the most of a channel of a pixel, over its value and a tenth of the mean. Rays are
// listed in any order: two pictures are the same all the same.
static void changes(void **state)
{
    gpu_test *t = *state;
    bool good = true;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct sparse_case *k = &cases[i];
        tyn_scene *scene = malloc(sizeof *scene);
        sample_scene_load(scene, k->name, t);
        tyn_view view = {.camera = scene->cameras[0], .width = SIZE, .height = SIZE};
        const char *settings = "lattice.cells=16 raymarch.sparse=%d";
        picture all, sparse, again;
        char text[64];
        snprintf(text, sizeof text, settings, 0);
        picture_render(&all, t->dev, "pop", scene, &view, text, 0);
        snprintf(text, sizeof text, settings, 1);
        picture_render(&sparse, t->dev, "pop", scene, &view, text, 0);
        picture_render(&again, t->dev, "pop", scene, &view, text, 0);
        double sum = 0, apart = 0, worst = 0;
        uint32_t differ = 0, twice = 0;
        for (uint32_t j = 0; j < VALUES; j++) {
            sum += (double)all.rgb[j];
        }
        for (uint32_t j = 0; j < VALUES; j++) {
            const double off = fabs((double)sparse.rgb[j] - (double)all.rgb[j]);
            apart += off;
            const double relative = off / ((double)all.rgb[j] + 0.1 * sum / VALUES);
            worst = relative > worst ? relative : worst;
            differ += off > 0;
            twice += memcmp(&sparse.rgb[j], &again.rgb[j], sizeof(float)) != 0;
        }
        print_message("%-14s %.3f %% off, a pixel at most %.1f %%; %.0f %% of the values differ, "
                      "%u from run to run\n",
                      k->name, 100 * apart / sum, 100 * worst, 100.0 * differ / VALUES, twice);
        good = within(apart / sum, k->change, NULL, "%s, change", k->name) && good;
        good = within(worst, k->worst, NULL, "%s, worst pixel", k->name) && good;
        good = good && twice == 0 && differ > VALUES / 30; // else nothing was saved
        picture_free(&again);
        picture_free(&sparse);
        picture_free(&all);
        tyn_scene_finish(scene);
        free(scene);
    }
    assert_true(good);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(changes)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
