// env_suns.c -- the suns of analytic maps, and of a real one.
#include "scene/env_suns.h"
#include "io_test.h"
#include "skip.h"
#include "vector.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct lamp { // a soft lobe: color exp(sharpness (cos - 1))
    double direction[3];
    double color[3];
    double sharpness; // < 0: a disc of this (negative) radius in rad
} lamp;

typedef struct surroundings {
    double turn; // of the map about +Y, rad
    int sky;     // 1: zenith, horizon and ground of the reference images
    double grey; // constant part
    const lamp *lamps;
    int num_lamps;
} surroundings;

static void radiance(const surroundings *s, const double d[3], double rgb[3])
{
    static const double Z[3] = {0.25, 0.5, 1.0}, H[3] = {0.9, 0.95, 1.0}, G[3] = {0.15, 0.12, 0.10};
    const double w[3] = {cos(s->turn) * d[0] + sin(s->turn) * d[2], d[1],
                         -sin(s->turn) * d[0] + cos(s->turn) * d[2]};
    for (int c = 0; c < 3; c++) {
        double sky = w[1] >= 0 ? H[c] + (Z[c] - H[c]) * sqrt(w[1])
                               : H[c] + (G[c] - H[c]) * fmin(1, -5 * w[1]);
        rgb[c] = s->grey + (s->sky ? sky : 0);
        for (int i = 0; i < s->num_lamps; i++) {
            const lamp *l = &s->lamps[i];
            double mu = w[0] * l->direction[0] + w[1] * l->direction[1] + w[2] * l->direction[2];
            rgb[c] += l->color[c] *
                      (l->sharpness < 0 ? mu >= cos(l->sharpness) : exp(l->sharpness * (mu - 1)));
        }
    }
}

static void texel_direction(double u, double v, double d[3])
{
    double azimuth = (u - 0.5) * 2 * M_PI, polar = v * M_PI;
    d[0] = sin(polar) * sin(azimuth);
    d[1] = cos(polar);
    d[2] = -sin(polar) * cos(azimuth);
}

// n x n samples a texel near the lamps, one elsewhere.
static tyn_environment make_map(uint32_t w, uint32_t h, const surroundings *s, int n)
{
    tyn_environment env = {.present = true, .size = {w, h}, .radiance = {1, 1, 1}, .strength = 1};
    env.data = malloc((size_t)w * h * 3 * sizeof *env.data);
    for (uint32_t y = 0; y < h; y++) {
        for (uint32_t x = 0; x < w; x++) {
            double sum[3] = {0, 0, 0}, rgb[3], d[3];
            for (int i = 0; i < n * n; i++) {
                // Evenly over the texel's solid angle.
                double top = cos(M_PI * y / h), bottom = cos(M_PI * (y + 1) / h);
                double v =
                    n == 1 ? (y + 0.5) / h : acos(top + (bottom - top) * (i / n + 0.5) / n) / M_PI;
                texel_direction((x + (i % n + 0.5) / n) / w, v, d);
                radiance(s, d, rgb);
                for (int c = 0; c < 3; c++) {
                    sum[c] += rgb[c] / (n * n);
                }
            }
            for (int c = 0; c < 3; c++) {
                env.data[3 * ((size_t)y * w + x) + (size_t)c] = (float)sum[c];
            }
        }
    }
    return env;
}

static double degrees(const tyn_map_sun *sun, const double d[3], double turn)
{
    const double t[3] = {cos(turn) * d[0] - sin(turn) * d[2], d[1],
                         sin(turn) * d[0] + cos(turn) * d[2]};
    double dot = 0;
    for (int a = 0; a < 3; a++) {
        dot += t[a] * sun->direction[a];
    }
    return acos(fmin(1, dot)) * 180 / M_PI;
}

