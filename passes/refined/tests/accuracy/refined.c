// refined.c -- method `refined` against kept references by `path`: few samples halve the error of `pop`, many are the truth, and the
// picture says how far it is off.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "path_run.h"
#include "picture.h"
#include "sample_scene.h"
#include <math.h>
#include <stdlib.h>

enum { SIDE = 64, BLOCK = 8 };

typedef struct refined_case {
    const char *name, *grid;
    uint32_t samples; // of each square of grid x grid pixels
    double most;      // of pop's error
} refined_case;

// Relative L1 that a picture's own standard errors stand for.
static double told(const picture *p)
{
    double sum = 0, all = 0;
    for (uint32_t i = 0; i < 3 * p->width * p->height; i++) {
        sum += (double)p->se[i];
        all += fabs((double)p->rgb[i]);
    }
    return 0.7979 * sum / all;
}

static tyn_view view_of(const tyn_scene *scene)
{
    return (tyn_view){
        .width = SIDE, .height = SIDE, .camera = scene->cameras[0], .no_background = true};
}

static void judge(gpu_test *t, const char *name, uint32_t reference_samples,
                  const refined_case *cases, int count)
{
    tyn_scene scene;
    sample_scene_load(&scene, name, t);
    tyn_view view = view_of(&scene);
    picture truth = {0}, pop = {0}, refined = {0};
    path_reference(&truth, t->dev, &scene, &view, reference_samples);
    picture_render(&pop, t->dev, "pop", &scene, &view, NULL, 0);
    const double before = picture_compare(&pop, &truth, BLOCK).reported;
    double last = 1;
    for (int i = 0; i < count; i++) {
        view.seed = 3;
        picture_render(&refined, t->dev, "refined", &scene, &view, cases[i].grid, cases[i].samples);
        const double estimate = told(&refined);
        free(refined.se); // else it would be taken for noise of the picture
        refined.se = NULL;
        const double after = picture_compare(&refined, &truth, BLOCK).reported;
        assert_true(
            within(after / before, cases[i].most, NULL, "%s, of pop's error", cases[i].name));
        assert_true(within(maximum(estimate / after, after / estimate), 3,
                           "of estimates, which noise may double", "%s, estimate against error",
                           cases[i].name));
        assert_true(after / before <= 1.05 * last);
        last = after / before;
        picture_free(&refined);
    }
    picture_free(&pop);
    picture_free(&truth);
    tyn_scene_finish(&scene);
}

static void few_samples(void **state)
{
    static const refined_case room[] = {
        {"room, 2 samples a pixel", "refine.grid=2", 8, 1.1},
        {"room, 8", "refine.grid=1", 8, 0.7},
        {"room, 32", "refine.grid=1", 32, 0.45},
    };
    static const refined_case smoke[] = {
        {"smoke, 8 samples a pixel", "refine.grid=1", 8, 0.95},
        {"smoke, 32", "refine.grid=1", 32, 0.75},
    };
    judge(*state, "room", 1024, room, 3);
    judge(*state, "smoke", 1024, smoke, 2);
}

// Nothing biased is left: single pixels are those of `path` within the noise of both, and their sum as near as that of as many
// samples of `path`.
static void many_samples(void **state)
{
    enum { SAMPLES = 1024 };
    gpu_test *t = *state;
    tyn_scene scene;
    sample_scene_load(&scene, "room", t);
    tyn_view view = view_of(&scene);
    view.width = view.height = 32;
    picture truth = {0}, path = {0}, refined = {0};
    path_reference(&truth, t->dev, &scene, &view, 4 * SAMPLES);
    view.seed = 3;
    picture_render(&path, t->dev, "path", &scene, &view, NULL, SAMPLES);
    picture_render(&refined, t->dev, "refined", &scene, &view, "refine.bias=0", SAMPLES);
    const picture_error pixels = picture_compare(&refined, &truth, 1);
    const double sum = fabs(picture_compare(&refined, &truth, 32).bias);
    assert_within(pixels.rel_l1 / pixels.noise, 1.15, NULL);
    assert_within(sum / picture_compare(&path, &truth, 32).noise, 3, BOUND_NOISE);
    picture_free(&refined);
    picture_free(&path);
    picture_free(&truth);
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(few_samples),
                                       cmocka_unit_test(many_samples)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
