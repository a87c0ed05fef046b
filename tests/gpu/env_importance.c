// env_importance.c -- the pyramid of a map without its suns, against sums in double.
#include "gpu_test.h"
#include "point_pass.h"
#include "sky_eval.comp.h"
#include "passes/env_importance/env_importance.h"
#include "scene/env_suns.h"
#include "random_unit.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { W = SKY_WIDTH, H = SKY_HEIGHT, TEXELS = W * H };

static const double weights[3] = {0.2126, 0.7152, 0.0722};

static double band(double top, double bottom)
{
    return cos(top) - cos(bottom);
}

static float *make_map(uint32_t w, uint32_t h, bool sun)
{
    float *map = malloc((size_t)w * h * 3 * sizeof *map);
    uint32_t seed = w * 7919 + h;
    for (size_t i = 0; i < (size_t)w * h * 3; i++) {
        map[i] = (float)pow(random_unit(&seed), 3) * 4;
    }
    if (sun) { // two discs, one of them on the seam
        const double suns[2][3] = {{0.6, 0.64, -0.48}, {0, 0.28, 0.96}};
        for (uint32_t y = 0; y < h; y++) {
            for (uint32_t x = 0; x < w; x++) {
                double azimuth = ((x + 0.5) / w - 0.5) * 2 * M_PI, polar = (y + 0.5) / h * M_PI;
                for (int k = 0; k < 2; k++) {
                    double cosine = sin(polar) * sin(azimuth) * suns[k][0] +
                                    cos(polar) * suns[k][1] -
                                    sin(polar) * cos(azimuth) * suns[k][2];
                    for (size_t c = 0; c < 3; c++) {
                        map[3 * ((size_t)y * w + x) + c] +=
                            (float)(3000 * (k + 1) * exp(2000 * (cosine - 1)));
                    }
                }
            }
        }
    }
    return map;
}

// Level 0 in double: radiance times solid angle per texel, and the solid angle. A texel of the map gives
// to every texel that it overlaps.
static void twin(const float *map, uint32_t w, uint32_t h, const tyn_map_light *light, double *out)
{
    memset(out, 0, TEXELS * 4 * sizeof *out);
    for (uint32_t y = 0; y < h; y++) {
        double top = M_PI * y / h, bottom = M_PI * (y + 1) / h;
        for (uint32_t x = 0; x < w; x++) {
            double azimuth = ((x + 0.5) / w - 0.5) * 2 * M_PI, polar = (y + 0.5) / h * M_PI;
            double rgb[3];
            for (size_t c = 0; c < 3; c++) {
                rgb[c] = map[3 * ((size_t)y * w + x) + c];
                for (uint32_t i = 0; i < light->num_suns; i++) {
                    const tyn_map_sun *s = &light->suns[i];
                    double cosine = sin(polar) * sin(azimuth) * s->direction[0] +
                                    cos(polar) * s->direction[1] -
                                    sin(polar) * cos(azimuth) * s->direction[2];
                    rgb[c] = cosine >= s->cos_radius ? fmin(rgb[c], s->around[c]) : rgb[c];
                }
            }
            uint32_t j1 = (uint32_t)fmin(ceil((y + 1.0) * H / h), H);
            uint32_t i1 = (uint32_t)fmin(ceil((x + 1.0) * W / w), W);
            for (uint32_t j = (uint32_t)floor((double)y * H / h); j < j1; j++) {
                double a = fmax(top, M_PI * j / H), b = fmin(bottom, M_PI * (j + 1) / H);
                for (uint32_t i = (uint32_t)floor((double)x * W / w); i < i1; i++) {
                    double left = fmax((double)x / w, (double)i / W);
                    double right = fmin((x + 1.0) / w, (i + 1.0) / W);
                    double part = fmax(0, b - a) * fmax(0, right - left) > 0
                                      ? band(a, b) * (right - left) * 2 * M_PI
                                      : 0;
                    double *t = out + 4 * ((size_t)j * W + i);
                    for (int c = 0; c < 3; c++) {
                        t[c] += part * rgb[c];
                    }
                    t[3] += part;
                }
            }
        }
    }
}

