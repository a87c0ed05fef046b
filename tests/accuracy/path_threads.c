// path_threads.c -- pictures, probes and balances of `path` do not depend on how many threads there are, but for rounding.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "picture.h"
#include "sample_scene.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// Means of n samples are sums in any order. Each of n steps rounds by half an epsilon at most, some up and some down, of a mean
// that is off by the samples' deviation at most: four times the deviation of all.
static double rounding(uint32_t samples)
{
    return 4 * sqrt(samples) * 0.5 * (double)FLT_EPSILON;
}

// Largest difference of a pixel, in units of its mean and its samples' deviation.
static double difference(const picture *a, const picture *b, uint32_t samples)
{
    double most = 0;
    for (uint32_t i = 0; i < 3 * a->width * a->height; i++) {
        const double scale = fabs((double)a->rgb[i]) + sqrt(samples) * (double)a->se[i];
        const double off = fabs((double)a->rgb[i] - (double)b->rgb[i]);
        most = maximum(most, off > 0 ? off / scale : 0);
    }
    return most;
}

static void judge(gpu_test *t, const char *name, uint32_t side, uint32_t samples)
{
    static const char *const threads[] = {"path.threads=16384", "path.threads=262144"};
    tyn_scene scene;
    sample_scene_load(&scene, name, t);
    const tyn_view view = {.width = side, .height = side, .camera = scene.cameras[0], .seed = 1};
    picture few = {0};
    picture_render(&few, t->dev, "path", &scene, &view, "path.threads=1024", samples);
    for (int i = 0; i < 2; i++) {
        picture p = {0};
        picture_render(&p, t->dev, "path", &scene, &view, threads[i], samples);
        assert_true(within(difference(&few, &p, samples), rounding(samples), BOUND_ROUNDING,
                           "%s: largest difference of a pixel", name));
        picture_free(&p);
    }
    picture_free(&few);
    tyn_scene_finish(&scene);
}

static void medium(void **state)
{
    judge(*state, "smoke-sky", 48, 16);
}

static void surfaces(void **state)
{
    judge(*state, "room", 48, 16);
}

// Threads share the samples of a pixel.
static void few_pixels(void **state)
{
    judge(*state, "cube", 4, 4096);
}

// An output of a view without a picture.
static void take(gpu_test *t, const tyn_scene *scene, const tyn_view *view, tyn_output output,
                 void *to, size_t size)
{
    tyn_view own = *view;
    own.outputs = output;
    tyn_offline *off = scene_open(t->dev, "path", NULL);
    offline_frame(off, scene, &own);
    memcpy(to, tyn_offline_output(off, output), size);
    tyn_offline_destroy(&off);
}

// What a card that holds so many threads is given to do, done by this device.
static void as_a_card(void **state)
{
    enum { SAMPLES = 8 };
    static const float points[2][3] = {{0.5f, 0.5f, 0.5f}, {0.9f, 0.2f, 0.4f}};
    gpu_test *t = *state;
    const tyn_capacity own = t->dev->capacity;
    tyn_scene scene;
    sample_scene_load(&scene, "cube", t);
    tyn_view view = {.width = 1,
                     .height = 1,
                     .camera = scene.cameras[0],
                     .num_samples = SAMPLES,
                     .points = points,
                     .num_points = 2};
    tyn_balance balances[2];
    tyn_probe_result probes[2][2];
    for (int i = 0; i < 2; i++) {
        t->dev->capacity =
            i ? (tyn_capacity){.short_loops = own.short_loops, .threads = 262144} : own;
        take(t, &scene, &view, TYN_OUTPUT_BALANCE, &balances[i], sizeof balances[i]);
        view.num_samples = 1000 * SAMPLES;
        take(t, &scene, &view, TYN_OUTPUT_PROBE, probes[i], sizeof probes[i]);
        view.num_samples = SAMPLES;
    }
    t->dev->capacity = own;
    for (int c = 0; c < 3; c++) {
        const double escaped = balances[1].escaped[c] / balances[0].escaped[c],
                     entering = balances[1].entering[c] / balances[0].entering[c];
        assert_within(fabs(escaped - 1), 1e-5, BOUND_ROUNDING);
        assert_within(fabs(entering - 1), 1e-5, BOUND_ROUNDING);
        for (int p = 0; p < 2; p++) {
            const double fluence =
                (double)probes[1][p].fluence[c] / (double)probes[0][p].fluence[c];
            assert_within(fabs(fluence - 1), 1e-5, BOUND_ROUNDING);
        }
    }
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(medium),
        cmocka_unit_test(surfaces),
        cmocka_unit_test(few_pixels),
        cmocka_unit_test(as_a_card),
    };
    setvbuf(stdout, NULL, _IOLBF, 0);
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
