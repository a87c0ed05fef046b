// pop_cube.c -- `pop` on the unit cube of sigma_s 4 against the reference images (pbrt-v3 in 64-bit), its
// energy, and its refinement.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "picture.h"
#include "skip.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void make_cube(tyn_scene *scene, float g)
{
    tyn_medium medium = grey_medium(4, 0, g);
    tyn_scene_init(scene);
    scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
    scene_add_sun(scene, 1, 0, 0, 1, 1, 1);
}

static const struct {
    const char *name;
    float direction[3];
} views[] = {{"side", {0, -1, 0}}, {"exit", {-1, 0, 0}}, {"entry", {1, 0, 0}}};

static picture_error cube_error(gpu_test *t, float g, int view, int cells)
{
    char name[64], settings[64];
    snprintf(name, sizeof name, "cube_g%.2f_%s", (double)g, views[view].name);
    snprintf(settings, sizeof settings, "lattice.cells=%d", cells);
    picture reference, ours;
    if (!picture_reference(&reference, name)) {
        skip_without(name);
    }
    tyn_scene *scene = malloc(sizeof *scene);
    make_cube(scene, g);
    const float *d = views[view].direction;
    tyn_view v = {0};
    view_orthographic(&v, (float[]){0.5f, 0.5f, 0.5f}, d[0], d[1], d[2], (float[]){0, 0, 1}, 0.5f,
                      reference.width);
    picture_render(&ours, t->dev, "pop", scene, &v, settings, 0);
    picture_error e = picture_compare(&ours, &reference, 8);
    print_message("%-18s %2d cells: error %.2f %% (rel_l1 %.2f, noise %.2f, bias %+.2f)\n", name,
                  cells, 100 * e.reported, 100 * e.rel_l1, 100 * e.noise, 100 * e.bias);
    picture_free(&ours);
    picture_free(&reference);
    tyn_scene_finish(scene);
    free(scene);
    return e;
}

// The worst of three lattices, of every view.
static void references(void **state)
{
    static const float gs[] = {0, 0.5f, 0.9f};
    static const double limits[3][3] = {
        {0.014, 0.014, 0.009}, {0.05, 0.07, 0.05}, {0.12, 0.06, 0.12}};
    static const int cells[] = {16, 24, 32};
    for (int i = 0; i < 3; i++) {
        double worst[3] = {0};
        for (int v = 0; v < 3; v++) {
            for (int k = 0; k < 3; k++) {
                worst[v] = maximum(worst[v], cube_error(*state, gs[i], v, cells[k]).reported);
            }
            assert_true(
                within(worst[v], limits[i][v], NULL, "g %g, %s", (double)gs[i], views[v].name));
        }
        double median = worst[0] + worst[1] + worst[2] - fmax(worst[0], fmax(worst[1], worst[2])) -
                        fmin(worst[0], fmin(worst[1], worst[2]));
        print_message("g %.1f: median %.2f %%\n", (double)gs[i], 100 * median);
        assert_true(i < 2 || within(median, 0.09, NULL, "g %g, median", (double)gs[i]));
    }
}

// A finer lattice is better at g = 0.
static void refinement(void **state)
{
    static const int cells[] = {8, 16, 32};
    for (int v = 0; v < 3; v++) {
        double before = INFINITY;
        for (int k = 0; k < 3; k++) {
            double e = cube_error(*state, 0, v, cells[k]).reported;
            assert_true(e <= before);
            before = e;
        }
    }
}

static void energy(void **state)
{
    gpu_test *t = *state;
    static const float gs[] = {0, 0.5f, 0.9f};
    for (int i = 0; i < 3; i++) {
        tyn_scene *scene = malloc(sizeof *scene);
        make_cube(scene, gs[i]);
        double four = scene_imbalance(t->dev, "pop", scene, "lattice.sweeps=4");
        double six = scene_imbalance(t->dev, "pop", scene, "lattice.sweeps=6");
        print_message("g %.1f: imbalance %.3f %% after 4 sweeps, %.3f %% after 6\n", (double)gs[i],
                      100 * four, 100 * six);
        assert_within(four, 0.0015, NULL);
        assert_true(six <= 1e-4);
        tyn_scene_finish(scene);
        free(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(references), cmocka_unit_test(refinement),
                                       cmocka_unit_test(energy)};
    return run_cases(tests, gpu_setup, gpu_teardown);
}
