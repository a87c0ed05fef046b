// gradient.c -- method `gradient`: what samples with gradients are off by, against light followed to every cell and against
// `path` ended after one scattering.
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

enum { SIZE = 64, N = 40 };

static tyn_scene *open_scene(void)
{
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_scene_init(scene);
    return scene;
}

static void close_scene(tyn_scene *scene)
{
    tyn_scene_finish(scene);
    free(scene);
}

static tyn_scene *cube(float sigma_s, float sigma_a, float g)
{
    tyn_scene *scene = open_scene();
    const tyn_medium medium = grey_medium(sigma_s, sigma_a, g);
    scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
    return scene;
}

// Clumps with holes.
static tyn_scene *clumps(float sigma_s, float sigma_a, float g)
{
    tyn_scene *scene = open_scene();
    tyn_medium medium = grey_medium(sigma_s, sigma_a, g);
    medium.sigma_a[2] += 0.3f * sigma_s;
    float *grid = malloc(N * N * N * sizeof *grid);
    for (int q = 0; q < N * N * N; q++) {
        const float x = (float)(q % N) / N, y = (float)(q / N % N) / N, z = (float)(q / N / N) / N;
        const float waves = sinf(9 * x + 2 * z) * sinf(11 * y - x) * sinf(8 * z + 3 * y);
        const float away = hypotf(hypotf(x - 0.5f, y - 0.5f), z - 0.5f);
        grid[q] = fmaxf(0, fminf(1, 4 * (0.45f - away)) * (0.5f + 2 * waves));
    }
    scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1},
                  (const uint32_t[]){N, N, N}, grid);
    free(grid);
    return scene;
}

static void add_spot(tyn_scene *scene, float x, float y, float z, float dx, float dy, float dz,
                     float half_angle)
{
    const float length = hypotf(hypotf(dx, dy), dz);
    scene->lights[scene->num_lights++] =
        (tyn_light){.kind = TYN_LIGHT_SPOT,
                    .color = {9, 9, 9},
                    .position = {x, y, z},
                    .direction = {dx / length, dy / length, dz / length},
                    .cos_inner = cosf(0.95f * half_angle),
                    .cos_outer = cosf(half_angle)};
}

static void set_view(tyn_view *view)
{
    *view = (tyn_view){.no_background = true, .max_depth = 1};
    view_orthographic(view, (float[]){0.5f, 0.5f, 0.5f}, -0.6f, -0.4f, -1, (float[]){0, 1, 0}, 0.8f,
                      SIZE);
}

// A picture, and how many samples it has taken.
static picture render(gpu_test *t, const tyn_scene *scene, const char *settings, double *samples)
{
    tyn_view view;
    set_view(&view);
    view.outputs = TYN_OUTPUT_RADIANCE;
    tyn_offline *off = scene_open(t->dev, "gradient", settings);
    offline_frame(off, scene, &view);
    tyn_report report;
    tyn_offline_report(off, &report);
    for (uint32_t i = 0; samples && i < report.num_nodes; i++) {
        const tyn_node_report *node = &report.nodes[i];
        for (uint32_t k = 0; k < node->num_work; k++) {
            if (!strcmp(node->name, "gradient") && !strcmp(node->work[k].name, "samples")) {
                *samples = node->work[k].amount;
            }
        }
    }
    picture p = {.width = SIZE, .height = SIZE, .rgb = malloc(sizeof(float[SIZE * SIZE][3]))};
    const float *rgba = tyn_offline_output(off, TYN_OUTPUT_RADIANCE);
    for (int i = 0; i < SIZE * SIZE; i++) {
        memcpy(p.rgb + 3 * i, rgba + 4 * i, sizeof(float[3]));
    }
    tyn_offline_destroy(&off);
    assert_int_equal(tyn_device_validation_messages(t->dev), 0);
    return p;
}

static picture_error off_by(gpu_test *t, const tyn_scene *scene, const picture *reference,
                            const char *settings, double *samples)
{
    picture p = render(t, scene, settings, samples);
    const picture_error e = picture_compare(&p, reference, 1);
    picture_free(&p);
    return e;
}

// ---- samples and what is between them ---------------------------------------------------------------

#define UNSPLIT "gradient.grid=8 "
#define VOXEL "gradient.interpolation=voxel"

// A lamp beside a medium, 512 samples: Fig 3, where radial functions are 3.4 times as far off.
static void beside_a_lamp(void **state)
{
    static const struct {
        const char *name;
        float at[3];
    } lamps[] = {{"above", {0.5f, 1.1f, 0.5f}}, {"nearer", {0.4f, 1.03f, 0.45f}}, {"between", {0.5f,0.5f,0.5f}}, {"on", {0.4375f,0.4375f,0.4375f}}};
    for (int k = 0; k < 8; k++) {
        tyn_scene *scene = k%2 ? clumps(6, 1, 0) : cube(2, 0.5f, 0);
        scene_add_lamp(scene, lamps[k/2].at, 1);
        picture all = render(*state, scene, VOXEL, NULL);
        static const char *const s[] = {"gradient.weight=printed gradient.extrapolation=linear","gradient.weight=printed","gradient.extrapolation=linear","gradient.weight=fading","gradient.interpolation=rbf"};
        for (int i=0;i<5;i++) { char b[128]; snprintf(b,sizeof b,UNSPLIT "%s",s[i]);
            double n = 0;
            picture_error e = off_by(*state, scene, &all, b, &n);
            print_message("%s %s %s: %.2f%% bias %.2f %g\n", lamps[k/2].name, k%2?"clumps":"cube", s[i], 100*e.rel_l1, 100*e.bias, n);
        }
        picture_free(&all);
        close_scene(scene);
    }
}

// A shaft of light through a uniform cube.
static void shaft(void **state)
{
    tyn_scene *scene = cube(1, 0.2f, 0);
    add_spot(scene, 0.2f, 1.3f, 0.4f, 0.25f, -1, 0.1f, 0.15f);
    picture all = render(*state, scene, VOXEL, NULL);
    for (int grid = 8; grid <= 64; grid *= 2) {
        for (int e = 0; e < 2; e++) for (int w = 0; w < 4; w++) {
        char settings[128];
        double samples = 0;
        snprintf(settings, sizeof settings, "gradient.grid=%d gradient.epsilon=%g gradient.weight=%s gradient.extrapolation=%s", grid, pow(10,-3-e), w &1? "fading":"printed", w / 2 ? "linear" : "exponential");
        const picture_error er = off_by(*state, scene, &all, settings, &samples);
        print_message("%s: %.2f %% %.0f samples\n", settings, 100 * er.rel_l1, samples);
        }
    }
    picture_free(&all);
    close_scene(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(beside_a_lamp), cmocka_unit_test(shaft)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