// The rule as anybody may apply it: the residual's mean and each channel's share.
static void assert_consistent(const tyn_environment *env, const tyn_map_light *light)
{
    double sum[3] = {0, 0, 0}, all[3] = {0, 0, 0};
    for (uint32_t y = 0; y < env->size[1]; y++) {
        double share = (cos(M_PI * y / env->size[1]) - cos(M_PI * (y + 1) / env->size[1])) * 0.5 /
                       env->size[0];
        for (uint32_t x = 0; x < env->size[0]; x++) {
            double d[3];
            texel_direction((x + 0.5) / env->size[0], (y + 0.5) / env->size[1], d);
            for (int c = 0; c < 3; c++) {
                double v = env->data[3 * ((size_t)y * env->size[0] + x) + (size_t)c];
                all[c] += share * v;
                for (uint32_t i = 0; i < light->num_suns; i++) {
                    const tyn_map_sun *s = &light->suns[i];
                    double dot = 0;
                    for (int a = 0; a < 3; a++) {
                        dot += d[a] * s->direction[a];
                    }
                    v = dot >= s->cos_radius ? fmin(v, s->around[c]) : v;
                }
                sum[c] += share * v;
            }
        }
    }
    for (int c = 0; c < 3; c++) {
        assert_true(fabs(light->mean[c] - all[c]) <= 1e-9 * all[c]);
        assert_true(fabs(light->sky[c] - sum[c]) <= 1e-6 * sum[c] + 1e-9 * all[c]);
    }
}

static lamp lobe(double x, double y, double z, double color, double sharpness)
{
    double d[3] = {x, y, z}, n = vector_length(d);
    return (lamp){{x / n, y / n, z / n}, {color, 0.9 * color, 0.75 * color}, sharpness};
}

// The sky of the reference images: a lobe of 4 degrees RMS per axis on a gradient.
static void reference_sky(void **state)
{
    (void)state;
    const lamp sun = lobe(0.5, 0.6, -0.4, 60, 200);
    const uint32_t sizes[][2] = {{128, 64}, {512, 256}, {1000, 331}, {64, 32}};
    for (int i = 0; i < 4; i++) {
        for (int turn = 0; turn < 12; turn++) {
            const surroundings s = {.sky = 1, .lamps = &sun, .num_lamps = 1, .turn = 0.37 * turn};
            tyn_environment env = make_map(sizes[i][0], sizes[i][1], &s, 1);
            tyn_map_light light;
            assert_true(tyn_map_light_find(&env, &light));
            assert_int_equal(light.num_suns, 1);
            const tyn_map_sun *found = &light.suns[0];
            double whole = 2 * M_PI / 200 * (1 - exp(-400));
            if (turn == 0) {
                printf("%u x %u: %.3f degrees off, irradiance %.4f %.4f %.4f of the lobe's, mean "
                       "cosine %.5f, radius %.1f, around %.2f\n",
                       sizes[i][0], sizes[i][1], degrees(found, sun.direction, s.turn),
                       found->irradiance[0] / whole / 60, found->irradiance[1] / whole / 54,
                       found->irradiance[2] / whole / 45, found->mean_cosine,
                       acos(found->cos_radius) * 180 / M_PI, found->around[0]);
            }
            for (int c = 0; c < 3; c++) {
                assert_true(fabs(found->irradiance[c] / (whole * sun.color[c]) - 1) < 0.02);
            }
            assert_true(degrees(found, sun.direction, s.turn) < 0.3);
            assert_true(fabs(found->mean_cosine - 0.995) < 0.0008);
            assert_consistent(&env, &light);
            free(env.data);
        }
    }
}

// A sun of the sky's size: a few texels of a 4k map. Everywhere, the poles and the seam included.
static void physical_sun(void **state)
{
    (void)state;
    const double radius = 0.27 * M_PI / 180;
    const double where[][3] = {{0.3, 0.5, -0.6}, {0, 1, 0},     {0, -1, 0},
                               {0, 0.2, 1},      {0.001, 0, 1}, {0.004, 1, 0.003}};
    for (int i = 0; i < 6; i++) {
        lamp sun = lobe(where[i][0], where[i][1], where[i][2], 5e4, -radius);
        const surroundings s = {.sky = 1, .lamps = &sun, .num_lamps = 1};
        const surroundings bare = {.sky = 1};
        tyn_environment env = make_map(1024, 512, &s, 3), sky = make_map(1024, 512, &bare, 1);
        tyn_map_light light, without;
        assert_true(tyn_map_light_find(&env, &light));
        assert_true(tyn_map_light_find(&sky, &without));
        assert_int_equal(light.num_suns, 1);
        const tyn_map_sun *found = &light.suns[0];
        double whole = (light.mean[0] - without.mean[0]) * 4 * M_PI;
        printf("disc %d: %.4f degrees off, irradiance %.5f, 1 - mean cosine %.2g, radius %.2f, "
               "around %.2f\n",
               i, degrees(found, sun.direction, 0), found->irradiance[0] / whole,
               1 - found->mean_cosine, acos(found->cos_radius) * 180 / M_PI, found->around[0]);
        assert_true(fabs(found->irradiance[0] / whole - 1) < 0.001);
        assert_true(degrees(found, sun.direction, 0) < 0.05);
        assert_true(found->mean_cosine > 1 - 2e-5 && found->mean_cosine < 1 - 5e-6);
        assert_consistent(&env, &light);
        free(env.data);
        free(sky.data);
    }
}

