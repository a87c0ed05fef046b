// voxel_distance.c -- the distance map against all pairs of voxels: random, empty, full and single, odd sizes, unequal sides.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "passes/constellation/voxel_distance/voxel_distance.h"
#include "random_unit.h"
#include "shaders/common/scene_args.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PORT(name) VOXEL_DISTANCE_PORT_##name

typedef struct grid {
    uint32_t size[3];
    float side[3];
    float *density;
} grid;

static size_t count_of(const grid *g)
{
    return (size_t)g->size[0] * g->size[1] * g->size[2];
}

static grid make_grid(uint32_t x, uint32_t y, uint32_t z, const float side[3])
{
    grid g = {.size = {x, y, z}, .side = {side[0], side[1], side[2]}};
    g.density = calloc(count_of(&g), sizeof *g.density);
    return g;
}

// Of every voxel, by all pairs. `reach`: voxels count that have one that is not empty among themselves and their neighbours.
static double brute_force(const grid *g, const float *shine, int reach, size_t q)
{
    const size_t nx = g->size[0], ny = g->size[1];
    const size_t at[3] = {q % nx, q / nx % ny, q / (nx * ny)};
    double best = INFINITY;
    for (size_t p = 0; p < count_of(g); p++) {
        if (!(g->density[p] > 0) && !(shine && shine[4 * p] > 0)) {
            continue;
        }
        const size_t other[3] = {p % nx, p / nx % ny, p / (nx * ny)};
        double sum = 0;
        for (int a = 0; a < 3; a++) {
            const double d = fmax(fabs((double)at[a] - (double)other[a]) - reach, 0);
            sum += d * d * g->side[a] * g->side[a];
        }
        best = fmin(best, sum);
    }
    return sqrt(best);
}

// Four channels a voxel, of which the first is the grid's.
static float *spread(const grid *g)
{
    float *rgba = calloc(4 * count_of(g), sizeof *rgba);
    for (size_t q = 0; q < count_of(g); q++) {
        rgba[4 * q] = g->density[q];
    }
    return rgba;
}

// `shine`: of unequal media (their coefficients are the grid's red channel), light that each voxel emits.
static void check_reach(gpu_test *t, const grid *g, const float *shine, int reach, const char *name)
{
    const bool coefficients = shine != NULL;
    const tyn_extent size = {g->size[0], g->size[1], g->size[2]};
    tyn_voxel_distance_params params = {.mode = coefficients ? TYN_MEDIUM_COEFFICIENTS
                                                             : TYN_MEDIUM_DENSITY,
                                        .emissive = coefficients,
                                        .reach = (uint32_t)reach,
                                        .voxel = {g->side[0], g->side[1], g->side[2]}};
    tyn_ref refs[VOXEL_DISTANCE_NUM_PORTS] = {0};
    float *rgba = spread(g);
    tyn_graph_begin(t->graph);
    refs[PORT(DENSITY)] = gpu_image(t, "density", TYN_IMAGE_3D, size, coefficients ? 4 : 1,
                                    coefficients ? rgba : g->density);
    if (coefficients) {
        refs[PORT(SIGMA_A)] = gpu_image(t, "sigma_a", TYN_IMAGE_3D, size, 4, rgba);
        refs[PORT(EMISSION)] = gpu_image(t, "emission", TYN_IMAGE_3D, size, 4, shine);
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_voxel_distance, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "voxels", refs[PORT(VOXELS)], true);
    gpu_run(t);
    const float *found = gpu_map(t, "voxels");
    const size_t stride = coefficients ? 4 : 2;
    double worst = 0;
    for (size_t q = 0; q < count_of(g); q++) {
        const double right = brute_force(g, shine, reach, q);
        const float away = found[stride * q + stride - 1];
        assert_true(found[stride * q] == (coefficients ? 2 : 1) * g->density[q]);
        if (isinf(right)) {
            assert_true(away == VOXEL_DISTANCE_EMPTY);
        } else {
            worst = maximum(worst, fabs(away - right) / fmax(right, 1e-6));
            assert_true((away == 0) == (right == 0));
        }
    }
    print_message("%s, %u x %u x %u: %.1e off all pairs; %.2f ms\n", name, size.x, size.y, size.z,
                  worst, gpu_ms(t, "voxel_distance"));
    assert_true(worst < 1e-6);
    free(rgba);
}

static void check(gpu_test *t, const grid *g, const float *shine, const char *name)
{
    check_reach(t, g, shine, 0, name);
    check_reach(t, g, shine, 1, name);
}

static const float cube[3] = {0.1f, 0.1f, 0.1f}, brick[3] = {0.3f, 0.05f, 0.17f};

static void random_grids(void **state)
{
    static const uint32_t sizes[][3] = {{16, 16, 16}, {13, 7, 5}, {1, 31, 9},  {33, 1, 17},
                                        {9, 12, 1},   {1, 1, 1},  {40, 3, 11}, {20, 24, 18}};
    uint32_t seed = 7;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        static const double filled[] = {0.3, 0.02, 0.002};
        for (int k = 0; k < 6; k++) {
            grid g = make_grid(sizes[i][0], sizes[i][1], sizes[i][2], k % 2 ? brick : cube);
            for (size_t q = 0; q < count_of(&g); q++) {
                g.density[q] = random_unit(&seed) < filled[k / 2] ? (float)random_unit(&seed) : 0;
            }
            check(*state, &g, NULL, k % 2 ? "unequal sides" : "cubes");
            free(g.density);
        }
    }
}

static void empty_full_single(void **state)
{
    grid g = make_grid(19, 11, 14, brick);
    check(*state, &g, NULL, "empty");
    g.density[5 + 19 * (7 + 11 * 13)] = 1e-30f;
    check(*state, &g, NULL, "single");
    g.density[0] = -3; // no medium
    check(*state, &g, NULL, "single and a negative one");
    for (size_t q = 0; q < count_of(&g); q++) {
        g.density[q] = 0.5f;
    }
    check(*state, &g, NULL, "full");
    free(g.density);
}

// Of unequal media a voxel that only emits is not empty.
static void coefficients(void **state)
{
    uint32_t seed = 3;
    grid g = make_grid(15, 10, 12, brick);
    float *shine = calloc(4 * count_of(&g), sizeof *shine);
    for (size_t q = 0; q < count_of(&g); q++) {
        g.density[q] = random_unit(&seed) < 0.01 ? 1.0f : 0;
        shine[4 * q] = random_unit(&seed) < 0.01 ? 1.0f : 0;
    }
    check(*state, &g, shine, "coefficients");
    free(shine);
    free(g.density);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_grids),
        cmocka_unit_test(empty_full_single),
        cmocka_unit_test(coefficients),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
