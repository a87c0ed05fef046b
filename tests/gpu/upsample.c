// upsample.c -- the bilateral upsampling against a CPU twin in double precision, and its limits.
#include "gpu_test.h"
#include "passes/upsample/upsample.h"
#include "scene_args.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PORT(name) UPSAMPLE_PORT_##name

enum {
    NX = 24,
    NY = 20,
    NZ = 16,
    LAYERS = 7,
    SUNS = 2,
    GRID_TEXELS = LAYERS * LAYERS * LAYERS * (3 + 1) // one grid of three channels, one of one
};

static const float extent[3] = {1.2f, 1.0f, 0.8f};
static float density[NX * NY * NZ], cells[GRID_TEXELS * 4], seen[GRID_TEXELS];
static struct propagate_grid grids[SUNS];

static float random_unit(void)
{
    return (float)(rand() % 10000) * 1e-4f;
}

static void make_inputs(void)
{
    srand(3);
    for (int q = 0; q < NX * NY * NZ; q++) {
        density[q] = rand() % 5 ? random_unit() : 0;
    }
    for (int q = 0; q < GRID_TEXELS * 4; q++) {
        cells[q] = 5 * random_unit();
    }
    for (int q = 0; q < GRID_TEXELS; q++) {
        seen[q] = random_unit();
    }
    // One grid along the axes that is smaller than the box (so that its outer cells are repeated), one
    // turned about the diagonal.
    grids[0] = (struct propagate_grid){.origin = {0.1f, 0, 0.1f},
                                       .cell = 0.15f,
                                       .across_u = {1, 0, 0},
                                       .across_v = {0, 1, 0},
                                       .direction = {0, 0, 1},
                                       .channels = 3,
                                       .irradiance = {2, 1, 0.5f},
                                       .size = {7, 6, 4}};
    grids[1] = (struct propagate_grid){.origin = {-0.3f, 0.1f, 0.4f},
                                       .cell = 0.25f,
                                       .across_u = {2 / 3.0f, -1 / 3.0f, 2 / 3.0f},
                                       .across_v = {2 / 3.0f, 2 / 3.0f, -1 / 3.0f},
                                       .direction = {-1 / 3.0f, 2 / 3.0f, 2 / 3.0f},
                                       .first_layer = 3 * LAYERS,
                                       .channels = 1,
                                       .irradiance = {1, 2, 3},
                                       .light = 1,
                                       .size = {5, 7, 7}};
}

static const float *run(gpu_test *t, float range, int32_t max_cells, tyn_extent *size)
{
    struct medium_block medium = {
        .extent = {extent[0], extent[1], extent[2]}, .size = {NX, NY, NZ}, .sigma_s = {2, 4, 9}};
    tyn_upsample_params params;
    tyn_pass_defaults(&tyn_pass_upsample, &params);
    params.cells = max_cells;
    params.range = range;
    params.num_suns = SUNS;
    params.grid_cells = LAYERS;
    memcpy(params.extent, extent, sizeof extent);
    memcpy(params.size, medium.size, sizeof params.size);
    tyn_extent stack = {LAYERS, LAYERS, LAYERS * (3 + 1)};
    tyn_ref refs[UPSAMPLE_NUM_PORTS] = {0};
    tyn_graph_begin(t->graph);
    refs[PORT(MEDIUM)] = gpu_buffer(t, "medium", &medium, sizeof medium);
    refs[PORT(GRIDS)] = gpu_buffer(t, "grids", grids, sizeof grids);
    refs[PORT(DENSITY)] =
        gpu_image(t, "density", TYN_IMAGE_3D, (tyn_extent){NX, NY, NZ}, 1, density);
    refs[PORT(CELLS)] = gpu_image(t, "cells", TYN_IMAGE_3D, stack, 4, cells);
    refs[PORT(SEEN)] = gpu_image(t, "seen", TYN_IMAGE_3D, stack, 1, seen);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_upsample, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "inscatter", refs[PORT(INSCATTER)], true);
    gpu_run(t);
    VkFormat format;
    return tyn_graph_map(t->graph, "inscatter", size, &format);
}

// ---- twin -------------------------------------------------------------------------------------

