// gradient_light.c -- method `gradient` where its light is more than suns and lamps that scatter once, against `path`: a sky among
// surfaces, soft edges of shadows, light that has scattered more than once; and volumes finer than its samples.
#include "bound.h"
#include "gpu_test.h"
#include "gradient_scenes.h"
#include "numbers.h"
#include "offline_frame.h"
#include "path_run.h"
#include "picture.h"
#include "sky.h"
#include "solids.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 48 };

// Clumps with holes, n voxels a side, with so many waves along it.
static tyn_scene *clumps(float sigma_s, float sigma_a, float g, int n, double waves)
{
    tyn_scene *scene = open_scene();
    tyn_medium medium = grey_medium(sigma_s, sigma_a, g);
    float *grid = malloc((size_t)n * (size_t)n * (size_t)n * sizeof *grid);
    for (int q = 0; q < n * n * n; q++) {
        const double x = (double)(q % n) / n, y = (double)(q / n % n) / n,
                     z = (double)(q / n / n) / n;
        const double lumps =
            sin(waves * (9 * x + 2 * z)) * sin(waves * (11 * y - x)) * sin(waves * (8 * z + 3 * y));
        const double away = hypot(hypot(x - 0.5, y - 0.5), z - 0.5);
        grid[q] = (float)fmax(0, fmin(1, 4 * (0.45 - away)) * (0.5 + 2 * lumps));
    }
    scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1},
                  (const uint32_t[]){(uint32_t)n, (uint32_t)n, (uint32_t)n}, grid);
    free(grid);
    return scene;
}

// A picture by `gradient` and what it is off by.
static picture_error off_by(path_run *r, const tyn_scene *scene, tyn_view *view,
                            const picture *reference, const char *settings, uint32_t block)
{
    picture p;
    picture_render(&p, r->dev, "gradient", scene, view, settings, 1);
    const picture_error e = picture_compare(&p, reference, block);
    picture_free(&p);
    return e;
}

// A black roof, back and sides around a cube of fog; the camera looks in.
static tyn_scene *niche(void)
{
    tyn_scene *scene = cube(1, 0.25f, 0);
    const float zero[3] = {0, 0, 0};
    const uint32_t stone = solids_material(scene, zero, zero);
    solids_box(scene, (float[]){-0.3f, 1.02f, -0.3f}, (float[]){1.3f, 1.3f, 1.1f}, 0, false, stone);
    solids_box(scene, (float[]){-0.3f, -0.3f, -0.3f}, (float[]){-0.02f, 1.1f, 1.1f}, 0, false,
               stone);
    solids_box(scene, (float[]){1.02f, -0.3f, -0.3f}, (float[]){1.3f, 1.1f, 1.1f}, 0, false, stone);
    solids_box(scene, (float[]){-0.1f, -0.3f, -0.3f}, (float[]){1.1f, 1.1f, -0.02f}, 0, false,
               stone);
    solids_hierarchy(scene, 4);
    return scene;
}

// Skies that surfaces hide most of: what has scattered once, then all.
static void niches(void **state)
{
    static const struct {
        const char *name;
        bool map;
        double once, all;
    } cases[] = {{"an even sky", false, 0.04, 0.04}, {"a map", true, 0.05, 0.045}};
    path_run *r = *state;
    bool right = true;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        for (int bounces = 0; bounces < 2; bounces++) {
            tyn_scene *scene = niche();
            if (cases[k].map) {
                sky_reference_map(&scene->environment, SKY_WHOLE);
            } else {
                scene_set_sky(scene, 1);
            }
            tyn_view view = {.no_background = true, .max_depth = bounces ? 0 : 1};
            view_orthographic(&view, (float[]){0.5f, 0.5f, 0.5f}, 0.1f, 0.05f, -1,
                              (float[]){0, 1, 0}, 0.55f, SIZE);
            picture path = {0};
            path_run_picture(r, &path, scene, &view, 96);
            const picture_error e =
                off_by(r, scene, &view, &path, bounces ? "gradient.multiple=lattice" : NULL, 8);
            print_message("%s in a niche%s: %.2f %% (noise %.2f %%, bias %+.2f %%)\n",
                          cases[k].name, bounces ? ", with all scatterings" : "", 100 * e.reported,
                          100 * e.noise, 100 * e.bias);
            right = within(e.rel_l1, bounces ? cases[k].all : cases[k].once, BOUND_NOISE, "%s, %s",
                           cases[k].name, bounces ? "all" : "once") &&
                    right;
            picture_free(&path);
            close_scene(scene);
        }
    }
    assert_true(right);
}