static void upload_rgb(gpu_test *t, const float *map, uint32_t w, uint32_t h, tyn_ref *ref)
{
    float *rgba = malloc((size_t)w * h * 4 * sizeof *rgba);
    for (size_t i = 0; i < (size_t)w * h; i++) {
        memcpy(rgba + 4 * i, map + 3 * i, 3 * sizeof *rgba);
        rgba[4 * i + 3] = 1;
    }
    *ref = gpu_image(t, "map", TYN_IMAGE_2D, (tyn_extent){w, h, 1}, 4, rgba);
    free(rgba);
}

// Checks a level, then makes `sum` the level above.
static void check_level(const float *got, double *sum, int level, double scale)
{
    const int w = W >> level, h = H >> level ? H >> level : 1;
    for (int i = 0; i < w * h; i++) {
        double luminance = 0;
        for (int c = 0; c < 3; c++) {
            double mean = sum[4 * i + c] / sum[4 * i + 3];
            luminance += weights[c] * sum[4 * i + c];
            if (!(fabs(got[4 * i + c] - mean) < 2e-5 * mean + 1e-7 * scale)) {
                fail_msg("level %d texel %d channel %d: %.8g, should be %.8g", level, i, c,
                         got[4 * i + c], mean);
            }
        }
        assert_true(fabs(got[4 * i + 3] - luminance) < 2e-5 * luminance + 1e-9 * scale);
    }
    const int up_w = w / 2 ? w / 2 : 1, up_h = h / 2 ? h / 2 : 1;
    for (int i = 0; i < up_w * up_h; i++) {
        const int x = i % up_w, y = i / up_w;
        double all[4];
        for (int c = 0; c < 4; c++) {
            all[c] = sum[4 * (2 * y * w + 2 * x) + c] + sum[4 * (2 * y * w + 2 * x + 1) + c];
            all[c] += h == 1 ? 0
                             : sum[4 * ((2 * y + 1) * w + 2 * x) + c] +
                                   sum[4 * ((2 * y + 1) * w + 2 * x + 1) + c];
        }
        memcpy(sum + 4 * i, all, sizeof all);
    }
}

// Entries of the sums against the texels.
static void check_sums(const struct sky_sum *sums, const double *fine)
{
    const int rw = W / SKY_SUMS_WIDTH, rh = H / SKY_SUMS_HEIGHT;
    double total = 0;
    for (int i = 0; i < TEXELS; i++) {
        total += fine[4 * i + 1];
    }
    for (int k = 0; k < 60; k++) {
        int x = (k * 37) % (SKY_SUMS_WIDTH + 1), y = (k * 17) % (SKY_SUMS_HEIGHT + 1);
        x = k == 59 ? SKY_SUMS_WIDTH : x;
        y = k == 59 ? SKY_SUMS_HEIGHT : y;
        double power[3] = {0, 0, 0}, luminance = 0, moment[3] = {0, 0, 0};
        for (int j = 0; j < y * rh; j++) {
            for (int i = 0; i < x * rw; i++) {
                const double *t = fine + 4 * ((size_t)j * W + (size_t)i);
                double l = 0, azimuth = ((i + 0.5) / W - 0.5) * 2 * M_PI,
                       polar = (j + 0.5) / H * M_PI;
                for (int c = 0; c < 3; c++) {
                    power[c] += t[c];
                    l += weights[c] * t[c];
                }
                luminance += l;
                moment[0] += l * sin(polar) * sin(azimuth);
                moment[1] += l * cos(polar);
                moment[2] -= l * sin(polar) * cos(azimuth);
            }
        }
        const struct sky_sum *s = &sums[y * (SKY_SUMS_WIDTH + 1) + x];
        for (int c = 0; c < 3; c++) {
            assert_true(fabs(s->power[c] - power[c]) < 3e-6 * total);
            assert_true(fabs(s->moment[c] - moment[c]) < 3e-6 * total);
        }
        assert_true(fabs(s->luminance - luminance) < 3e-6 * total);
    }
}