static int clamped(int i, int n)
{
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

static double density_at(const double p[3])
{
    const int n[3] = {NX, NY, NZ};
    double sum = 0, at[3];
    for (int a = 0; a < 3; a++) {
        at[a] = p[a] / extent[a] * n[a] - 0.5;
    }
    for (int corner = 0; corner < 8; corner++) {
        double weight = 1;
        int index[3];
        for (int a = 0; a < 3; a++) {
            int base = (int)floor(at[a]), up = corner >> a & 1;
            weight *= up ? at[a] - base : 1 - (at[a] - base);
            index[a] = clamped(base + up, n[a]);
        }
        sum += weight * density[(index[2] * NY + index[1]) * NX + index[0]];
    }
    return sum;
}

static double seen_at(const struct propagate_grid *grid, const double p[3], double range, int c)
{
    const float *axes[3] = {grid->across_u, grid->across_v, grid->direction};
    double at[3], sum = 0, weights = 0, here = density_at(p) * (2 + 4 + 9) / 3;
    for (int a = 0; a < 3; a++) {
        at[a] = -0.5;
        for (int x = 0; x < 3; x++) {
            at[a] += axes[a][x] * (p[x] - grid->origin[x]) / grid->cell;
        }
    }
    for (int corner = 0; corner < 8; corner++) {
        double weight = 1;
        int index[3];
        for (int a = 0; a < 3; a++) {
            int base = (int)floor(at[a]), up = corner >> a & 1;
            weight *= up ? at[a] - base : 1 - (at[a] - base);
            index[a] = clamped(base + up, (int)grid->size[a]);
        }
        int q = ((index[2] + (int)grid->first_layer) * LAYERS + index[1]) * LAYERS + index[0];
        if (range > 0) {
            double there = 0;
            for (int k = 0; k < 3; k++) {
                int texel = q + (grid->channels == 1 ? 0 : k * LAYERS * LAYERS * LAYERS);
                there += cells[4 * texel] / 3.0;
            }
            double d = fabs(here - there) / (here + there) / range;
            weight *= exp(-0.5 * d * d) + 1e-4;
        }
        sum += weight * seen[q + (grid->channels == 1 ? 0 : c * LAYERS * LAYERS * LAYERS)];
        weights += weight;
    }
    return grid->irradiance[c] * sum / weights;
}

static void equals_twin(void **state)
{
    make_inputs();
    for (int run_index = 0; run_index < 2; run_index++) {
        float range = run_index ? 0.25f : 0;
        tyn_extent size;
        const float *found = run(*state, range, 64, &size);
        // 24 cells of 0.05 m along the longest side, and the ghost layer.
        assert_true(size.x == 26 && size.y == 22 && size.z == 18);
        double worst = 0;
        for (uint32_t q = 0; q < size.x * size.y * size.z; q++) {
            int i[3] = {(int)(q % size.x), (int)(q / size.x % size.y),
                        (int)(q / (size.x * size.y))};
            double p[3] = {(clamped(i[0] - 1, 24) + 0.5) * 0.05,
                           (clamped(i[1] - 1, 20) + 0.5) * 0.05,
                           (clamped(i[2] - 1, 16) + 0.5) * 0.05};
            for (int c = 0; c < 3; c++) {
                double expected = seen_at(&grids[0], p, range, c) + seen_at(&grids[1], p, range, c);
                worst = fmax(worst, fabs(found[4 * q + (uint32_t)c] - expected) / expected);
            }
        }
        print_message("range %.2f: largest relative difference %.1e\n", range, worst);
        // The guide is filtered by the texture unit, and its errors grow with 1 / range^2.
        assert_true(worst < (range > 0 ? 1e-3 : 1e-5));
    }
}

// Whatever the guide, a constant stays that constant.
static void keeps_a_constant(void **state)
{
    make_inputs();
    for (int q = 0; q < GRID_TEXELS; q++) {
        seen[q] = 2.5f;
    }
    tyn_extent size;
    const float *found = run(*state, 0.05f, 16, &size);
    assert_int_equal(size.x, 18);
    for (uint32_t q = 0; q < size.x * size.y * size.z; q++) {
        for (uint32_t c = 0; c < 3; c++) {
            assert_float_equal(found[4 * q + c],
                               2.5 * (grids[0].irradiance[c] + grids[1].irradiance[c]), 1e-5);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(equals_twin),
                                       cmocka_unit_test(keeps_a_constant)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