// A shaft of sunlight through a hole in a roof; single pixels.
static void shaft(void **state)
{
    path_run *r = *state;
    tyn_scene *scene = cube(0.5f, 0.1f, 0);
    const float zero[3] = {0, 0, 0};
    const uint32_t black = solids_material(scene, zero, zero);
    solids_box(scene, (float[]){-2, 1.1f, -2}, (float[]){0.3f, 1.2f, 3}, 0, false, black);
    solids_box(scene, (float[]){0.62f, 1.1f, -2}, (float[]){3, 1.2f, 3}, 0, false, black);
    solids_box(scene, (float[]){0.2f, 1.1f, -2}, (float[]){0.7f, 1.2f, 0.33f}, 0, false, black);
    solids_box(scene, (float[]){0.2f, 1.1f, 0.65f}, (float[]){0.7f, 1.2f, 3}, 0, false, black);
    solids_hierarchy(scene, 4);
    scene_add_sun(scene, 0.25f, -1, 0.1f, 9, 9, 9);
    tyn_view view = {.no_background = true, .max_depth = 1};
    view_orthographic(&view, (float[]){0.5f, 0.5f, 0.5f}, 0, 0, -1, (float[]){0, 1, 0}, 0.55f,
                      SIZE);
    // Without noise: shadows by the same maps, looked up all along the rays.
    picture sharp;
    picture_render(&sharp, r->dev, "single", scene, &view, NULL, 1);
    static const struct {
        const char *settings[2]; // sharp, soft
        double bounds[2];        // over blocks
    } cases[] = {
        {{"gradient.soft=0", "gradient.soft=1"}, {0.04, 0.025}},
        {{"gradient.soft=0 gradient.grid=32", "gradient.soft=1 gradient.grid=32"}, {0.06, 0.06}}};
    bool right = true;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        double found[2];
        for (int soft = 0; soft < 2; soft++) {
            const char *settings = cases[k].settings[soft];
            const picture_error e = off_by(r, scene, &view, &sharp, settings, 1);
            const picture_error blocks = off_by(r, scene, &view, &sharp, settings, 8);
            print_message("a shaft, %s: %.2f %%, blocks %.2f %% (bias %+.2f %%)\n", settings,
                          100 * e.rel_l1, 100 * blocks.rel_l1, 100 * blocks.bias);
            found[soft] = e.rel_l1;
            right = within(blocks.rel_l1, cases[k].bounds[soft], NULL, "%s", settings) && right;
        }
        assert_true(found[1] < found[0]);
    }
    assert_true(right);
    picture_free(&sharp);
    close_scene(scene);
}

// Light that has scattered more than once, of the lattice.
static void multiple(void **state)
{
    static const struct {
        const char *name;
        float sigma_s, sigma_a, g;
        int n;
        bool lamp;
        double bound;
    } cases[] = {{"cube, sun", 4, 0, 0, 0, false, 0.03},
                 {"clumps, g 0.7, sun", 12, 1, 0.7f, 40, false, 0.06},
                 {"clumps, g -0.3, lamp", 8, 0.5f, -0.3f, 40, true, 0.06}};
    path_run *r = *state;
    bool right = true;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        tyn_scene *scene =
            cases[k].n ? clumps(cases[k].sigma_s, cases[k].sigma_a, cases[k].g, cases[k].n, 1)
                       : cube(cases[k].sigma_s, cases[k].sigma_a, cases[k].g);
        if (cases[k].lamp) {
            scene_add_lamp(scene, (float[]){-0.2f, 0.9f, 1.2f}, 2);
        } else {
            scene_add_sun(scene, 0.3f, -1, 0.2f, 3, 2, 1);
        }
        tyn_view view = {.no_background = true};
        view_orthographic(&view, (float[]){0.5f, 0.5f, 0.5f}, -0.6f, -0.4f, -1, (float[]){0, 1, 0},
                          0.8f, SIZE);
        picture path = {0};
        path_run_picture(r, &path, scene, &view, 128);
        const picture_error e = off_by(r, scene, &view, &path, "gradient.multiple=lattice", 8);
        const picture_error once = off_by(r, scene, &view, &path, NULL, 8);
        print_message("%s: %.2f %% (noise %.2f %%, bias %+.2f %%), one scattering alone %.0f %%\n",
                      cases[k].name, 100 * e.reported, 100 * e.noise, 100 * e.bias,
                      100 * once.reported);
        right = within(e.rel_l1, cases[k].bound, BOUND_NOISE, "%s", cases[k].name) && right;
        assert_true(once.reported > 5 * e.reported);
        picture_free(&path);
        close_scene(scene);
    }
    assert_true(right);
}

