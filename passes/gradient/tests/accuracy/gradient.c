// gradient.c -- method `gradient`: what samples with gradients are off by, against light followed to every cell and against
// `path` ended after one scattering.
#include "bound.h"
#include "gradient_scenes.h"
#include "numbers.h"
#include "offline_frame.h"
#include "path_run.h"
#include "picture.h"
#include "sky.h"
#include "todo.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 48, N = 40 };

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

// Contexts stay open, by their settings: their kernels are compiled once.
static struct opened {
    const char *settings;
    tyn_offline *off;
} opened[16];

static tyn_offline *open_with(gpu_test *t, const char *settings)
{
    for (size_t i = 0; i < sizeof opened / sizeof *opened; i++) {
        if (!opened[i].off) {
            opened[i] = (struct opened){settings, scene_open(t->dev, "gradient", settings)};
        }
        if (!strcmp(opened[i].settings ? opened[i].settings : "", settings ? settings : "")) {
            return opened[i].off;
        }
    }
    fail_msg("more settings than contexts");
    return NULL;
}

static int teardown(void **state)
{
    for (size_t i = 0; i < sizeof opened / sizeof *opened; i++) {
        if (opened[i].off) {
            tyn_offline_destroy(&opened[i].off);
        }
    }
    return path_run_teardown(state);
}

// A picture, and how many samples it has taken; `settings` a literal.
static picture render(path_run *r, const tyn_scene *scene, const char *settings, double *samples)
{
    tyn_view view = {0};
    set_view(&view);
    view.outputs = TYN_OUTPUT_RADIANCE;
    tyn_offline *off = open_with(r->gpu, settings);
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
    assert_int_equal(tyn_device_validation_messages(r->dev), 0);
    return p;
}

// ---- samples and what is between them ---------------------------------------------------------------

#define VOXEL "gradient.interpolation=voxel"
#define UNSPLIT "gradient.grid=8 "
#define PUBLISHED "gradient.extrapolation=linear gradient.weight=printed "

static double off_by(path_run *r, const tyn_scene *scene, const picture *reference,
                     const char *settings, double *samples)
{
    picture p = render(r, scene, settings, samples);
    const picture_error e = picture_compare(&p, reference, 1);
    picture_free(&p);
    return e.rel_l1;
}

// A lamp and 512 samples, each against light that is followed to every cell: Fig 3, where radial functions are 3.4 times as far
// off as gradients.
static void lamps(void **state)
{
    static const struct {
        const char *name;
        float at[3];
        bool clumps;
        double bound, published; // of the defaults; of what is printed
        double ratio;            // of radial functions to the defaults, at least
        double split;
    } cases[] = {
        {"beside a cube", {0.5f, 1.1f, 0.5f}, false, 0.05, 0.12, 3, 0.01},
        {"beside clumps", {0.5f, 1.1f, 0.5f}, true, 0.08, 0.12, 1.8, 0.015},
        {"close to a cube", {0.4f, 1.03f, 0.45f}, false, 0.15, 0.25, 2, 0.015},
        {"in a cube, between samples", {0.5f, 0.5f, 0.5f}, false, 0.3, 0.3, 1, 0.015},
        {"in a cube, on a sample", {0.4375f, 0.4375f, 0.4375f}, false, 0.3, 0.3, 0.9, 0.015},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        tyn_scene *scene = cases[i].clumps ? clumps(6, 1, 0) : cube(2, 0.5f, 0);
        scene_add_lamp(scene, cases[i].at, 1);
        picture all = render(*state, scene, VOXEL, NULL);
        double samples = 0, split = 0;
        const double own = off_by(*state, scene, &all, UNSPLIT, &samples);
        const double published = off_by(*state, scene, &all, UNSPLIT PUBLISHED, NULL);
        const double rbf = off_by(*state, scene, &all, UNSPLIT "gradient.interpolation=rbf", NULL);
        const double finer = off_by(*state, scene, &all, NULL, &split);
        print_message("a lamp %s: %.1f %% (as published %.1f %%), radial functions %.1f %%, %.1f "
                      "times; split %.2f %% with %.0f samples\n",
                      cases[i].name, 100 * own, 100 * published, 100 * rbf, rbf / own, 100 * finer,
                      split);
        assert_true(samples == 512);
        assert_true(rbf >= cases[i].ratio * own);
        // What the paper has in Fig 3, with a lamp far from its samples.
        assert_true(todo_if(
            cases[i].ratio < 3, rbf >= 3 * own,
            "in a lamp's glow, and between clumps, 512 samples are too few for gradients as well",
            "radial functions three times as far off, a lamp %s", cases[i].name));
        assert_true(within(own, cases[i].bound, NULL, "a lamp %s", cases[i].name));
        assert_true(within(published, cases[i].published, NULL, "as published, %s", cases[i].name));
        assert_true(within(finer, cases[i].split, NULL, "split, a lamp %s", cases[i].name));
        picture_free(&all);
        close_scene(scene);
    }
}