static void check(gpu_test *t, uint32_t w, uint32_t h, bool sun)
{
    static double fine[TEXELS * 4], levels[TEXELS * 4];
    static uint32_t points[TEXELS * 2][4];
    float *map = make_map(w, h, sun);
    const tyn_environment env = {.present = true, .size = {w, h}, .data = map};
    tyn_map_light light;
    assert_true(tyn_map_light_find(&env, &light));
    assert_int_equal(light.num_suns, sun ? 2 : 0);
    tyn_env_importance_params params = {.suns = {.num_suns = light.num_suns}};
    for (uint32_t i = 0; i < light.num_suns; i++) {
        struct sky_sun *s = &params.suns.suns[i];
        memcpy(s->direction, light.suns[i].direction, sizeof s->direction);
        memcpy(s->around, light.suns[i].around, sizeof s->around);
        s->cos_radius = light.suns[i].cos_radius;
    }
    uint32_t count = 0;
    for (uint32_t level = 0; level < SKY_MIPS; level++) {
        uint32_t lw = W >> level, lh = H >> level ? H >> level : 1;
        for (uint32_t i = 0; i < lw * lh; i++, count++) {
            points[count][0] = i % lw;
            points[count][1] = i / lw;
            points[count][2] = level;
        }
    }
    static point_pass pass;
    const point_input input = {"sky", TYN_IMAGE_2D, TYN_USE_SAMPLED};
    point_pass_init(&pass, sky_eval_spirv, sizeof sky_eval_spirv, &input, 1);
    tyn_graph_begin(t->graph);
    tyn_ref refs[ENV_IMPORTANCE_NUM_PORTS] = {{0}}, eval[3] = {{0}};
    upload_rgb(t, map, w, h, &refs[ENV_IMPORTANCE_PORT_ENV_MAP]);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_env_importance, &params, refs), TYN_OK);
    eval[0] = refs[ENV_IMPORTANCE_PORT_SKY];
    eval[1] = gpu_buffer(t, "points", points, count * sizeof points[0]);
    const point_pass_params eval_params = {count, 16, 0, pass.results};
    assert_int_equal(tyn_graph_add(t->graph, &pass.desc, &eval_params, eval), TYN_OK);
    tyn_graph_output(t->graph, "levels", eval[2], true);
    tyn_graph_output(t->graph, "sums", refs[ENV_IMPORTANCE_PORT_SUMS], true);
    gpu_run(t);

    twin(map, w, h, &light, fine);
    double scale = 0, total[3] = {0, 0, 0};
    for (int i = 0; i < TEXELS; i++) {
        for (int c = 0; c < 3; c++) {
            total[c] += fine[4 * i + c];
            scale = fmax(scale, fine[4 * i + c] / fine[4 * i + 3]);
        }
    }
    for (int c = 0; c < 3; c++) {
        assert_true(fabs(total[c] / (4 * M_PI) - light.sky[c]) < 1e-6 * light.sky[c]);
    }
    check_sums(gpu_map(t, "sums"), fine);
    memcpy(levels, fine, sizeof levels);
    const float *got = gpu_map(t, "levels");
    for (int level = 0; level < SKY_MIPS; level++) {
        check_level(got, levels, level, scale);
        got += 4 * (W >> level) * (H >> level ? H >> level : 1);
    }
    const float *last = got - 4;
    printf("%u x %u%s: mean %.6f, of the map %.6f; %.1f ms\n", w, h, sun ? ", suns" : "", last[1],
           light.sky[1], gpu_ms(t, "env_importance"));
    assert_true(fabs(last[1] / light.sky[1] - 1) < 1e-5);
    free(map);
}

static void sizes(void **state)
{
    check(*state, 1, 1, false);
    check(*state, 7, 3, false);
    check(*state, 512, 256, false);
    check(*state, 611, 401, false);
    check(*state, 1024, 200, false);
    check(*state, 2048, 1024, false);
}

static void without_suns(void **state)
{
    check(*state, 256, 128, true);
    check(*state, 1000, 500, true);
}

// What no map should hold counts as 0.
static void hostile(void **state)
{
    gpu_test *t = *state;
    float map[4 * 8 * 4];
    for (int i = 0; i < 4 * 8 * 4; i++) {
        map[i] = i == 17 ? NAN : i == 33 ? INFINITY : i == 50 ? -3.0f : 1.0f;
    }
    const tyn_env_importance_params params = {0};
    tyn_graph_begin(t->graph);
    tyn_ref refs[ENV_IMPORTANCE_NUM_PORTS] = {
        gpu_image(t, "map", TYN_IMAGE_2D, (tyn_extent){8, 4, 1}, 4, map)};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_env_importance, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "sky", refs[ENV_IMPORTANCE_PORT_SKY], true);
    gpu_run(t);
    const float *sky = gpu_map(t, "sky");
    for (int i = 0; i < TEXELS * 4; i++) {
        assert_true(sky[i] >= 0 && sky[i] <= 1.00001f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes),
        cmocka_unit_test(without_suns),
        cmocka_unit_test(hostile),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