// A volume of 128^3 voxels, of clumps about four voxels across: light is followed through means of 64^3, and the field has as many
// cells; it is to be no worse than if both were as fine as the voxels.
static void fine(void **state)
{
    path_run *r = *state;
    tyn_scene *scene = clumps(12, 1, 0, 128, 4);
    scene_add_lamp(scene, (float[]){-0.2f, 0.9f, 1.2f}, 2);
    tyn_view view = {.no_background = true, .max_depth = 1};
    view_orthographic(&view, (float[]){0.5f, 0.5f, 0.5f}, -0.6f, -0.4f, -1, (float[]){0, 1, 0},
                      0.8f, SIZE);
    picture path = {0};
    path_run_picture(r, &path, scene, &view, 128);
    static const char *const as_fine =
        "gradient.medium=256 gradient.field=128 gradient.epsilon=6e-4";
    const picture_error e = off_by(r, scene, &view, &path, "gradient.epsilon=6e-4", 8);
    const picture_error finer = off_by(r, scene, &view, &path, as_fine, 8);
    const picture_error most = off_by(r, scene, &view, &path, NULL, 8);
    print_message(
        "a fine volume: %.2f %% (noise %.2f %%, bias %+.2f %%); as fine as the voxels %.2f %%; "
        "with epsilon 1e-4 %.2f %%\n",
        100 * e.reported, 100 * e.noise, 100 * e.bias, 100 * finer.reported, 100 * most.reported);
    assert_true(e.reported < finer.reported + 0.01);
    assert_true(within(e.rel_l1, 0.12, NULL, "a fine volume"));
    assert_true(within(most.rel_l1, 0.08, NULL, "a fine volume, epsilon 1e-4"));
    picture_free(&path);
    close_scene(scene);
}

// Depths and lobes at their ends, in a niche under a sky, a sun and a lamp: every value is a number (offline_frame.h).
static void extremes(void **state)
{
    static const float sigmas[] = {1e-4f, 1, 1e4f}, lobes[] = {-0.99f, 0.5f, 0.999f};
    path_run *r = *state;
    tyn_offline *off = scene_open(r->dev, "gradient", "gradient.multiple=lattice gradient.soft=1");
    for (int k = 0; k < 9; k++) {
        const tyn_medium medium = grey_medium(sigmas[k % 3], 0.01f * sigmas[k % 3], lobes[k / 3]);
        tyn_scene *scene = niche();
        scene->media[0] = medium;
        if (k % 2) {
            sky_reference_map(&scene->environment, SKY_WHOLE);
        } else {
            scene_set_sky(scene, 1);
        }
        scene_add_sun(scene, 0, -0.2f, -1, 1e6f, 1, 1e-6f);
        scene_add_lamp(scene, (float[]){0.4375f, 0.4375f, 0.4375f}, 1);
        tyn_view view = {.outputs = TYN_OUTPUT_RADIANCE};
        view_orthographic(&view, (float[]){0.5f, 0.5f, 0.5f}, 0.1f, 0.05f, -1, (float[]){0, 1, 0},
                          0.55f, 16);
        offline_frame(off, scene, &view);
        const float *rgba = tyn_offline_output(off, TYN_OUTPUT_RADIANCE);
        double least = 0, sum = 0;
        for (int i = 0; i < 16 * 16 * 4; i++) {
            least = minimum(least, (double)rgba[i]);
            sum += (double)rgba[i];
        }
        assert_true(least == 0 && sum > 0);
        close_scene(scene);
    }
    tyn_offline_destroy(&off);
    assert_int_equal(tyn_device_validation_messages(r->dev), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(extremes), cmocka_unit_test(niches),
                                       cmocka_unit_test(shaft), cmocka_unit_test(multiple),
                                       cmocka_unit_test(fine)};
    return cmocka_run_group_tests(tests, path_run_setup_kept, path_run_teardown);
}
