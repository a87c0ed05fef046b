// pop_references.c -- `pop` against the reference images with surfaces (pbrt-v3 in 64-bit): the room with fog that is
// lit through a hole in its ceiling, and the sphere of fog with an emitting sphere in its middle.
#include "bound.h"
#include "gpu_test.h"
#include "reference_scenes.h"
#include "skip.h"
#include "todo.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void room(void **state)
{
    gpu_test *t = *state;
    picture reference = {0}, p;
    if (!picture_reference(&reference, "room")) {
        skip_without("room");
    }
    tyn_scene scene;
    tyn_view view = {0};
    reference_room(&scene, &view);
    picture_render(&p, t->dev, "pop", &scene, &view, NULL, 0);
    const picture_error e = picture_compare(&p, &reference, 8);
    print_message("room: error %.2f %% (rel_l1 %.2f, noise %.2f), bias %+.2f %%\n",
                  100 * e.reported, 100 * e.rel_l1, 100 * e.noise, 100 * e.bias);
    for (uint32_t c = 0; c < 3; c++) {
        double sum[2] = {0};
        for (uint32_t i = 0; i < view.width * view.height; i++) {
            sum[0] += (double)p.rgb[3 * i + c];
            sum[1] += (double)reference.rgb[3 * i + c];
        }
        print_message("    channel %u: mean %+.2f %%\n", c, 100 * (sum[0] / sum[1] - 1));
    }
    assert_within(e.rel_l1, 0.12, NULL);
    assert_within(fabs(e.bias), 0.012, NULL);
    picture_free(&p);
    picture_free(&reference);
    tyn_scene_finish(&scene);
}

// Means of the picture, and of rings.
static void spheres(void **state)
{
    gpu_test *t = *state;
    enum { RINGS = 12 };
    for (int k = 0; k < 2; k++) {
        const float g = k ? 0.8f : 0.2f;
        char name[64];
        snprintf(name, sizeof name, "sphere_em_g%.2f", (double)g);
        picture reference = {0}, p;
        if (!picture_reference(&reference, name)) {
            skip_without(name);
        }
        tyn_scene scene;
        tyn_view view = {0};
        reference_sphere(&scene, &view, g);
        picture_render(&p, t->dev, "pop", &scene, &view, NULL, 0);
        for (uint32_t c = 0; c < 3; c++) {
            double sum[2][RINGS] = {{0}}, mean[2] = {0}, off = 0;
            const uint32_t n = view.width;
            for (uint32_t i = 0; i < n * n; i++) {
                double x = (i % n + 0.5) / n - 0.5, y = (i / n + 0.5) / n - 0.5;
                int ring = (int)(2 * RINGS * sqrt(x * x + y * y));
                for (int w = 0; w < 2; w++) {
                    double value = (double)(w ? &reference : &p)->rgb[3 * i + c];
                    mean[w] += value;
                    sum[w][ring < RINGS ? ring : RINGS - 1] += value;
                }
            }
            print_message("%s %u: mean %+.1f %%; rings", name, c, 100 * (mean[0] / mean[1] - 1));
            for (int i = 0; i < RINGS; i++) {
                off += fabs(sum[0][i] - sum[1][i]) / mean[1];
                print_message(" %+.0f", 100 * (sum[0][i] / fmax(sum[1][i], 1e-9) - 1));
            }
            print_message(" %%, rel_l1 %.1f %%\n", 100 * off);
            // Nothing is missing, but at g 0.8 the profile is far too even.
            assert_true(
                within(fabs(mean[0] / mean[1] - 1), k ? 0.04 : 0.03, NULL, "%s, mean", name));
            assert_true(todo_if(
                k == 1, within(off, 0.08, NULL, "%s, rings", name),
                "emitters light the medium as virtual point lights, which are seen without the "
                "forward lobe of their own",
                "%s, rings of channel %u within 8 %%", name, c));
        }
        picture_free(&p);
        picture_free(&reference);
        tyn_scene_finish(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(room), cmocka_unit_test(spheres)};
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return run_cases(tests, gpu_setup, gpu_teardown);
}