static void several_suns(void **state)
{
    (void)state;
    const lamp lamps[] = {lobe(1, 0, 0, 500, 2000), lobe(0, 1, 0, 40, 200),
                          lobe(-1, -0.2, 0.3, 100, 500), lobe(0, 0, 1, 300, 900),
                          lobe(0.2, -1, 0.1, 0.5, 200)};
    const surroundings s = {.grey = 0.3, .lamps = lamps, .num_lamps = 5};
    tyn_environment env = make_map(700, 350, &s, 1);
    tyn_map_light light;
    assert_true(tyn_map_light_find(&env, &light));
    assert_int_equal(light.num_suns, 4); // the fifth has too little
    bool seen[4] = {false};
    for (uint32_t i = 0; i < light.num_suns; i++) {
        for (int k = 0; k < 4; k++) {
            if (degrees(&light.suns[i], lamps[k].direction, 0) < 0.1) {
                double whole = 2 * M_PI / lamps[k].sharpness * lamps[k].color[0];
                assert_true(fabs(light.suns[i].irradiance[0] / whole - 1) < 0.02);
                seen[k] = true;
            }
        }
    }
    assert_true(seen[0] && seen[1] && seen[2] && seen[3]);
    assert_consistent(&env, &light);
    free(env.data);
}

static void none(void **state)
{
    (void)state;
    const lamp window = lobe(0.4, 0.3, 1, 30, -0.4);   // a disc of 23 degrees
    const lamp porthole = lobe(0.4, 0.3, 1, 9, -0.25); // of 14
    const lamp wide = lobe(0.4, 0.3, 1, 20, 20);       // a glow of 13 degrees per axis
    const lamp glow = lobe(0.4, 0.3, 1, 40, 60);       // of 7
    const lamp weak = lobe(0.4, 0.3, 1, 5, 800);       // a sun of 4 % of a grey sky
    const surroundings cases[] = {{.grey = 0.2, .lamps = &window, .num_lamps = 1},
                                  {.grey = 0.2, .lamps = &porthole, .num_lamps = 1},
                                  {.grey = 0.2, .lamps = &wide, .num_lamps = 1},
                                  {.grey = 0.2, .lamps = &glow, .num_lamps = 1},
                                  {.grey = 0.08, .lamps = &weak, .num_lamps = 1},
                                  {.sky = 1},
                                  {.grey = 1},
                                  {.grey = 0}};
    const uint32_t sizes[][2] = {{512, 256}, {37, 19}, {1, 1}, {2, 1}, {1, 5}, {900, 2}};
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 6; k++) {
            tyn_environment env = make_map(sizes[k][0], sizes[k][1], &cases[i], 1);
            tyn_map_light light;
            assert_true(tyn_map_light_find(&env, &light));
            if (light.num_suns) {
                printf("case %d, %u x %u: %u suns, mean cosine %g, share %g\n", i, sizes[k][0],
                       sizes[k][1], light.num_suns, light.suns[0].mean_cosine,
                       light.suns[0].irradiance[1] / (4 * M_PI * light.mean[1]));
            }
            assert_true(light.num_suns == 0);
            assert_consistent(&env, &light);
            free(env.data);
        }
    }
}

// Faulty texels of a host's map count as 0; a constant environment has no map.
static void hostile(void **state)
{
    (void)state;
    const surroundings s = {.grey = 1};
    tyn_environment env = make_map(64, 32, &s, 1);
    env.data[3 * 700] = NAN;
    env.data[3 * 701] = INFINITY;
    env.data[3 * 702] = -5;
    tyn_map_light light;
    assert_true(tyn_map_light_find(&env, &light));
    assert_true(isfinite(light.mean[0]) && light.mean[0] < 1 && light.num_suns == 0);
    for (int i = 0; i < 3 * 64 * 32; i++) {
        env.data[i] = 3e38f;
    }
    assert_true(tyn_map_light_find(&env, &light));
    assert_true(isfinite(light.mean[0]) && light.num_suns == 0);
    free(env.data);
    env = (tyn_environment){.present = true, .radiance = {1, 1, 1}};
    assert_true(tyn_map_light_find(&env, &light));
    assert_true(light.num_suns == 0 && light.mean[0] == 0);
}

