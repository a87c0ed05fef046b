// balance.c -- where the energy goes, in every sample scene: what enters and is emitted is absorbed or leaves,
// within 2 %.
//
// `path` draws what comes in, what is absorbed and what leaves by points of their own, so that its imbalance is noise:
// it is averaged until its standard error is below 1 %, and may be 3 of these. TYN_LONG=1 does so for the scenes that
// take minutes.
#include "gpu_test.h"
#include "path_run.h"
#include <tyndall/io.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct sample_scene {
    const char *name;
    uint32_t samples; // of path, at once: about what its standard error needs
    bool slow;        // hundreds of scatterings a path, or a small sun that few paths find
} scenes[] = {
    {"room", 4, false},           {"fog-hall", 4, false},      {"lantern", 4, false},
    {"cornell-smoke", 8, false},  {"vpl-cave", 2, false},      {"many-lights", 6, false},
    {"cube", 16, false},          {"cube-oblique", 24, false}, {"slab", 32, false},
    {"slab-60", 32, false},       {"sphere", 48, false},       {"furnace", 8, false},
    {"furnace-smoke", 32, false}, {"smoke", 40, false},        {"smoke-sky", 128, true},
    {"cloud", 48, false},         {"cloud-sunset", 400, true}, {"plume-contrast", 48, false},
    {"two-media", 48, false},     {"milk", 400, true},
};
enum { NUM_SCENES = sizeof scenes / sizeof scenes[0], MOST_BATCHES = 6 };

static void load(gpu_test *t, const char *name, tyn_scene *scene)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s.gltf", TYN_SAMPLE_SCENES, name);
    tyn_scene_init(scene);
    assert_int_equal(tyn_scene_load(scene, path, NULL, &t->log), TYN_OK);
    assert_int_equal(tyn_surfaces_build_nodes(&scene->surfaces, &t->log), TYN_OK);
}

static double worst_of(const double v[3])
{
    return fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
}

static void pop(void **state)
{
    gpu_test *t = *state;
    bool good = true;
    for (int i = 0; i < NUM_SCENES; i++) {
        tyn_scene *scene = malloc(sizeof *scene);
        load(t, scenes[i].name, scene);
        const double off = scene_imbalance(t->dev, "pop", scene, NULL);
        print_message("%-15s imbalance %.2f %%\n", scenes[i].name, 100 * off);
        good = good && off <= 0.02;
        tyn_scene_finish(scene);
        free(scene);
    }
    assert_true(good);
}

// Runs of their own, until the mean's standard error is small enough.
static uint32_t average(path_run *runs, const tyn_scene *scene, uint32_t samples, double mean[3],
                        double se[3])
{
    double sum[3] = {0}, var[3] = {0};
    for (uint32_t n = 1;; n++) {
        const tyn_balance *b = path_run_balance(runs, scene, samples);
        for (int c = 0; c < 3; c++) {
            sum[c] += b->imbalance[c];
            var[c] += b->imbalance_se[c] * b->imbalance_se[c];
            mean[c] = sum[c] / n;
            se[c] = sqrt(var[c]) / n;
        }
        if (worst_of(se) <= 0.01 || n == MOST_BATCHES) {
            return n * samples;
        }
    }
}

static void path(void **state)
{
    gpu_test *t = *state;
    bool good = true;
    path_run runs;
    path_run_open(&runs, t->dev);
    for (int i = 0; i < NUM_SCENES; i++) {
        if (scenes[i].slow && !getenv("TYN_LONG")) {
            print_message("%-15s skipped (TYN_LONG)\n", scenes[i].name);
            continue;
        }
        tyn_scene *scene = malloc(sizeof *scene);
        load(t, scenes[i].name, scene);
        double mean[3], se[3];
        const uint32_t samples = average(&runs, scene, scenes[i].samples, mean, se);
        print_message("%-15s %4u samples, imbalance", scenes[i].name, samples);
        for (int c = 0; c < 3; c++) {
            print_message(" %+.2f +- %.2f %%", 100 * mean[c], 100 * se[c]);
            good = good && se[c] <= 0.01 && fabs(mean[c]) <= fmax(0.02, 3 * se[c]);
        }
        print_message("\n");
        tyn_scene_finish(scene);
        free(scene);
    }
    path_run_close(&runs);
    assert_true(good);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pop), cmocka_unit_test(path)};
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
