// impostor.c -- a march seen by another camera, and when one is made again: the views of whole frames.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "path_run.h"
#include "picture.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SIZE = 64 };

static void look(tyn_view *view, double degrees, double away)
{
    const double a = degrees * M_PI / 180;
    view_perspective(view,
                     (float[]){(float)(0.5 + away * cos(a)), 0.6f, (float)(0.5 + away * sin(a))},
                     (float[]){0.5f, 0.5f, 0.5f}, 0.36f, SIZE);
}

static void make_cloud(tyn_scene *scene)
{
    enum { N = 16 };
    static float density[N * N * N];
    const uint32_t size[3] = {N, N, N};
    for (int i = 0; i < N * N * N; i++) {
        double r2 = 0;
        const int at[3] = {i % N, i / N % N, i / N / N};
        for (int a = 0; a < 3; a++) {
            const double x = (at[a] + 0.5) / N - 0.5;
            r2 += x * x;
        }
        density[i] = (float)fmax(0, 1 - 5 * r2);
    }
    tyn_medium medium = grey_medium(8, 0.5f, 0.4f);
    tyn_scene_init(scene);
    scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, size, density);
    scene_add_sun(scene, 0.3f, -0.8f, 0.5f, 1, 1, 1);
}

static bool has_run(tyn_offline *off, const char *node)
{
    tyn_report report;
    tyn_offline_report(off, &report);
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        if (!strcmp(report.nodes[i].name, node)) {
            return !strcmp(report.nodes[i].state, "ran");
        }
    }
    return false;
}

static double apart(const float *a, const float *b)
{
    double sum = 0, off = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        off += fabs((double)a[4 * i + 1] - (double)b[4 * i + 1]);
        sum += (double)b[4 * i + 1];
    }
    return off / sum;
}

// From where the march was made the picture is the march, but for its own pixels; a few degrees aside it is a little off. Over a
// background, too.
static void pictures(void **state)
{
    gpu_test *t = *state;
    for (int sky = 0; sky < 2; sky++) {
        tyn_scene scene;
        tyn_view view = {.outputs = TYN_OUTPUT_RADIANCE};
        make_cloud(&scene);
        if (sky) {
            scene_set_sky(&scene, 0.2f);
        }
        tyn_offline *off = scene_open(t->dev, "single", "impostor.on=1 impostor.angle=20"),
                    *exact = scene_open(t->dev, "single", NULL);
        double error[2];
        for (int k = 0; k < 2; k++) {
            look(&view, 30 + 4 * k, 3);
            offline_frame(off, &scene, &view);
            offline_frame(exact, &scene, &view);
            assert_true(has_run(off, "raymarch") == (k == 0) && has_run(off, "impostor"));
            error[k] = apart(tyn_offline_output(off, TYN_OUTPUT_RADIANCE),
                             tyn_offline_output(exact, TYN_OUTPUT_RADIANCE));
        }
        printf("%s: from there %.2f %%, 4 degrees aside %.2f %%\n", sky ? "sky" : "black",
               100 * error[0], 100 * error[1]);
        tyn_offline_destroy(&off);
        tyn_offline_destroy(&exact);
        tyn_scene_finish(&scene);
        assert_within(error[0], 0.02, NULL);
        assert_within(error[1], 0.06, NULL);
    }
}

// A camera that goes around by 36 degrees in steps of 0.8, and away by a factor of 2 in steps of 4 %: marches, and no
// view from which the media are seen by more than 5 degrees or 20 % otherwise than they were marched.
static void criteria(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    tyn_view view = {.outputs = TYN_OUTPUT_RADIANCE};
    make_cloud(&scene);
    tyn_offline *off = scene_open(t->dev, "single", "impostor.on=1");
    int marches[2] = {0, 0};
    double at = 0, most[2] = {0, 0};
    for (int k = 0; k <= 45; k++) {
        const double degrees = 0.8 * k;
        look(&view, degrees, 3);
        offline_frame(off, &scene, &view);
        if (has_run(off, "raymarch")) {
            marches[0]++;
            at = degrees;
        }
        most[0] = maximum(most[0], degrees - at);
    }
    double away = 3, from = 3;
    for (; away < 6; away *= 1.04) {
        look(&view, 36, away);
        offline_frame(off, &scene, &view);
        if (has_run(off, "raymarch")) {
            marches[1]++;
            from = away;
        }
        most[1] = maximum(most[1], away / from - 1);
    }
    printf("marches: %d in 46 views around, %d in 18 away; largest angle %.1f, distance %.0f %%\n",
           marches[0], marches[1], most[0], 100 * most[1]);
    assert_true(most[0] <= 5 && most[1] <= 0.2);
    assert_true(marches[0] >= 8 && marches[0] <= 16 && marches[1] <= 6);
    // Nothing but the light has changed: it is marched again.
    scene.lights[0].color[0] = 0.5f;
    offline_frame(off, &scene, &view);
    assert_true(has_run(off, "raymarch"));
    // From within, and where that is off, every view is marched.
    for (int k = 0; k < 2; k++) {
        look(&view, 30 + k, 0.3);
        offline_frame(off, &scene, &view);
        assert_true(has_run(off, "raymarch") && !has_run(off, "impostor"));
    }
    tyn_offline_destroy(&off);
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pictures), cmocka_unit_test(criteria)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