// One hot texel is a sun of a texel's size, whatever the map's size.
static void one_texel(void **state)
{
    (void)state;
    const surroundings s = {.grey = 0.1};
    const uint32_t sizes[][2] = {{64, 32}, {300, 150}, {2048, 1024}};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 4; k++) {
            tyn_environment env = make_map(sizes[i][0], sizes[i][1], &s, 1);
            const uint32_t w = sizes[i][0], h = sizes[i][1];
            const uint32_t x = k == 0 ? w / 3 : k == 1 ? 0 : w - 1;
            const uint32_t y = k == 0 ? h / 3 : k == 1 ? h / 2 : k == 2 ? 0 : h - 1;
            double solid = (cos(M_PI * y / h) - cos(M_PI * (y + 1) / h)) * 2 * M_PI / w;
            env.data[3 * ((size_t)y * w + x) + 1] = (float)(1 / solid);
            tyn_map_light light;
            assert_true(tyn_map_light_find(&env, &light));
            assert_int_equal(light.num_suns, 1);
            double d[3];
            texel_direction((x + 0.5) / w, (y + 0.5) / h, d);
            assert_true(degrees(&light.suns[0], d, 0) < 0.2 * 180 / h); // a pole's texel is a wedge
            assert_true(fabs(light.suns[0].irradiance[1] - 1) < 0.1 * solid + 1e-5);
            assert_true(light.suns[0].irradiance[0] < 1e-6);
            assert_consistent(&env, &light);
            free(env.data);
        }
    }
}

static void large(void **state)
{
    (void)state;
    enum { W = 4096, H = 2048 };
    tyn_environment env = {.present = true, .size = {W, H}};
    env.data = malloc((size_t)W * H * 3 * sizeof *env.data);
    for (size_t i = 0; i < (size_t)W * H * 3; i++) {
        env.data[i] = 0.5f + 0.001f * (float)(i * 7919 % 101);
    }
    for (int y = 600; y < 606; y++) {
        for (int x = 1000; x < 1006; x++) {
            env.data[3 * ((size_t)y * W + (size_t)x)] = 3e5f;
        }
    }
    tyn_map_light light;
    clock_t start = clock();
    assert_true(tyn_map_light_find(&env, &light));
    printf("4096 x 2048: %.0f ms\n", 1e3 * (double)(clock() - start) / CLOCKS_PER_SEC);
    assert_int_equal(light.num_suns, 1);
    free(env.data);
}

static void real_map(void **state)
{
    (void)state;
    const char *path = io_shared("data/museum.exr");
    if (!path) {
        skip_without("data/museum.exr");
    }
    tyn_environment env = {0};
    assert_int_equal(tyn_environment_load(&env, path, NULL), TYN_OK);
    tyn_map_light light;
    assert_true(tyn_map_light_find(&env, &light));
    printf("museum.exr, %u x %u, mean %.4g %.4g %.4g, residual %.4g %.4g %.4g: %u suns\n",
           env.size[0], env.size[1], light.mean[0], light.mean[1], light.mean[2], light.sky[0],
           light.sky[1], light.sky[2], light.num_suns);
    for (uint32_t i = 0; i < light.num_suns; i++) {
        const tyn_map_sun *s = &light.suns[i];
        printf("  towards %.3f %.3f %.3f, irradiance %.3g %.3g %.3g (%.1f %% of all), radius %.2f "
               "degrees, RMS %.2f, around %.3g\n",
               s->direction[0], s->direction[1], s->direction[2], s->irradiance[0],
               s->irradiance[1], s->irradiance[2],
               100 * s->irradiance[1] / (4 * M_PI * light.mean[1]),
               acos(s->cos_radius) * 180 / M_PI,
               sqrt(2 * (1 - (double)s->mean_cosine)) * 180 / M_PI, s->around[1]);
    }
    assert_consistent(&env, &light);
    free(env.data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reference_sky), cmocka_unit_test(physical_sun),
        cmocka_unit_test(several_suns),  cmocka_unit_test(none),
        cmocka_unit_test(hostile),       cmocka_unit_test(one_texel),
        cmocka_unit_test(large),         cmocka_unit_test(real_map),
    };
    return run_cases(tests, NULL, NULL);
}
