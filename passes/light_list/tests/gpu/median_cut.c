// median_cut.c -- constellations against a twin in double precision, which adds up the map's texels itself.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "passes/env_importance/env_importance.h"
#include "passes/light_list/median_cut/median_cut.h"
#include "random_unit.h"
#include "shaders/light/sky_args.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { W = SKY_SUMS_WIDTH, H = SKY_SUMS_HEIGHT };

// ---- twin -------------------------------------------------------------------------------------

// A texel of the sums: integrals of radiance, luminance, and luminance times direction.
typedef struct texel {
    double power[3], luminance, moment[3];
} texel;

static texel texels[H][W];

typedef struct region {
    int x0, y0, x1, y1;
} region;

static texel sum_of(region r)
{
    texel s = {{0}, 0, {0}};
    for (int y = r.y0; y < r.y1; y++) {
        for (int x = r.x0; x < r.x1; x++) {
            for (int c = 0; c < 3; c++) {
                s.power[c] += texels[y][x].power[c];
                s.moment[c] += texels[y][x].moment[c];
            }
            s.luminance += texels[y][x].luminance;
        }
    }
    return s;
}

// Fine texels of a map of 512 x 256 that has `radiance` of each.
static void make_texels(const float *rgba)
{
    enum { FW = SKY_WIDTH, FH = SKY_HEIGHT };
    memset(texels, 0, sizeof texels);
    for (int j = 0; j < FH; j++) {
        const double solid = (cos(M_PI * j / FH) - cos(M_PI * (j + 1) / FH)) * 2 * M_PI / FW;
        const double polar = M_PI * (j + 0.5) / FH;
        for (int i = 0; i < FW; i++) {
            const float *p = rgba + 4 * (j * FW + i);
            const double azimuth = ((i + 0.5) / FW - 0.5) * 2 * M_PI;
            const double l = solid * (0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]);
            const double d[3] = {sin(polar) * sin(azimuth), cos(polar), -sin(polar) * cos(azimuth)};
            texel *t = &texels[j * H / FH][i * W / FW];
            for (int c = 0; c < 3; c++) {
                t->power[c] += solid * p[c];
                t->moment[c] += l * d[c];
            }
            t->luminance += l;
        }
    }
}

static bool is_wide(region r)
{
    const double middle = 0.5 * (r.y0 + r.y1) / H * M_PI;
    const double width = 2.0 * (r.x1 - r.x0) / W * sin(middle), height = (double)(r.y1 - r.y0) / H;
    return r.y1 - r.y0 < 2 || (r.x1 - r.x0 >= 2 && width > height);
}

static int cut(region *regions, int wanted)
{
    regions[0] = (region){0, 0, W, H};
    int count = 1;
    for (; count < wanted; count++) {
        int chosen = -1;
        double most = 0;
        for (int i = 0; i < count; i++) {
            const region r = regions[i];
            const bool single = r.x1 - r.x0 < 2 && r.y1 - r.y0 < 2;
            const double energy = single ? -1 : sum_of(r).luminance;
            if (energy > most * (1 + 1e-5)) { // of equal ones the first
                most = energy;
                chosen = i;
            }
        }
        if (chosen < 0) {
            break;
        }
        const region r = regions[chosen];
        const bool wide = is_wide(r);
        region best = r;
        double least = INFINITY;
        for (int at = (wide ? r.x0 : r.y0) + 1; at < (wide ? r.x1 : r.y1); at++) {
            region part = r;
            *(wide ? &part.x1 : &part.y1) = at;
            const double uneven = fabs(2 * sum_of(part).luminance - most);
            if (uneven < least - 1e-5 * most) {
                least = uneven;
                best = part;
            }
        }
        regions[chosen] = best;
        regions[count] = r;
        *(wide ? &regions[count].x0 : &regions[count].y0) = wide ? best.x1 : best.y1;
    }
    return count;
}

// ---- checks -----------------------------------------------------------------------------------

static const struct constellation_block *run(gpu_test *t, const float *rgba, uint32_t lights)
{
    const tyn_env_importance_params no_suns = {{0}};
    const tyn_median_cut_params params = {.lights = lights, .map = rgba != NULL};
    tyn_ref sums[ENV_IMPORTANCE_NUM_PORTS] = {{0}}, refs[MEDIAN_CUT_NUM_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    if (rgba) {
        sums[ENV_IMPORTANCE_PORT_ENV_MAP] =
            gpu_image(t, "map", TYN_IMAGE_2D, (tyn_extent){SKY_WIDTH, SKY_HEIGHT, 1}, 4, rgba);
        assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_env_importance, &no_suns, sums), TYN_OK);
        refs[MEDIAN_CUT_PORT_SUMS] = sums[ENV_IMPORTANCE_PORT_SUMS];
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_median_cut, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "constellation", refs[MEDIAN_CUT_PORT_CONSTELLATION], true);
    gpu_run(t);
    return gpu_map(t, "constellation");
}

