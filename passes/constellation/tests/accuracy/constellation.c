// constellation.c -- method `constellation` against `path` ended after one scattering: the march under the same suns, and what
// distant lights in the place of a map are off by.
#include "bound.h"
#include "gpu_test.h"
#include "path_run.h"
#include "random_unit.h"
#include "sky.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 64, N = 40 };

typedef struct volume {
    const char *name;
    float sigma_s, sigma_a, g;
    bool homogeneous;
    double bound; // of the march
} volume;

// Clumps with holes, or a full cube; coloured.
static tyn_scene *make_scene(const volume *v)
{
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_scene_init(scene);
    tyn_medium medium = grey_medium(v->sigma_s, v->sigma_a, v->g);
    medium.sigma_a[2] += 0.3f * v->sigma_s;
    float *grid = malloc(N * N * N * sizeof *grid);
    for (int q = 0; q < N * N * N; q++) {
        const float x = (float)(q % N) / N, y = (float)(q / N % N) / N, z = (float)(q / N / N) / N;
        const float waves = sinf(9 * x + 2 * z) * sinf(11 * y - x) * sinf(8 * z + 3 * y);
        const float away = hypotf(hypotf(x - 0.5f, y - 0.5f), z - 0.5f);
        grid[q] = fmaxf(0, fminf(1, 4 * (0.45f - away)) * (0.5f + 2 * waves));
    }
    scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1},
                  v->homogeneous ? NULL : (const uint32_t[]){N, N, N},
                  v->homogeneous ? NULL : grid);
    free(grid);
    return scene;
}

static void set_view(tyn_view *view)
{
    *view = (tyn_view){.no_background = true, .max_depth = 1};
    view_orthographic(view, (float[]){0.5f, 0.5f, 0.5f}, -0.6f, -0.4f, -1, (float[]){0, 1, 0}, 0.7f,
                      SIZE);
}

static picture_error compare(gpu_test *t, const tyn_scene *scene, const picture *reference,
                             const char *settings)
{
    tyn_view view = {0};
    set_view(&view);
    picture p;
    picture_render(&p, t->dev, "constellation", scene, &view, settings, 0);
    const picture_error e = picture_compare(&p, reference, 8);
    picture_free(&p);
    return e;
}

static picture reference_of(gpu_test *t, const tyn_scene *scene, uint32_t samples)
{
    tyn_view view = {0};
    set_view(&view);
    picture p;
    path_reference(&p, t->dev, scene, &view, samples);
    return p;
}

static const volume volumes[] = {
    {"thin cube", 0.4f, 0.1f, 0, true, 0.015},
    {"cube", 4, 1, 0, true, 0.015},
    {"thick cube", 20, 2, 0, true, 0.015},
    {"thin clumps", 1, 0.2f, 0, false, 0.015},
    {"clumps", 8, 1, 0, false, 0.015},
    {"thick clumps", 40, 4, 0, false, 0.015},
    {"clumps, g 0.7", 8, 1, 0.7f, false, 0.015},
    {"clumps, g -0.4", 8, 1, -0.4f, false, 0.015},
    {"thick clumps, g 0.7", 40, 4, 0.7f, false, 0.015},
};

// Nine suns of all directions and colours.
static void same_suns(void **state)
{
    for (size_t i = 0; i < sizeof volumes / sizeof *volumes; i++) {
        const volume *v = &volumes[i];
        tyn_scene *scene = make_scene(v);
        uint32_t seed = 3;
        for (int k = 0; k < 9; k++) {
            float x[6];
            for (int a = 0; a < 6; a++) {
                x[a] = (float)random_unit(&seed);
            }
            scene_add_sun(scene, 2 * x[0] - 1, 2 * x[1] - 1, 2 * x[2] - 1, x[3], x[4], x[5]);
        }
        picture path = reference_of(*state, scene, 512);
        const picture_error e = compare(*state, scene, &path, NULL);
        print_message("%-20s %.2f %% (noise %.2f %%, bias %+.2f %%)\n", v->name, 100 * e.reported,
                      100 * e.noise, 100 * e.bias);
        if (getenv("TYN_LONG")) { // figures of the page, which bound nothing
            const picture_error printed =
                compare(*state, scene, &path, "constellation.quadrature=printed");
            const picture_error coarse = compare(*state, scene, &path, "constellation.slice=2");
            print_message("    as printed %.2f %%; slices 2 voxels apart %.2f %%\n",
                          100 * printed.reported, 100 * coarse.reported);
        }
        assert_true(e.reported < 0.02); // 2 %, whatever the bound
        assert_true(within(e.rel_l1, v->bound, BOUND_NOISE, "same suns, %s", v->name));
        picture_free(&path);
        tyn_scene_finish(scene);
        free(scene);
    }
}

// The same map for all: the lights' own error, which falls with their number.
static void lights_for_a_map(void **state)
{
    static const int counts[] = {1, 4, 16, 20, 64};
    enum { COUNTS = sizeof counts / sizeof *counts };
    static const volume kinds[] = {{"clumps", 8, 1, 0, false, 0},
                                   {"thick clumps", 40, 4, 0, false, 0},
                                   {"clumps, g 0.7", 8, 1, 0.7f, false, 0}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        tyn_scene *scene = make_scene(&kinds[i]);
        sky_reference_map(&scene->environment, SKY_WHOLE);
        picture path = reference_of(*state, scene, 1024);
        double errors[COUNTS];
        for (int k = 0; k < COUNTS; k++) {
            char settings[64];
            snprintf(settings, sizeof settings, "constellation.lights=%d", counts[k]);
            const picture_error e = compare(*state, scene, &path, settings);
            errors[k] = e.reported;
            print_message("%-14s %2d lights: %.2f %% (noise %.2f %%, bias %+.2f %%)\n",
                          kinds[i].name, counts[k], 100 * e.reported, 100 * e.noise, 100 * e.bias);
        }
        if (kinds[i].g == 0) { // as the paper has it; else few lights are what they point at
            for (int k = 1; k < COUNTS; k++) {
                assert_true(errors[k] < errors[k - 1]);
            }
            assert_true(within(errors[COUNTS - 1], kinds[i].sigma_s > 20 ? 0.02 : 0.01, NULL,
                               "64 lights, %s", kinds[i].name));
            assert_true(within(errors[3], kinds[i].sigma_s > 20 ? 0.05 : 0.03, NULL,
                               "20 lights, %s", kinds[i].name));
        } else {
            assert_true(errors[COUNTS - 1] < errors[3]);
        }
        picture_free(&path);
        tyn_scene_finish(scene);
        free(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(same_suns),
                                       cmocka_unit_test(lights_for_a_map)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
