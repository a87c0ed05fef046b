// path_room.c -- `path` with surfaces against references: the room with fog and the black emitting spheres in
// fog (pbrt-v3 in 64-bit), slabs over a Lambertian ground (DISORT).
//
// Asserted: means within 3 combined standard errors; z of 8x8 blocks, or of rings, has an RMS below 1.5. TYN_LONG=N
// takes N times the samples.
#include "path_run.h"
#include "gpu_test.h"
#include "npy.h"
#include "solids.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const float BLACK[3] = {0, 0, 0};

static path_run runs;

static int setup(void **state)
{
    int result = gpu_setup(state);
    if (result == 0) {
        path_run_open(&runs, ((gpu_test *)*state)->dev);
    }
    return result;
}

static int teardown(void **state)
{
    path_run_close(&runs);
    return gpu_teardown(state);
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// ---- room -------------------------------------------------------------------------------------

static void make_room(tyn_scene *scene)
{
    uint32_t grey = solids_material(scene, (float[]){0.75f, 0.75f, 0.75f}, BLACK);
    uint32_t red = solids_material(scene, (float[]){0.75f, 0.15f, 0.10f}, BLACK);
    solids_quad(scene, (float[]){0, 0, 0}, (float[]){0, 0, 4}, (float[]){4, 0, 0}, grey);
    solids_quad(scene, (float[]){0, 0, 0}, (float[]){0, 3, 0}, (float[]){0, 0, 4}, red);
    solids_quad(scene, (float[]){4, 0, 0}, (float[]){0, 0, 4}, (float[]){0, 3, 0}, grey);
    solids_quad(scene, (float[]){0, 0, 0}, (float[]){4, 0, 0}, (float[]){0, 3, 0}, grey);
    solids_quad(scene, (float[]){0, 0, 4}, (float[]){0, 3, 0}, (float[]){4, 0, 0}, grey);
    // The ceiling, around the hole.
    solids_quad(scene, (float[]){0, 3, 0}, (float[]){4, 0, 0}, (float[]){0, 0, 1.75f}, grey);
    solids_quad(scene, (float[]){0, 3, 2.25f}, (float[]){4, 0, 0}, (float[]){0, 0, 1.75f}, grey);
    solids_quad(scene, (float[]){0, 3, 1.75f}, (float[]){1.5f, 0, 0}, (float[]){0, 0, 0.5f}, grey);
    solids_quad(scene, (float[]){2, 3, 1.75f}, (float[]){2, 0, 0}, (float[]){0, 0, 0.5f}, grey);
    tyn_medium fog = grey_medium(0.3f, 0.02f, 0.6f);
    scene_add_box(scene, &fog, (float[]){0, 0, 0}, (float[]){4, 3, 4}, NULL, NULL);
    float to_hole[3] = {0.55f, -1.5f, 0}, length = sqrtf(0.55f * 0.55f + 1.5f * 1.5f);
    scene_add_lamp(scene, (float[]){1.2f, 4.5f, 2}, 40);
    tyn_light *l = &scene->lights[0];
    l->kind = TYN_LIGHT_SPOT;
    l->cos_inner = l->cos_outer = cosf(20 * (float)M_PI / 180);
    for (int a = 0; a < 3; a++) {
        l->direction[a] = to_hole[a] / length;
    }
}

static void room(void **state)
{
    (void)state;
    picture reference = {0}, p = {0};
    if (!picture_reference(&reference, "room")) {
        skip();
    }
    tyn_scene scene;
    tyn_scene_init(&scene);
    make_room(&scene);
    solids_hierarchy(&scene, 2);
    tyn_view view = {0};
    view_perspective(&view, (float[]){3.6f, 1.5f, 3.8f}, (float[]){1.8f, 1.3f, 1.6f},
                     tanf((float)M_PI / 6), 64);
    const uint32_t samples = path_effort(40);
    double start = seconds();
    path_run_picture(&runs, &p, &scene, &view, samples);
    double took = seconds() - start;
    printf("room: %.1f s, %.0f ns a path\n", took, 1e9 * took / (64 * 64 * samples));
    for (uint32_t c = 0; c < 3; c++) {
        picture_score s = picture_z(&p, &reference, 8, c);
        printf("room %u: bias %+.3f %% +- %.3f (z %+.2f), blocks: RMS of z %.2f, largest %.2f\n", c,
               100 * s.bias, 100 * s.bias_se, s.bias / s.bias_se, s.rms, s.largest);
        assert_true(fabs(s.bias) <= 3 * s.bias_se);
        assert_true(s.rms < 1.5);
    }
    picture_free(&p);
    picture_free(&reference);
    tyn_scene_finish(&scene);
}

// ---- spheres ----------------------------------------------------------------------------------

enum { RINGS = 12 };

// Means over rings of equal width and their z.
static void check_rings(const picture *p, const picture *reference, float g)
{
    const uint32_t n = p->width;
    for (uint32_t c = 0; c < 3; c++) {
        double off[RINGS] = {0}, var[RINGS] = {0}, sum[RINGS] = {0};
        for (uint32_t i = 0; i < n * n; i++) {
            double x = (i % n + 0.5) / n - 0.5, y = (i / n + 0.5) / n - 0.5;
            int ring = (int)(2 * RINGS * sqrt(x * x + y * y) * 0.999);
            size_t at = 3 * i + c;
            if (ring < RINGS) {
                off[ring] += (double)p->rgb[at] - (double)reference->rgb[at];
                sum[ring] += reference->rgb[at];
                var[ring] += (double)p->se[at] * p->se[at];
                var[ring] += (double)reference->se[at] * reference->se[at];
            }
        }
        double z2 = 0;
        printf("sphere g %.1f %u, rings: z", (double)g, c);
        for (int i = 0; i < RINGS; i++) {
            double z = var[i] > 0 ? off[i] / sqrt(var[i]) : 0;
            printf(" %+.1f", z);
            z2 += z * z;
            assert_true(fabs(z) <= 4);
        }
        printf(" (RMS %.2f)\n", sqrt(z2 / RINGS));
        assert_true(z2 / RINGS < 1.5 * 1.5);
    }
}

static void spheres(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        const float g = k ? 0.8f : 0.2f;
        char name[64];
        snprintf(name, sizeof name, "sphere_em_g%.2f", (double)g);
        picture reference = {0}, p = {0};
        if (!picture_reference(&reference, name)) {
            skip();
        }
        tyn_scene scene;
        tyn_scene_init(&scene);
        const float l = 1 / ((float)M_PI * 0.01f);
        uint32_t emitter = solids_material(&scene, BLACK, (float[]){l, l, l});
        solids_sphere(&scene, (float[]){0, 0, 0}, 0.1f, 32, false, emitter);
        solids_hierarchy(&scene, 2);
        tyn_medium fog = grey_medium(1, 0, g);
        fog.sigma_s[0] = 0.8f;
        fog.sigma_s[2] = 1.3f;
        tyn_shape *shape = scene_add_box(&scene, &fog, (float[]){-2.5f, -2.5f, -2.5f},
                                         (float[]){2.5f, 2.5f, 2.5f}, NULL, NULL);
        shape->kind = TYN_SHAPE_SPHERE;
        tyn_view view = {0};
        view_orthographic(&view, (float[]){0, 0, 0}, 0, -1, 0, (float[]){0, 0, 1}, 2.75f, 64);
        const uint32_t samples = path_effort(64);
        double start = seconds();
        path_run_picture(&runs, &p, &scene, &view, samples);
        double took = seconds() - start;
        printf("%s: %.1f s, %.0f ns a path\n", name, took, 1e9 * took / (64 * 64 * samples));
        for (uint32_t c = 0; c < 3; c++) {
            picture_score s = picture_z(&p, &reference, 8, c);
            printf("sphere g %.1f %u: bias %+.3f %% +- %.3f (z %+.2f), blocks: RMS of z %.2f\n",
                   (double)g, c, 100 * s.bias, 100 * s.bias_se, s.bias / s.bias_se, s.rms);
            assert_true(fabs(s.bias) <= 3 * s.bias_se);
        }
        check_rings(&p, &reference, g);
        picture_free(&p);
        picture_free(&reference);
        tyn_scene_finish(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(room),
        cmocka_unit_test(spheres),
    };
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, setup, teardown);
}
