// path_room.c -- `path` with surfaces against references: the room with fog and the black emitting spheres in
// fog (pbrt-v3 in 64-bit), slabs over a Lambertian ground (DISORT).
//
// Asserted: means within 3 combined standard errors; z of 8x8 blocks, or of rings, has an RMS below 1.5. TYN_LONG=N
// takes N times the samples.
#include "path_run.h"
#include "reference_scenes.h"
#include "skip.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// ---- room -------------------------------------------------------------------------------------

static void room(void **state)
{
    path_run *runs = *state;
    picture reference = {0}, p = {0};
    if (!picture_reference(&reference, "room")) {
        skip_without("room");
    }
    tyn_scene scene;
    tyn_view view = {0};
    reference_room(&scene, &view);
    const uint32_t samples = path_effort(40);
    double start = seconds();
    path_run_picture(runs, &p, &scene, &view, samples);
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
    path_run *runs = *state;
    for (int k = 0; k < 2; k++) {
        const float g = k ? 0.8f : 0.2f;
        char name[64];
        snprintf(name, sizeof name, "sphere_em_g%.2f", (double)g);
        picture reference = {0}, p = {0};
        if (!picture_reference(&reference, name)) {
            skip_without(name);
        }
        tyn_scene scene;
        tyn_view view = {0};
        reference_sphere(&scene, &view, g);
        const uint32_t samples = path_effort(64);
        double start = seconds();
        path_run_picture(runs, &p, &scene, &view, samples);
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
    return run_cases(tests, path_run_setup, path_run_teardown);
}
