// shdom.c -- `shdom` against `path` in homogeneous cubes, what the number of bands does, what is conserved, and what runs.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "path_run.h"
#include "picture.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void make_cube(tyn_scene *scene, float depth, float g)
{
    tyn_medium medium = grey_medium(depth, 0, g);
    tyn_scene_init(scene);
    scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
}

static void cube_view(tyn_view *view)
{
    view_orthographic(view, (float[]){0.5f, 0.5f, 0.5f}, 0.3f, -1, 0.2f, (float[]){0, 0, 1}, 0.8f,
                      32);
}

// ---- pictures against `path` -----------------------------------------------------------------

static void cubes(void **state)
{
    static const struct {
        float depth, g;
        bool sky; // else a sun
        double bounds[3];
    } cases[] = {
        {1, 0, false, {0, 0, 0}},   {4, 0, false, {0, 0, 0}},   {4, 0, true, {0, 0, 0}},
        {4, 0.7f, false, {0, 0, 0}}, {4, 0.9f, false, {0, 0, 0}}, {4, 0.9f, true, {0, 0, 0}},
        {4, -0.5f, false, {0, 0, 0}},
    };
    static const int bands[] = {2, 5, 10};
    gpu_test *t = *state;
    bool near = true;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        tyn_scene scene;
        tyn_view view = {0};
        picture reference, ours;
        make_cube(&scene, cases[i].depth, cases[i].g);
        if (cases[i].sky) {
            scene_set_sky(&scene, 1);
        } else {
            scene_add_sun(&scene, 1, -0.5f, 0.2f, 1, 1, 1);
        }
        cube_view(&view);
        view.no_background = true;
        picture_render(&reference, t->dev, "path", &scene, &view, NULL, path_effort(512));
        for (int k = 0; k < 3; k++) {
            char settings[64];
            snprintf(settings, sizeof settings, "shdom.cells=16 shdom.bands=%d", bands[k]);
            picture_render(&ours, t->dev, "shdom", &scene, &view, settings, 0);
            const picture_error e = picture_compare(&ours, &reference, 8);
            printf("depth %g, g %4.1f, %s, %2d bands: error %5.2f %%, bias %+6.2f %%\n",
                   (double)cases[i].depth, (double)cases[i].g, cases[i].sky ? "sky" : "sun",
                   bands[k], 100 * e.reported, 100 * e.bias);
            near = within(e.reported, cases[i].bounds[k], NULL, "depth %g, g %g, %s, %d bands",
                          (double)cases[i].depth, (double)cases[i].g, cases[i].sky ? "sky" : "sun",
                          bands[k]) &&
                   near;
            picture_free(&ours);
        }
        picture_free(&reference);
        tyn_scene_finish(&scene);
    }
    assert_true(near);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubes),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