// Lights, sums and directions; `twin`: the same regions as the twin's, else any that have the map's power.
static void check(gpu_test *t, const float *rgba, uint32_t lights, bool twin)
{
    const struct constellation_block *found = run(t, rgba, lights);
    region regions[TYN_CONSTELLATION_MAX];
    const int count = cut(regions, (int)lights);
    const texel all = sum_of((region){0, 0, W, H});
    assert_int_equal(found->count, count);
    double power[3] = {0}, solid_angle = 0, most = 0, least = INFINITY, worst = 0;
    for (int i = 0; i < count; i++) {
        const struct constellation_light *l = &found->lights[i];
        const region r =
            twin ? regions[i]
                 : (region){(int)l->first[0], (int)l->first[1], (int)l->end[0], (int)l->end[1]};
        assert_true((int)l->first[0] == r.x0 && (int)l->first[1] == r.y0);
        assert_true((int)l->end[0] == r.x1 && (int)l->end[1] == r.y1);
        const texel s = sum_of(r);
        const double apart =
            sqrt(s.moment[0] * s.moment[0] + s.moment[1] * s.moment[1] + s.moment[2] * s.moment[2]);
        for (int c = 0; c < 3; c++) {
            power[c] += l->power[c];
            worst = maximum(worst, fabs(l->power[c] - s.power[c]) / all.luminance);
            if (apart > 0.02 * s.luminance && s.luminance > 1e-3 * all.luminance) {
                worst = maximum(worst, 0.1 * fabs(l->direction[c] - s.moment[c] / apart));
            }
        }
        solid_angle += l->solid_angle;
        most = maximum(most, l->luminance);
        least = minimum(least, l->luminance);
    }
    for (int c = 0; c < 3; c++) {
        assert_true(fabs(power[c] - all.power[c]) < 2e-5 * all.luminance);
    }
    print_message("%u lights: %d, strongest %.2f of the mean, weakest %.2f; %.1e off; %.3f ms\n",
                  lights, count, most * count / all.luminance, least * count / all.luminance, worst,
                  gpu_ms(t, "median_cut"));
    assert_true(fabs(solid_angle - 4 * M_PI) < 1e-4);
    assert_true(worst < 1e-4);
}

static float *make_map(double contrast, bool sun)
{
    float *rgba = calloc(4 * SKY_WIDTH * SKY_HEIGHT, sizeof *rgba);
    uint32_t seed = 5;
    double rough[8][16][3];
    for (int q = 0; q < 8 * 16 * 3; q++) {
        rough[q / 48][q / 3 % 16][q % 3] = exp(contrast * random_unit(&seed));
    }
    for (int j = 0; j < SKY_HEIGHT; j++) {
        for (int i = 0; i < SKY_WIDTH; i++) {
            for (int c = 0; c < 3; c++) {
                rgba[4 * (j * SKY_WIDTH + i) + c] =
                    (float)(rough[j / 32][i / 32][c] * (1 + 0.1 * random_unit(&seed)));
            }
            if (sun && abs(i - 100) < 2 && abs(j - 60) < 2) {
                rgba[4 * (j * SKY_WIDTH + i)] = rgba[4 * (j * SKY_WIDTH + i) + 1] =
                    rgba[4 * (j * SKY_WIDTH + i) + 2] = 3e4f;
            }
        }
    }
    make_texels(rgba);
    return rgba;
}

static void maps(void **state)
{
    static const uint32_t counts[] = {1, 2, 3, 4, 8, 16, 20, 64};
    for (int k = 0; k < 4; k++) {
        float *rgba = make_map(k < 2 ? 1 : 4, k % 2);
        for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
            check(*state, rgba, counts[i], true);
        }
        free(rgba);
    }
}

// A map of one colour and a constant radiance have the same lights: all of about one power.
static void constant(void **state)
{
    float *rgba = malloc(4 * SKY_WIDTH * SKY_HEIGHT * sizeof *rgba);
    for (int i = 0; i < 4 * SKY_WIDTH * SKY_HEIGHT; i++) {
        rgba[i] = 1;
    }
    make_texels(rgba);
    for (int k = 0; k < 2; k++) {
        check(*state, k ? rgba : NULL, 1, false);
        check(*state, k ? rgba : NULL, 16, false);
        check(*state, k ? rgba : NULL, 64, false);
        const struct constellation_block *found = run(*state, k ? rgba : NULL, 64);
        for (uint32_t i = 0; i < 64; i++) {
            assert_true(fabs(found->lights[i].luminance * 64 / (4 * M_PI) - 1) < 0.13);
        }
    }
    free(rgba);
}

// Of one bright texel there is one light, in its direction; a black map has none.
static void extremes(void **state)
{
    float *rgba = calloc(4 * SKY_WIDTH * SKY_HEIGHT, sizeof *rgba);
    const struct constellation_block *found = run(*state, rgba, 20);
    assert_int_equal(found->count, 0);
    const int i = 300, j = 40;
    for (int c = 0; c < 3; c++) {
        rgba[4 * (j * SKY_WIDTH + i) + c] = 1000;
    }
    make_texels(rgba);
    found = run(*state, rgba, 20);
    uint32_t lit = 0;
    for (uint32_t k = 0; k < found->count; k++) {
        lit += found->lights[k].luminance > 0;
        if (found->lights[k].luminance > 0) {
            const double polar = M_PI * (j + 0.5) / SKY_HEIGHT;
            const double azimuth = ((i + 0.5) / SKY_WIDTH - 0.5) * 2 * M_PI;
            const float *d = found->lights[k].direction;
            assert_true(fabs(d[0] - sin(polar) * sin(azimuth)) < 1e-5);
            assert_true(fabs(d[1] - cos(polar)) < 1e-5);
            assert_true(fabs(d[2] + sin(polar) * cos(azimuth)) < 1e-5);
        }
    }
    assert_int_equal(lit, 1);
    free(rgba);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps),
        cmocka_unit_test(constant),
        cmocka_unit_test(extremes),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
