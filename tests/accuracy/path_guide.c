// path_guide.c -- paths whose directions are guided, by a light or by pop's field, against those of the phase function alone: the
// same mean, and less noise.
//
// Asserted for every scene: sums differ by at most 3.5 standard errors, z of 8x8 blocks has an RMS below 1.4, and the variance is at
// most the share of the plain paths' that is given, a fifth above what lavapipe's samples have (a tenth where it is about 1). 12 s on two cores.
#include "bound.h"
#include "gpu_test.h"
#include "path_run.h"
#include "picture.h"
#include "sample_scene.h"

enum { SIDE = 32, BLOCK = 8 };

static double variance(const picture *p)
{
    double sum = 0;
    for (uint32_t i = 0; i < 3 * p->width * p->height; i++) {
        sum += (double)p->se[i] * (double)p->se[i];
    }
    return sum;
}

// `most`: of the plain paths' variance, by a light and by the field.
static void judge(gpu_test *t, const char *name, const tyn_scene *scene, const tyn_view *view,
                  uint32_t samples, const double most[2])
{
    static const char *const guides[] = {"path.guide=1", "path.guide=2"};
    picture plain = {0}, guided = {0};
    tyn_view own = *view;
    own.seed = 1;
    picture_render(&plain, t->dev, "path", scene, &own, "path.guide=0", samples);
    for (int i = 0; i < 2; i++) {
        own.seed = 2 + (uint32_t)i;
        picture_render(&guided, t->dev, "path", scene, &own, guides[i], samples);
        for (uint32_t c = 0; c < 3; c++) {
            const picture_score z = picture_z(&guided, &plain, BLOCK, c);
            assert_true(within(z.bias / z.bias_se, 3.5, "of noise, which may be small",
                               "%s, %s, channel %u: z of the sum", name, guides[i], c));
            assert_true(
                within(z.rms, 1.4, NULL, "%s, %s, channel %u: z of blocks", name, guides[i], c));
        }
        assert_true(within(variance(&guided) / variance(&plain), most[i], NULL,
                           "%s, %s: variance, of the plain paths'", name, guides[i]));
        picture_free(&guided);
    }
    picture_free(&plain);
}

static void sample(gpu_test *t, const char *name, uint32_t samples, const double most[2])
{
    tyn_scene scene;
    sample_scene_load(&scene, name, t);
    const tyn_view view = {
        .width = SIDE, .height = SIDE, .camera = scene.cameras[0], .no_background = true};
    judge(t, name, &scene, &view, samples, most);
    tyn_scene_finish(&scene);
}

// Homogeneous, seen from its side: light comes back into the sun's lobe late.
static void cube(void **state)
{
    tyn_scene scene = {0};
    tyn_view view = {.no_background = true};
    const tyn_medium medium = grey_medium(4, 0, 0.9f);
    scene_add_box(&scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
    scene_add_sun(&scene, 1, 0, 0, 1, 1, 1);
    view_orthographic(&view, (float[]){0.5f, 0.5f, 0.5f}, 0, -1, 0, (float[]){0, 0, 1}, 0.5f, SIDE);
    judge(*state, "cube, g 0.9", &scene, &view, 256, (double[]){0.08, 0.03});
    tyn_scene_finish(&scene);
}

static void smoke(void **state)
{
    sample(*state, "smoke", 256, (double[]){0.46, 0.37});
}

static void sky(void **state)
{
    sample(*state, "smoke-sky", 256, (double[]){0.85, 0.55});
}

// Three channels of unequal absorption, under a map of strong contrast.
static void contrast(void **state)
{
    sample(*state, "plume-contrast", 128, (double[]){1.1, 1.1});
}

// Among surfaces a light guides, with the field's setting as well.
static void cave(void **state)
{
    sample(*state, "vpl-cave", 64, (double[]){0.8, 0.85});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cube),     cmocka_unit_test(smoke), cmocka_unit_test(sky),
        cmocka_unit_test(contrast), cmocka_unit_test(cave),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
