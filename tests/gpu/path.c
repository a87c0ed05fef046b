// path.c -- the path tracer against closed forms: first-order light of suns and lamps, emission, overlapping
// media, layers; and that it gives the same bytes again.
#include "path_scene.h"
#include "numbers.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const float one[1] = {1};

static double hg(double g, double mu)
{
    return (1 - g * g) / (4 * M_PI * pow(1 + g * g - 2 * g * mu, 1.5));
}

// Mean over the image of a layer, and its standard error from the radiance's.
static double image_mean(const float *image, int channel)
{
    double sum = 0;
    for (int i = 0; i < 256; i++) {
        sum += image[4 * i + channel];
    }
    return sum / 256;
}

static double image_error(const float *error, int channel)
{
    double sum = 0;
    for (int i = 0; i < 256; i++) {
        sum += (double)error[4 * i + channel] * error[4 * i + channel];
    }
    return sqrt(sum) / 256;
}

static void first_order_of_a_sun(void **state)
{
    for (int grid = 0; grid < 2; grid++) {
        path_scene s;
        path_scene_cube(&s, 3, 1, 0.6f, grid);
        path_scene_sun(&s, (float[]){1, 0, 0}, (float[]){1, 2, 3});
        s.params.max_depth = 1;
        const float *radiance, *error;
        path_scene_render(*state, &s, 256, &radiance, &error);
        double inside = (1 - exp(-4)) / 4;
        double expected = 3 * hg(0.6, 0) * inside * inside;
        for (int c = 0; c < 3; c++) {
            path_scene_check(grid ? "sun, grid" : "sun", image_mean(radiance, c),
                             image_error(error, c), (c + 1) * expected);
        }
    }
}

// Layers add up, and the first order is the same however long the paths are.
static void layers(void **state)
{
    path_scene s;
    path_scene_cube(&s, 3, 1, 0.6f, false);
    path_scene_sun(&s, (float[]){1, 0, 0}, (float[]){1, 1, 1});
    path_scene_sky(&s, 0.5f);
    s.params.layers = 1;
    s.params.opaque = 1;
    const float *radiance, *error;
    path_scene_render(*state, &s, 256, &radiance, &error);
    const float *single = gpu_map(*state, "single"), *multiple = gpu_map(*state, "multiple");
    const float *transmittance = gpu_map(*state, "transmittance");
    for (int i = 0; i < 256; i++) {
        double sum = (double)single[4 * i] + multiple[4 * i] + 0.5 * transmittance[4 * i];
        assert_true(fabs(sum - radiance[4 * i]) < 1e-5);
        assert_true(single[4 * i] >= 0 && multiple[4 * i] >= 0 && radiance[4 * i + 3] == 1);
    }
    path_scene_check("transmittance", image_mean(transmittance, 0), sqrt(exp(-4) / (256 * 256)),
                     exp(-4));
    double sun = 3 * hg(0.6, 0) * pow((1 - exp(-4)) / 4, 2);
    assert_true(image_mean(single, 0) > sun);
}

// Light of a lamp that scatters once on a ray along z through (x, y), by the midpoint rule.
static double airlight(const float lamp[3], double sigma_s, double sigma_t, double g)
{
    double sum = 0;
    const int n = 200000;
    for (int i = 0; i < n; i++) {
        double z = 1 - (i + 0.5) / n, d[3] = {lamp[0] - 0.5, lamp[1] - 0.5, lamp[2] - z};
        double r = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        // The path goes along -z and turns towards the lamp.
        double mu = -d[2] / r;
        sum += sigma_s * hg(g, mu) * exp(-sigma_t * (1 - z + r)) / (r * r) / n;
    }
    return sum;
}

static void first_order_of_a_lamp(void **state)
{
    const float lamp[3] = {0.53f, 0.5f, 0.4f};
    double expected = airlight(lamp, 2, 3, 0.5), errors[2];
    for (int i = 0; i < 3; i++) {
        path_scene s;
        path_scene_cube(&s, 2, 1, 0.5f, i == 2);
        path_scene_lamp(&s, lamp, (float[]){1, 1, 1});
        path_scene_orthographic(&s, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, -1},
                                (float[]){0, 1, 0}, 1e-6f, 16);
        s.params.max_depth = 1;
        s.params.equiangular = i != 0;
        s.samples = 256;
        const float *radiance, *error;
        path_scene_render(*state, &s, 1024, &radiance, &error);
        path_scene_check(i == 0   ? "lamp, free flights"
                         : i == 1 ? "lamp, equi-angular"
                                  : "lamp, equi-angular, grid",
                         image_mean(radiance, 0), image_error(error, 0), expected);
        errors[i > 0] = image_error(error, 0);
    }
    assert_true(errors[1] < 0.7 * errors[0]); // what it is for
}

static void emission(void **state)
{
    for (int i = 0; i < 4; i++) {
        float sigma_a = i / 2 ? 2 : 0;
        path_scene s;
        path_scene_cube(&s, 0, sigma_a, 0, i % 2);
        for (int c = 0; c < 3; c++) {
            s.medium.emission[c] = s.shapes[0].emission[c] = (float)(c + 1);
        }
        s.params.emissive = 1;
        const float *radiance, *error;
        path_scene_render(*state, &s, 256, &radiance, &error);
        double length = sigma_a > 0 ? (1 - exp(-(double)sigma_a)) / (double)sigma_a : 1;
        for (int c = 0; c < 3; c++) {
            path_scene_check(i % 2 ? "emission, grid" : "emission", image_mean(radiance, c),
                             image_error(error, c), (c + 1) * length);
        }
    }
}

