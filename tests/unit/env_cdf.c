// env_cdf.c -- the alias table of environment maps gives every cell its probability.
#include "frame/env_cdf.h"
#include "shaders/light/env_args.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static const struct env_cell *cells_of(const void *table)
{
    return (const struct env_cell *)((const char *)table + sizeof(struct env_table_block));
}

// What Walker's method draws: 1 / count through each cell, shared with its alias.
static double *drawn(const void *table, uint32_t count)
{
    double *p = calloc(count, sizeof *p);
    const struct env_cell *cells = cells_of(table);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(cells[i].alias < count);
        assert_true(cells[i].keep >= 0 && cells[i].keep <= 1);
        p[i] += (double)cells[i].keep / count;
        p[cells[i].alias] += (1.0 - (double)cells[i].keep) / count;
    }
    return p;
}

static void probabilities(void **state)
{
    (void)state;
    enum { W = 37, H = 19 };
    static float data[W * H * 3];
    for (int i = 0; i < W * H; i++) {
        float v = i % 11 ? (float)(i * 7919 % 101) : 0;
        v = i == 5 * W + 7 ? 5e5f : v; // a sun
        data[3 * i] = v;
        data[3 * i + 1] = 0.5f * v;
        data[3 * i + 2] = 2 * v;
    }
    tyn_environment env = {.present = true, .size = {W, H}, .data = data};
    size_t size = tyn_env_cdf_size(&env);
    assert_int_equal(size, 16 + W * H * 12);
    void *table = malloc(size), *again = malloc(size);
    assert_true(tyn_env_cdf_build(&env, table));
    assert_true(tyn_env_cdf_build(&env, again));
    assert_memory_equal(table, again, size);
    double *p = drawn(table, W * H), sum = 0;
    for (int i = 0; i < W * H; i++) {
        double density = cells_of(table)[i].density;
        assert_true(fabs(p[i] * W * H - density) < 1e-5 * (1 + density));
        sum += p[i];
        // Wherever the map, interpolated, is bright, there is a chance.
        assert_true(data[3 * i] == 0 || density > 0);
    }
    assert_true(fabs(sum - 1) < 1e-6);
    assert_true(p[5 * W + 7] > 0.1); // the sun gets a ninth of its block's light
    free(p);
    free(table);
    free(again);
}

static void constant_and_black(void **state)
{
    (void)state;
    tyn_environment env = {.present = true, .radiance = {1, 1, 1}};
    assert_int_equal(tyn_env_cdf_size(&env), 0);
    static float black[4 * 2 * 3];
    env = (tyn_environment){.present = true, .size = {4, 2}, .data = black};
    void *table = malloc(tyn_env_cdf_size(&env));
    assert_true(tyn_env_cdf_build(&env, table));
    for (int i = 0; i < 8; i++) {
        assert_true(cells_of(table)[i].density == 1);
    }
    free(table);
}

static void large_maps_are_averaged(void **state)
{
    (void)state;
    enum { W = 4096, H = 2048 };
    float *data = malloc((size_t)W * H * 3 * sizeof *data);
    for (size_t i = 0; i < (size_t)W * H * 3; i++) {
        data[i] = 1;
    }
    tyn_environment env = {.present = true, .size = {W, H}, .data = data};
    size_t size = tyn_env_cdf_size(&env);
    assert_int_equal(size, 16 + (size_t)2048 * 1024 * 12);
    void *table = malloc(size);
    assert_true(tyn_env_cdf_build(&env, table));
    // Uniform radiance: probability follows the solid angle, pi / 2 sin(theta).
    for (uint32_t y = 0; y < 1024; y += 93) {
        double expected = M_PI / 2 * sin(M_PI * (y + 0.5) / 1024);
        assert_true(fabs((double)cells_of(table)[(size_t)y * 2048 + 77].density - expected) < 1e-4);
    }
    free(table);
    free(data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(probabilities),
        cmocka_unit_test(constant_and_black),
        cmocka_unit_test(large_maps_are_averaged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
