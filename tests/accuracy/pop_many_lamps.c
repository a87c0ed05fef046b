// pop_many_lamps.c -- many lamps in `pop`: each looks as it does alone, whatever the others are and in whatever order.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "picture.h"
#include "solids.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 64, LAMPS = 7 };

// Four points of equal strength and three spots, two of them narrower than a cell of the lattice is wide.
static const tyn_light lamps[LAMPS] = {
    {.kind = TYN_LIGHT_POINT, .color = {1, 1, 1}, .position = {-1.1f, -0.7f, 0.2f}},
    {.kind = TYN_LIGHT_POINT, .color = {1, 0.3f, 0.2f}, .position = {0.9f, 0.63f, -0.9f}},
    {.kind = TYN_LIGHT_POINT, .color = {0.2f, 1, 0.4f}, .position = {0.05f, -0.9f, 1.1f}},
    {.kind = TYN_LIGHT_POINT, .color = {0.1f, 0.3f, 1}, .position = {1.3f, -1.2f, -0.3f}},
    {.kind = TYN_LIGHT_SPOT,
     .color = {1, 1, 0.5f},
     .position = {-1.3f, 1.4f, 0},
     .direction = {0.4472136f, -0.8944272f, 0},
     .cos_inner = 0.998f,
     .cos_outer = 0.99f},
    {.kind = TYN_LIGHT_SPOT,
     .color = {0.5f, 1, 1},
     .position = {0.4f, 1.3f, 0.3f},
     .direction = {0, -1, 0},
     .cos_inner = 0.99f,
     .cos_outer = 0.98f},
    {.kind = TYN_LIGHT_SPOT,
     .color = {1, 0.5f, 1},
     .position = {1.5f, 0.1f, 0.2f},
     .direction = {-0.8f, 0.6f, 0},
     .cos_inner = 0.8f,
     .cos_outer = 0.5f},
};

static void render(gpu_test *t, picture *p, const int *which, int count, bool uneven)
{
    const tyn_medium medium = grey_medium(0.3f, 0.1f, 0.5f);
    const uint32_t size[3] = {16, 16, 16};
    float *grid = calloc(16 * 16 * 16, sizeof *grid);
    for (int i = 0; i < 16 * 16 * 16; i++) {
        grid[i] = 0.6f + 0.4f * sinf(0.7f * (float)(i % 16)) * cosf(0.5f * (float)(i / 16 % 16));
    }
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_scene_init(scene);
    scene_add_box(scene, &medium, (float[]){-2, -2, -2}, (float[]){2, 2, 2}, uneven ? size : NULL,
                  uneven ? grid : NULL);
    for (int i = 0; i < count; i++) {
        scene->lights[scene->num_lights++] = lamps[which[i]];
    }
    tyn_view view = {.width = 0};
    view_orthographic(&view, (float[]){0, 0, 0}, 0.1f, -0.2f, -1, (float[]){0, 1, 0}, 1.7f, SIZE);
    picture_render(p, t->dev, "pop", scene, &view, "lattice.cells=16", 0);
    tyn_scene_finish(scene);
    free(scene);
    free(grid);
}

static void alone_or_not(void **state)
{
    bool good = true;
    for (int uneven = 0; uneven < 2; uneven++) {
        const int order[LAMPS] = {0, 1, 2, 3, 4, 5, 6}, other[LAMPS] = {6, 3, 4, 1, 5, 2, 0};
        picture all, turned, sum = {0};
        render(*state, &all, order, LAMPS, uneven);
        render(*state, &turned, other, LAMPS, uneven);
        for (int i = 0; i < LAMPS; i++) {
            picture one;
            render(*state, i ? &one : &sum, &order[i], 1, uneven);
            for (int k = 0; i && k < 3 * SIZE * SIZE; k++) {
                sum.rgb[k] += one.rgb[k];
            }
            if (i) {
                picture_free(&one);
            }
        }
        double mean = 0, off = 0, worst = 0, by_order = 0;
        for (int k = 0; k < 3 * SIZE * SIZE; k++) {
            mean += (double)sum.rgb[k] / (3 * SIZE * SIZE);
        }
        for (int k = 0; k < 3 * SIZE * SIZE; k++) {
            const double a = all.rgb[k], b = sum.rgb[k];
            off += fabs(a - b) / (3 * SIZE * SIZE * mean);
            worst = maximum(worst, fabs(a - b) / (b + 0.3 * mean));
            by_order = maximum(by_order, fabs(a - (double)turned.rgb[k]) / (b + 0.01 * mean));
        }
        print_message(
            "%s: %.2f %% off the sum of all alone, worst pixel %.1f %%; by order %.4f %%\n",
            uneven ? "uneven" : "even", 100 * off, 100 * worst, 100 * by_order);
        good = within(off, 0.02, NULL, "%s, off", uneven ? "uneven" : "even") && good;
        good = within(worst, 0.1, NULL, "%s, worst", uneven ? "uneven" : "even") && good;
        good = good && by_order <= 1e-4;
        picture_free(&all);
        picture_free(&turned);
        picture_free(&sum);
    }
    assert_true(good);
}

// Lamps first to last - 1 of 40, all but the first 12 in small boxes of their own.
static void render_walled(gpu_test *t, picture *p, int first, int last)
{
    const tyn_medium medium = grey_medium(0.1f, 0, 0);
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_scene_init(scene);
    scene_add_box(scene, &medium, (float[]){-2, -2, -2}, (float[]){2, 2, 2}, NULL, NULL);
    uint32_t black = solids_material(scene, (float[]){0, 0, 0}, (float[]){0, 0, 0});
    for (int i = 0; i < 40; i++) {
        float x = -1.75f + 0.5f * (float)(i % 8), y = -1.6f + 0.8f * (float)(i / 8), half = 0.05f;
        if (i >= 12) {
            solids_box(scene, (float[]){x - half, y - half, -half},
                       (float[]){x + half, y + half, half}, 0, false, black);
        }
        if (i >= first && i < last) {
            float strength = 1 - 0.005f * (float)i; // kernels have them in this order
            scene->lights[scene->num_lights++] =
                (tyn_light){.kind = TYN_LIGHT_POINT,
                            .color = {strength, strength, strength},
                            .position = {x, y, 0}};
        }
    }
    solids_hierarchy(scene, 4);
    tyn_view view = {.width = 0};
    view_orthographic(&view, (float[]){0, 0, 0}, 0, 0, -1, (float[]){0, 1, 0}, 2, SIZE);
    picture_render(p, t->dev, "single", scene, &view, "raymarch.sparse=0", 0);
    tyn_scene_finish(scene);
    free(scene);
}

static void own_walls(void **state)
{
    picture all, first, second;
    render_walled(*state, &all, 0, 40);
    render_walled(*state, &first, 0, 20);
    render_walled(*state, &second, 20, 40);
    double sum = 0, off = 0;
    for (int k = 0; k < 3 * SIZE * SIZE; k++) {
        const double parts = (double)first.rgb[k] + second.rgb[k];
        sum += parts;
        off += fabs(all.rgb[k] - parts);
    }
    print_message("40 lamps with walls of their own: %.2f %% off the sum of twice 20\n",
                  100 * off / sum);
    assert_within(off / sum, 7e-4, NULL);
    picture_free(&all);
    picture_free(&first);
    picture_free(&second);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(alone_or_not),
        cmocka_unit_test(own_walls),
    };
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