// Channels of unequal extinction share a path: each must get its own attenuation.
static void coloured_emission(void **state)
{
    for (int grid = 0; grid < 2; grid++) {
        path_scene s;
        path_scene_box(&s, (float[]){1, 1, 1}, (float[]){0, 0, 0}, (float[]){1, 2, 4},
                       (float[]){0, 0, 0}, grid ? one : NULL, (uint32_t[]){1, 1, 1});
        path_scene_orthographic(&s, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, -1, 0},
                                (float[]){0, 0, 1}, 0.5f, 16);
        for (int c = 0; c < 3; c++) {
            s.medium.emission[c] = s.shapes[0].emission[c] = 1;
        }
        s.params.emissive = 1;
        const float *radiance, *error;
        path_scene_render(*state, &s, 256, &radiance, &error);
        for (int c = 0; c < 3; c++) {
            double sigma_a = 1 << c;
            path_scene_check(grid ? "coloured emission, grid" : "coloured emission",
                             image_mean(radiance, c), image_error(error, c),
                             (1 - exp(-sigma_a)) / sigma_a);
        }
    }
}

// Two media in one place, of different colours and phase functions: their scattering adds up.
static void overlap(void **state)
{
    path_scene s;
    path_scene_cube(&s, 1, 1, 0, true);
    path_scene_sun(&s, (float[]){1, 0, 0}, (float[]){1, 1, 1});
    const float ss[2][3] = {{2, 1, 0.5f}, {0.5f, 1.5f, 0}}, sa[2] = {0.5f, 0.25f},
                g[2] = {0.7f, -0.4f};
    float most = 0;
    s.shapes[1] = s.shapes[0];
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 2; k++) {
            s.shapes[k].sigma_s[c] = ss[k][c];
            s.shapes[k].sigma_a[c] = sa[k];
            s.shapes[k].phase[c].g = g[k];
        }
        most = (float)maximum(most, ss[0][c] + ss[1][c] + sa[0] + sa[1]);
    }
    s.medium.mode = TYN_MEDIUM_COEFFICIENTS;
    s.medium.num_shapes = 2;
    s.medium.sigma_t_max = most; // of the brick, whose bounds are (1, 1)
    s.params.num_shapes = 2;
    s.params.grey = 0;
    s.params.max_depth = 1;
    const float *radiance, *error;
    path_scene_render(*state, &s, 1024, &radiance, &error);
    for (int c = 0; c < 3; c++) {
        double sigma_t = ss[0][c] + ss[1][c] + sa[0] + sa[1],
               inside = (1 - exp(-sigma_t)) / sigma_t;
        double scattered = ss[0][c] * hg(g[0], 0) + ss[1][c] * hg(g[1], 0);
        path_scene_check("two media", image_mean(radiance, c), image_error(error, c),
                         scattered * inside * inside);
    }
}

// A guide by a light changes the noise, not the mean.
static void guide(void **state)
{
    double mean[2], se[2];
    for (int i = 0; i < 2; i++) {
        path_scene s;
        path_scene_cube(&s, 4, 0, 0.9f, false);
        path_scene_sun(&s, (float[]){1, 0, 0}, (float[]){1, 1, 1});
        s.params.guide = i;
        const float *radiance, *error;
        path_scene_render(*state, &s, 2048, &radiance, &error);
        mean[i] = image_mean(radiance, 0);
        se[i] = image_error(error, 0);
    }
    printf("guided: %.6f +- %.6f, plain: %.6f +- %.6f\n", mean[1], se[1], mean[0], se[0]);
    assert_true(fabs(mean[1] - mean[0]) <= 3.5 * hypot(se[0], se[1]));
    assert_true(se[1] < 0.8 * se[0]);
}

static void same_again(void **state)
{
    static float first[256 * 4];
    const float *radiance;
    for (int i = 0; i < 3; i++) {
        path_scene s;
        path_scene_cube(&s, 4, 0.5f, 0.5f, true);
        path_scene_sun(&s, (float[]){1, 0, 0}, (float[]){1, 1, 1});
        s.samples = i == 2 ? 24 : 64; // other batches, other sums
        path_scene_render(*state, &s, 128, &radiance, NULL);
        if (i == 0) {
            memcpy(first, radiance, sizeof first);
        } else if (i == 1) {
            assert_memory_equal(first, radiance, sizeof first);
        }
    }
    for (int i = 0; i < 256 * 4; i++) {
        assert_true(fabsf(first[i] - radiance[i]) <= 1e-5f * fabsf(first[i]));
    }
}

// A path that never ends is cut, and counted.
static void safety_cap(void **state)
{
    path_scene s;
    path_scene_cube(&s, 1000, 0, 0, false);
    path_scene_sky(&s, 1);
    s.params.max_steps = 100;
    s.may_cut = true;
    const float *radiance;
    path_scene_render(*state, &s, 16, &radiance, NULL);
    const struct counters_block *counters = gpu_map(*state, "counters");
    assert_true(counters->cut > 0 && counters->cut < 256 * 16);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_order_of_a_sun),
        cmocka_unit_test(layers),
        cmocka_unit_test(first_order_of_a_lamp),
        cmocka_unit_test(emission),
        cmocka_unit_test(coloured_emission),
        cmocka_unit_test(overlap),
        cmocka_unit_test(guide),
        cmocka_unit_test(same_again),
        cmocka_unit_test(safety_cap),
    };
    setvbuf(stdout, NULL, _IOLBF, 0);
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
