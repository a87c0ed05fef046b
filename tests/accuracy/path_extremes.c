// path_extremes.c -- `path` where few paths carry the light: media so thin that next to none scatters, and lobes
// so narrow that light meets the eye by one wide turn among many small ones. Both have closed forms.
//
// Asserted: means of pictures within 4 standard errors, and how large these may be.
#include "path_run.h"
#include "gpu_test.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 16 };

static double phase_function(double g, double mu)
{
    return (1 - g * g) / (4 * M_PI * pow(1 + g * g - 2 * g * mu, 1.5));
}

// Of a face-on view of the middle of the unit cube, lit from above; `radiance` of its middle.
static void check(gpu_test *t, const char *name, const tyn_medium *medium, const uint32_t size[3],
                  const float *grid, uint32_t samples, double most_se, const double radiance[3])
{
    tyn_scene scene;
    tyn_scene_init(&scene);
    scene_add_box(&scene, medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, size, grid);
    scene_add_sun(&scene, 0, -1, 0, 1, 1, 1);
    tyn_view view = {0};
    view_orthographic(&view, (float[]){0.5f, 0.5f, 0.5f}, 0, 0, -1, (float[]){0, 1, 0}, 0.25f,
                      SIZE);
    view.no_background = true;
    path_run run;
    path_run_open(&run, t->dev);
    run.kept = false; // `path` is what is tested
    picture p = {0};
    path_run_picture(&run, &p, &scene, &view, samples);
    for (int c = 0; c < 3; c++) {
        double sum = 0, variance = 0;
        for (int i = 0; i < SIZE * SIZE; i++) {
            sum += p.rgb[3 * i + c];
            variance += (double)p.se[3 * i + c] * p.se[3 * i + c];
        }
        const double mean = sum / (SIZE * SIZE), se = sqrt(variance) / (SIZE * SIZE);
        printf("%-28s %.5g +- %.1f %%, expected %.5g: %+.1f %%\n", name, mean, 100 * se / mean,
               radiance[c], 100 * (mean / radiance[c] - 1));
        assert_true(se < most_se * mean);
        assert_true(fabs(mean - radiance[c]) < 4 * se + 0.002 * radiance[c]);
    }
    picture_free(&p);
    path_run_close(&run);
    tyn_scene_finish(&scene);
}

// Depth of 1e-8 to 0.002: light that has scattered once.
static void thin(void **state)
{
    static const float sigmas[] = {1e-8f, 1e-4f, 2e-3f};
    float grid[4 * 4 * 4];
    for (int i = 0; i < 64; i++) { // varies along z alone: a mean of 0.5 on every way
        grid[i] = i / 16 % 2 ? 1 : 0;
    }
    for (int i = 0; i < 3; i++) {
        const double tau = sigmas[i], once = tau * phase_function(0.5, 0);
        // Down to the middle and then to the eye.
        const double seen = 0.8 * once * exp(-0.5 * tau) * (1 - exp(-tau)) / tau;
        tyn_medium medium = grey_medium(0.8f * sigmas[i], 0.2f * sigmas[i], 0.5f);
        char name[64];
        snprintf(name, sizeof name, "depth %g", tau);
        check(*state, name, &medium, NULL, NULL, 256, 0.02, (double[]){seen, seen, seen});
        medium.density_scale = 2;
        snprintf(name, sizeof name, "depth %g, a grid", tau);
        check(*state, name, &medium, (uint32_t[]){4, 4, 4}, grid, 256, 0.02,
              (double[]){seen, seen, seen});
        // Each channel's own: a tenth of green, and ten times.
        for (int c = 0; c < 3; c++) {
            medium.density_scale = 1;
            medium.sigma_s[c] *= (float)pow(10, c - 2);
            medium.sigma_a[c] *= (float)pow(10, c - 2);
        }
        if (i < 2) {
            check(*state, "  in colours", &medium, NULL, NULL, 1024, 0.02,
                  (double[]){0.01 * seen, 0.1 * seen, seen});
        }
    }
}

// So narrow a lobe that light goes straight on but for one wide turn: only absorption is left of the way.
static void narrow(void **state)
{
    static const float gs[] = {0.999f, 0.9999f};
    for (int i = 0; i < 2; i++) {
        const double sigma_s = 9.5, sigma_a = 0.5, g = gs[i];
        double down = 0; // mean over the picture's rows
        for (int k = 0; k < 100; k++) {
            down += exp(-sigma_a * (0.25 + 0.5 * (k + 0.5) / 100)) / 100;
        }
        const double seen = sigma_s * phase_function(g, 0) * down * (1 - exp(-sigma_a)) / sigma_a;
        const tyn_medium medium = grey_medium((float)sigma_s, (float)sigma_a, gs[i]);
        char name[64];
        snprintf(name, sizeof name, "g %g", g);
        check(*state, name, &medium, NULL, NULL, path_effort(2048), 0.08,
              (double[]){seen, seen, seen});
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(thin), cmocka_unit_test(narrow)};
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
