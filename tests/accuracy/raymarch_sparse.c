// raymarch_sparse.c -- the march at a lower resolution (raymarch.sparse) against the march of every pixel: all sample scenes.
//
// In fog-hall most of the difference is the dither of the march of every pixel (docs/measurements.md, "March"). Worst pixels are
// a matter of where nodes fall, at multiples of four pixels of the picture.
#include "bound.h"
#include "gpu_test.h"
#include "picture.h"
#include "sample_scene.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 256 };

typedef struct sparse_case {
    const char *name;
    double change, worst;   // of the picture's light; of a pixel's, at most
    uint32_t width, height; // 0: SIZE
    bool orthographic;      // the same view from far away
    bool twice;             // is one picture like the next?
} sparse_case;

static const sparse_case cases[] = {
    {"cube", 0.0004, 0.06, .twice = true},
    {"smoke", 0.008, 0.19},
    {"cloud", 0.0043, 0.075},
    {"smoke-sky", 0.0016, 0.07},
    {"milk", 0.0014, 0.09},
    {"cloud-sunset", 0.001, 0.055},
    {"plume-contrast", 0.0009, 0.3},
    {"room", 0.0046, 0.085},
    {"lantern", 0.003, 0.16},
    {"fog-hall", 0.0225, 1.5, .twice = true},
    {"vpl-cave", 0.004, 0.33, .twice = true},
    {"many-lights", 0.0038, 0.23, 97, 65, .twice = true},
    {"cornell-smoke", 0.00037, 0.085},
    {"smoke", 0.0086, 0.3, 131, 250, true},
};

// What a case is called in messages.
static const char *title_of(const sparse_case *k)
{
    static char text[64];
    if (k->width) {
        snprintf(text, sizeof text, "%s %u x %u%s", k->name, k->width, k->height,
                 k->orthographic ? ", parallel" : "");
        return text;
    }
    return k->name;
}

// Parallel rays show what is `away` from the camera as large as before.
static void make_parallel(tyn_camera *camera, float away)
{
    camera->projection = TYN_ORTHOGRAPHIC;
    camera->ymag = away * tanf(0.5f * camera->yfov);
}

static float length_of(const float v[3])
{
    return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

// How much of the picture's light changes, and the most of a channel of a pixel, over its value and a tenth of the mean. Rays are
// listed in any order: two pictures are the same all the same.
static void changes(void **state)
{
    gpu_test *t = *state;
    bool good = true;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const sparse_case *k = &cases[i];
        const char *const title = title_of(k);
        tyn_scene *scene = malloc(sizeof *scene);
        sample_scene_load(scene, k->name, t);
        tyn_view view = {.camera = scene->cameras[0],
                         .width = k->width ? k->width : SIZE,
                         .height = k->height ? k->height : SIZE};
        const uint32_t values = 3 * view.width * view.height;
        if (k->orthographic) {
            make_parallel(&view.camera, length_of(view.camera.position));
        }
        const char *settings = "lattice.cells=16 raymarch.sparse=%d";
        picture all, sparse, again = {0};
        char text[64];
        snprintf(text, sizeof text, settings, 0);
        picture_render(&all, t->dev, "pop", scene, &view, text, 0);
        snprintf(text, sizeof text, settings, 1);
        picture_render(&sparse, t->dev, "pop", scene, &view, text, 0);
        if (k->twice) {
            picture_render(&again, t->dev, "pop", scene, &view, text, 0);
        }
        double sum = 0, apart = 0, worst = 0;
        uint32_t differ = 0, twice = 0;
        for (uint32_t j = 0; j < values; j++) {
            sum += (double)all.rgb[j];
        }
        for (uint32_t j = 0; j < values; j++) {
            const double off = fabs((double)sparse.rgb[j] - (double)all.rgb[j]);
            apart += off;
            const double relative = off / ((double)all.rgb[j] + 0.1 * sum / values);
            worst = relative > worst ? relative : worst;
            differ += off > 0;
            twice += again.rgb && memcmp(&sparse.rgb[j], &again.rgb[j], sizeof(float)) != 0;
        }
        print_message("%-24s %.3f %% off, a pixel at most %.1f %%; %.0f %% of the values differ, "
                      "%u from run to run\n",
                      title, 100 * apart / sum, 100 * worst, 100.0 * differ / values, twice);
        good = within(apart / sum, k->change, NULL, "%s, change", title) && good;
        good = within(worst, k->worst, NULL, "%s, worst pixel", title) && good;
        good = good && twice == 0 && differ > values / 30; // else nothing was saved
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