// A shaft of light through a uniform cube, by grids: the error falls level by level.
static void shaft(void **state)
{
    tyn_scene *scene = cube(1, 0.2f, 0);
    add_spot(scene, 0.2f, 1.3f, 0.4f, 0.25f, -1, 0.1f, 0.15f);
    picture all = render(*state, scene, VOXEL, NULL);
    static const char *const settings[2][3] = {
        {UNSPLIT, "gradient.grid=16", NULL},
        {PUBLISHED UNSPLIT, PUBLISHED "gradient.grid=16", PUBLISHED}};
    for (int kind = 0; kind < 2; kind++) {
        double last = 1;
        for (int k = 0; k < 3; k++) {
            const int grid = k == 2 ? 64 : 8 << k;
            double samples = 0;
            const double e = off_by(*state, scene, &all, settings[kind][k], &samples);
            print_message("a shaft%s, grids to %d^3: %.2f %% with %.0f samples\n",
                          kind ? " as published" : "", grid, 100 * e, samples);
            assert_true(e < 0.75 * last);
            last = e;
        }
        assert_true(last <= 0.015); // asked for, whatever the bound
        assert_true(within(last, 0.015, NULL, "a shaft%s", kind ? " as published" : ""));
    }
    picture_free(&all);
    close_scene(scene);
}

// What is never given in the paper: the epsilon by which as many samples come out as it prints for grids to 16^3, 32^3 and 64^3, 1.5k,
// 2.8k and 6.7k, and 2705 of a spot (Fig 5).
static void epsilons(void **state)
{
    static const double printed[] = {1500, 2800, 6700};
    tyn_scene *scene = cube(1, 0.2f, 0);
    add_spot(scene, 0.2f, 1.3f, 0.4f, 0.25f, -1, 0.1f, 0.15f);
    double last = 0;
    for (int k = 0; k < 3; k++) {
        static const char *const settings[] = {"gradient.epsilon=6e-4 gradient.grid=16",
                                               "gradient.epsilon=6e-4 gradient.grid=32",
                                               "gradient.epsilon=6e-4"};
        double samples = 0;
        picture p = render(*state, scene, settings[k], &samples);
        print_message("epsilon 6e-4, grids to %d^3: %.0f samples (%.0f in the paper)\n", 16 << k,
                      samples, printed[k]);
        assert_true(samples > last && samples > printed[k] / 2 && samples < printed[k] * 2);
        last = samples;
        picture_free(&p);
    }
    close_scene(scene);
}

// ---- against path -------------------------------------------------------------------------------

static void add_lights(tyn_scene *scene, int kind)
{
    if (kind == 0) {
        scene_add_sun(scene, 0.3f, -1, 0.2f, 3, 2, 1);
        scene_add_sun(scene, -1, -0.4f, -0.6f, 1, 2, 3);
    } else if (kind == 1) {
        scene_add_lamp(scene, (float[]){-0.2f, 0.9f, 1.2f}, 2);
        scene_add_lamp(scene, (float[]){0.45f, 0.3f, 0.6f}, 0.2f);
    } else if (kind == 2) {
        add_spot(scene, 0.2f, 1.3f, 0.4f, 0.25f, -1, 0.1f, 0.3f);
    } else {
        sky_reference_map(&scene->environment, SKY_WHOLE);
    }
}

static void against_path(void **state)
{
    static const char *const kinds[] = {"two suns", "two lamps", "a spot", "a sky"};
    static const struct {
        const char *name;
        float sigma_s, sigma_a, g;
        bool cube;
        double bounds[4];
    } media[] = {
        {"cube", 4, 1, 0, true, {0.03, 0.06, 0.12, 0.06}},
        {"clumps", 8, 1, 0, false, {0.04, 0, 0, 0.05}},
        {"thick clumps", 40, 4, 0, false, {0.06, 0, 0.1, 0}},
        {"clumps, g 0.7", 8, 1, 0.7f, false, {0.04, 0.15, 0, 0.08}},
        {"clumps, g -0.4", 8, 1, -0.4f, false, {0.05, 0, 0, 0.06}},
    };
    bool all = true;
    for (size_t i = 0; i < sizeof media / sizeof *media; i++) {
        for (int k = 0; k < 4; k++) {
            if (media[i].bounds[k] == 0) {
                continue; // other media have it
            }
            tyn_scene *scene = media[i].cube
                                   ? cube(media[i].sigma_s, media[i].sigma_a, media[i].g)
                                   : clumps(media[i].sigma_s, media[i].sigma_a, media[i].g);
            add_lights(scene, k);
            tyn_view view = {0};
            set_view(&view);
            picture path = {0};
            path_run_picture(*state, &path, scene, &view, 64);
            double samples = 0;
            picture p = render(*state, scene, NULL, &samples);
            const picture_error e = picture_compare(&p, &path, 8);
            print_message("%s, %s: %.2f %% (noise %.2f %%, bias %+.2f %%) with %.0f samples\n",
                          media[i].name, kinds[k], 100 * e.reported, 100 * e.noise, 100 * e.bias,
                          samples);
            all = within(e.rel_l1, media[i].bounds[k], BOUND_NOISE, "%s, %s", media[i].name,
                         kinds[k]) &&
                  all;
            picture_free(&p);
            picture_free(&path);
            close_scene(scene);
        }
    }
    assert_true(all);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lamps), cmocka_unit_test(shaft),
                                       cmocka_unit_test(epsilons), cmocka_unit_test(against_path)};
    return cmocka_run_group_tests(tests, path_run_setup_kept, teardown);
}
