// path_images.c -- `path` against the reference images of cubes and blobs (pbrt-v3 in 64-bit).
//
// Asserted for every image: the mean is without bias beyond 3 combined standard errors, and z = difference /
// sqrt(se_ref^2 + se_path^2) of 8x8 blocks has an RMS below 1.5. TYN_LONG=N takes N times the samples.
#include "npy.h"
#include "path_scene.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static uint32_t effort(uint32_t samples)
{
    const char *s = getenv("TYN_LONG");
    return s ? samples * (uint32_t)atoi(s) : samples;
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Compares with images/NAME.npy, shape (n, n, 2 k): means, then their standard errors.
static void compare(gpu_test *t, path_scene *s, const char *name, uint32_t samples)
{
    char file[128], path[512];
    snprintf(file, sizeof file, "reference/images/%s.npy", name);
    npy_array ref;
    if (!shared_path(path, sizeof path, file)) {
        printf("%s: skipped\n", name);
        return;
    }
    assert_true(npy_read(&ref, path));
    uint32_t n = ref.shape[0], k = ref.shape[2] / 2;
    assert_int_equal(n, s->camera.size[0]);
    const float *radiance, *error;
    double start = seconds();
    path_scene_render(t, s, samples, &radiance, &error);
    double took = seconds() - start;
    for (uint32_t c = 0; c < k; c++) {
        double sum = 0, sum_ref = 0, var = 0, var_ref = 0, z2 = 0;
        uint32_t blocks = 0;
        for (uint32_t by = 0; by < n; by += 8) {
            for (uint32_t bx = 0; bx < n; bx += 8) {
                double a = 0, b = 0, va = 0, vb = 0;
                for (uint32_t i = 0; i < 64; i++) {
                    uint32_t pixel = (by + i / 8) * n + bx + i % 8;
                    double e = error[pixel * 4 + c], er = ref.data[pixel * 2 * k + k + c];
                    a += radiance[pixel * 4 + c];
                    b += ref.data[pixel * 2 * k + c];
                    va += e * e;
                    vb += er * er;
                }
                sum += a;
                sum_ref += b;
                var += va;
                var_ref += vb;
                if (va + vb > 0) {
                    z2 += (a - b) * (a - b) / (va + vb);
                    blocks++;
                }
            }
        }
        double bias = sum / sum_ref - 1, bias_se = sqrt(var + var_ref) / sum_ref;
        double z_rms = sqrt(z2 / blocks);
        printf("%-26s %u  mean %.6g  reference %.6g  bias %+.4f %% +- %.4f (z %+.2f)  z_rms %.2f  "
               "%.1f s  %.2f Mpaths/s\n",
               name, c, sum / (n * n), sum_ref / (n * n), 100 * bias, 100 * bias_se, bias / bias_se,
               z_rms, took, 1e-6 * n * n * samples / took);
        assert_true(fabs(bias) <= 3 * bias_se);
        assert_true(z_rms < 1.5);
    }
    npy_free(&ref);
}

static void cubes(void **state)
{
    static const struct {
        const char *name;
        float direction[3];
    } views[] = {{"side", {0, -1, 0}}, {"exit", {-1, 0, 0}}, {"entry", {1, 0, 0}}};
    static const float gs[] = {0, 0.5f, 0.9f};
    for (int i = 0; i < 9; i++) {
        float g = gs[i / 3];
        path_scene s;
        path_scene_box(&s, (float[]){1, 1, 1}, (float[]){4, 4, 4}, (float[]){0, 0, 0},
                       (float[]){g, g, g}, NULL, NULL);
        path_scene_sun(&s, (float[]){1, 0, 0}, (float[]){1, 1, 1});
        path_scene_orthographic(&s, (float[]){0.5f, 0.5f, 0.5f}, views[i % 3].direction,
                                (float[]){0, 0, 1}, 0.5f, 64);
        char name[64];
        snprintf(name, sizeof name, "cube_g%.2f_%s", (double)g, views[i % 3].name);
        s.samples = 64;
        s.params.seed = (uint32_t)i; // noise of its own for each image
        compare(*state, &s, name, effort(512));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(cubes)};
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
