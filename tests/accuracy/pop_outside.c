// pop_outside.c -- what leaves the box of a medium lights surfaces outside it in `pop`, as in `path`: floors that run
// out of the box, under it and through it, about media that glow, scatter sunlight and take light of the sky.
#include "bound.h"
#include "gpu_test.h"
#include "path_run.h"
#include "picture.h"
#include "solids.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 48, GLOW = 0, SUN, SKY, DENSE = 3 };

static void lights(tyn_scene *scene, int kind, float floor, float sigma_s)
{
    tyn_scene_init(scene);
    uint32_t m = solids_material(scene, (float[]){0.7f, 0.7f, 0.7f}, (float[]){0, 0, 0});
    solids_quad(scene, (float[]){-2.5f, floor, -2.5f}, (float[]){0, 0, 5}, (float[]){5, 0, 0}, m);
    solids_hierarchy(scene, 4);
    tyn_medium medium = grey_medium(sigma_s, kind == SUN ? 0.01f : kind == SKY ? 4 : 1, 0);
    for (int c = 0; c < 3 && kind == GLOW; c++) {
        medium.emission[c] = 1;
    }
    scene_add_box(scene, &medium, (float[]){-0.5f, -0.5f, -0.5f}, (float[]){0.5f, 0.5f, 0.5f}, NULL,
                  NULL);
    if (kind == SUN) {
        scene_add_sun(scene, 0.5f, -0.9f, 0.2f, 3, 3, 3);
    } else if (kind == SKY) {
        scene_set_sky(scene, 1);
    }
}

// Of the green channel over columns [from, to) of the middle rows.
static double strip(const picture *p, int from, int to)
{
    double sum = 0;
    for (int y = SIZE / 3; y < SIZE - SIZE / 3; y++) {
        for (int x = from; x < to; x++) {
            sum += (double)p->rgb[3 * (y * SIZE + x) + 1];
        }
    }
    return sum;
}

static void floors(void **state)
{
    gpu_test *t = *state;
    // `error` of blocks of 8 x 8 pixels, and of strips 8, 25 and 75 cm wide beside the box that glows.
    static const struct {
        const char *name;
        int kind;
        float floor, sigma_s;
        double error, strips;
    } cases[] = {
        {"glow, floor under the box", GLOW, -0.5f, 3, 0.03, 0.05},
        {"glow, floor through the box", GLOW, -0.13f, 3, 0.03, 0.1},
        {"glow, floor below the box", GLOW, -0.7f, 3, 0.03, 0.15},
        [DENSE] = {"dense glow, floor through the box", GLOW, -0.13f, 15, 0.04, 0.03},
        {"sun", SUN, -0.5f, 8, 0.012, 0},
        {"sky", SKY, -0.5f, 3, 0.018, 0},
    };
    path_run runs;
    path_run_open(&runs, t->dev);
    bool good = true;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tyn_scene scene;
        lights(&scene, cases[i].kind, cases[i].floor, cases[i].sigma_s);
        tyn_view view = {0};
        // From right above the edge of the box, which is in the middle: the half on the right shows what is outside.
        view_perspective(&view, (float[]){0.5f, 2, 0.01f}, (float[]){0.5f, 0, 0}, 0.5f, SIZE);
        picture p, reference = {0};
        picture_render(&p, t->dev, "pop", &scene, &view, NULL, 0);
        path_run_picture(&runs, &reference, &scene, &view, path_effort(96));
        picture_error e = picture_compare(&p, &reference, 8);
        printf("%-34s rel_l1 %4.1f %% (noise %.1f), bias %+.1f %%; strips", cases[i].name,
               100 * e.rel_l1, 100 * e.noise, 100 * e.bias);
        good = within(e.reported, cases[i].error, NULL, "%s, error", cases[i].name) && good;
        good = within(fabs(e.bias), 0.03, NULL, "bias") && good;
        // The box's edge is in the middle column whatever the height of the floor; which side is to the right is not
        // said.
        const bool turned =
            strip(&reference, 0, SIZE / 4) < strip(&reference, SIZE - SIZE / 4, SIZE);
        static const int widths[3] = {2, 6, 18};
        for (int k = 0; k < 3 && cases[i].kind == GLOW; k++) {
            const int from = turned ? SIZE / 2 - widths[k] : SIZE / 2, to = from + widths[k];
            const double off = strip(&p, from, to) / strip(&reference, from, to) - 1;
            printf(" %+.1f %%", 100 * off);
            const bool foot = i == DENSE && k == 0;
            good = within(fabs(off), foot ? 0.08 : cases[i].strips, NULL, "%s, %s", cases[i].name,
                          foot ? "foot" : "strips") &&
                   good;
        }
        printf("\n");
        picture_free(&p);
        picture_free(&reference);
        tyn_scene_finish(&scene);
    }
    path_run_close(&runs);
    assert_true(good);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(floors)};
    setvbuf(stdout, NULL, _IOLBF, 0);
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
