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

static double cube_error(gpu_test *t, const tyn_scene *scene, const picture *reference,
                         const char *settings)
{
    tyn_view view = {.no_background = true};
    picture ours;
    cube_view(&view);
    picture_render(&ours, t->dev, "shdom", scene, &view, settings, 0);
    const picture_error e = picture_compare(&ours, reference, 8);
    picture_free(&ours);
    printf("  %-34s error %5.2f %%, bias %+6.2f %%\n", settings, 100 * e.reported, 100 * e.bias);
    return e.reported;
}

// By g and light; more bands are nearer where the lobe needs them.
static void cubes(void **state)
{
    static const struct {
        float depth, g;
        bool sky; // else a sun
        int bands[2];
        double bounds[2];
    } cases[] = {
        {4, 0, false, {2, 5}, {0.06, 0.035}},   {4, 0.7f, false, {5}, {0.05}},
        {4, 0.9f, false, {5, 10}, {0.3, 0.04}}, {4, 0.9f, true, {5}, {0.06}},
        {4, -0.5f, false, {5}, {0.045}},
    };
    gpu_test *t = *state;
    bool near = true, nearer = false;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        tyn_scene scene;
        tyn_view view = {.no_background = true};
        picture reference;
        make_cube(&scene, cases[i].depth, cases[i].g);
        if (cases[i].sky) {
            scene_set_sky(&scene, 1);
        } else {
            scene_add_sun(&scene, 1, -0.5f, 0.2f, 1, 1, 1);
        }
        cube_view(&view);
        path_reference(&reference, t->dev, &scene, &view, path_effort(128));
        printf("depth %g, g %g, %s:\n", (double)cases[i].depth, (double)cases[i].g,
               cases[i].sky ? "sky" : "sun");
        double errors[2] = {0, 0};
        for (int k = 0; k < 2 && cases[i].bands[k]; k++) {
            char settings[96];
            snprintf(settings, sizeof settings, "shdom.cells=12 shdom.bands=%d", cases[i].bands[k]);
            errors[k] = cube_error(t, &scene, &reference, settings);
            near = within(errors[k], cases[i].bounds[k], NULL, "depth %g, g %g, %s, %d bands",
                          (double)cases[i].depth, (double)cases[i].g, cases[i].sky ? "sky" : "sun",
                          cases[i].bands[k]) &&
                   near;
        }
        nearer = nearer || (cases[i].g > 0.8f && errors[1] < 0.5 * errors[0]);
        picture_free(&reference);
        tyn_scene_finish(&scene);
    }
    assert_true(near);
    assert_true(nearer);
}

// ---- what is conserved -----------------------------------------------------------------------

// Nothing is absorbed, and radiance 1 comes from everywhere: the fluence is 4 pi at every point.
static void furnace(void **state)
{
    enum { POINTS = 200 };
    static float points[POINTS][3];
    static const float gs[] = {0, 0.6f};
    gpu_test *t = *state;
    srand(1);
    for (int i = 0; i < 3 * POINTS; i++) {
        points[i / 3][i % 3] = (float)(0.05 + 0.9 * rand() / RAND_MAX);
    }
    double worst = 0;
    for (int i = 0; i < 2; i++) {
        tyn_scene scene;
        make_cube(&scene, 4, gs[i]);
        scene_set_sky(&scene, 1);
        tyn_offline *off = scene_open(t->dev, "shdom", "shdom.cells=12 shdom.iterations=40");
        const tyn_probe_result *p =
            scene_probes(t->dev, off, &scene, (const float(*)[3])points, POINTS);
        double sum = 0;
        for (int k = 0; k < POINTS; k++) {
            sum += (double)p[k].fluence[1] / (4 * M_PI * POINTS);
        }
        printf("furnace, g %.1f: mean fluence %.4f of 4 pi\n", (double)gs[i], sum);
        worst = maximum(worst, fabs(sum - 1));
        tyn_offline_destroy(&off);
        tyn_scene_finish(&scene);
    }
    assert_within(worst, 0.03, NULL);
}

// ---- what runs -------------------------------------------------------------------------------

static bool ran(tyn_offline *off, const char *name)
{
    tyn_report report;
    tyn_offline_report(off, &report);
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        if (!strcmp(report.nodes[i].name, name) && !strcmp(report.nodes[i].state, "ran")) {
            return true;
        }
    }
    return false;
}

// A camera that moves asks for another view of the same solution; without light there is nothing to solve.
static void skips(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    make_cube(&scene, 2, 0.5f);
    scene_add_sun(&scene, 1, -0.5f, 0.2f, 1, 1, 1);
    scene_add_lamp(&scene, (float[]){0.2f, 1.5f, 0.5f}, 1);
    tyn_view view = {.outputs = TYN_OUTPUT_RADIANCE};
    cube_view(&view);
    tyn_offline *off = scene_open(t->dev, "shdom", "shdom.cells=8 shdom.bands=2");
    offline_frame(off, &scene, &view);
    assert_true(ran(off, "shdom") && ran(off, "shdom_view"));
    offline_frame(off, &scene, &view);
    assert_true(!ran(off, "shdom") && !ran(off, "shdom_view"));
    view.camera.position[0] += 0.1f;
    view.camera.ymag *= 1.1f;
    offline_frame(off, &scene, &view);
    assert_true(!ran(off, "shdom") && ran(off, "raymarch"));
    scene.num_lights = 0;
    offline_frame(off, &scene, &view);
    assert_true(!ran(off, "shdom") && !ran(off, "shdom_view"));
    tyn_offline_destroy(&off);
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubes),
        cmocka_unit_test(furnace),
        cmocka_unit_test(skips),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
