// merge_grids.c -- the merge of the aligned grids against a CPU twin in double precision, and its limits.
#include "gpu_test.h"
#include "passes/merge_grids/merge_grids.h"
#include "scene_args.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NX = 24, NY = 20, NZ = 16, EDGE = 7, GRIDS = 3, TILES = 3 };

static const float extent[3] = {1.2f, 1.0f, 0.8f};
static float density[NX * NY * NZ], seen[EDGE][EDGE * TILES][EDGE * TILES]; // z, y, x

// M -> cells, with the cell's edge and orthonormal axes.
static const struct grid {
    double origin[3], cell, axes[3][3];
    uint32_t size[3];
    float irradiance[3];
} grids[GRIDS] = {
    // Smaller than the box: its outer cells are repeated.
    {{0.1, 0, 0.1}, 0.15, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {7, 6, 4}, {2, 1, 0.5f}},
    {{-0.3, 0.1, 0.4},
     0.25,
     {{2 / 3.0, -1 / 3.0, 2 / 3.0}, {2 / 3.0, 2 / 3.0, -1 / 3.0}, {-1 / 3.0, 2 / 3.0, 2 / 3.0}},
     {5, 7, 7},
     {1, 2, 3}},
    {{1.3, -0.1, 0}, 0.2, {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}, {6, 7, 5}, {0, 4, 1}},
};

static const float *run(gpu_test *t, uint32_t channels, bool residuum, tyn_extent *size)
{
    struct medium_block medium = {
        .extent = {extent[0], extent[1], extent[2]},
        .size = {NX, NY, NZ},
        .voxel = {extent[0] / NX, extent[1] / NY, extent[2] / NZ},
        .sigma_s = {2, 4, 9},
    };
    struct propagate_place places[TYN_ORDINATES_MAX] = {{{{0}}}};
    for (int n = 0; n < GRIDS; n++) {
        const struct grid *g = &grids[n];
        for (int a = 0; a < 3; a++) {
            for (int x = 0; x < 3; x++) {
                places[n].rows[a][x] = (float)(g->axes[a][x] / g->cell);
                places[n].rows[a][3] -= (float)(g->axes[a][x] / g->cell * g->origin[x]);
            }
        }
        memcpy(places[n].irradiance, g->irradiance, sizeof g->irradiance);
        places[n].size = g->size[0] | g->size[1] << 8 | g->size[2] << 16;
    }
    tyn_merge_grids_params params;
    tyn_pass_defaults(&tyn_pass_merge_grids, &params);
    params.num_grids = GRIDS;
    params.grid_cells = EDGE;
    params.channels = channels;
    memcpy(params.extent, extent, sizeof extent);
    const float constant[4] = {10, 20, 30, 0};
    tyn_ref refs[MERGE_GRIDS_NUM_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    refs[MERGE_GRIDS_PORT_MEDIUM] = gpu_buffer(t, "medium", &medium, sizeof medium);
    refs[MERGE_GRIDS_PORT_DENSITY] =
        gpu_image(t, "density", TYN_IMAGE_3D, (tyn_extent){NX, NY, NZ}, 1, density);
    refs[MERGE_GRIDS_PORT_PLACES] = gpu_buffer(t, "places", places, sizeof places);
    refs[MERGE_GRIDS_PORT_SEEN] = gpu_image(
        t, "seen", TYN_IMAGE_3D, (tyn_extent){EDGE * TILES, EDGE * TILES, EDGE}, 1, &seen[0][0][0]);
    if (residuum) {
        refs[MERGE_GRIDS_PORT_RESIDUUM] =
            gpu_image(t, "residuum", TYN_IMAGE_3D, (tyn_extent){1, 1, 1}, 4, constant);
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_merge_grids, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "merged", refs[MERGE_GRIDS_PORT_MERGED], true);
    gpu_run(t);
    VkFormat format;
    return tyn_graph_map(t->graph, "merged", size, &format);
}

static double seen_at(const struct grid *g, uint32_t stack, const double p[3])
{
    double at[3], sum = 0;
    for (int a = 0; a < 3; a++) {
        at[a] = 0;
        for (int x = 0; x < 3; x++) {
            at[a] += g->axes[a][x] * (p[x] - g->origin[x]) / g->cell;
        }
        at[a] = fmin(fmax(at[a] - 0.5, 0), g->size[a] - 1.0);
    }
    for (int corner = 0; corner < 8; corner++) {
        double weight = 1;
        uint32_t index[3];
        for (int a = 0; a < 3; a++) {
            int base = (int)floor(at[a]), up = corner >> a & 1;
            weight *= up ? at[a] - base : 1 - (at[a] - base);
            index[a] = (uint32_t)(base + up) % EDGE; // weight 0 beyond the last one
        }
        sum += weight *
               seen[index[2]][stack / TILES * EDGE + index[1]][stack % TILES * EDGE + index[0]];
    }
    return sum;
}

static void equals_twin(void **state)
{
    srand(3);
    for (int q = 0; q < NX * NY * NZ; q++) {
        density[q] = 0.25f;
    }
    for (int q = 0; q < (int)(sizeof seen / sizeof(float)); q++) {
        (&seen[0][0][0])[q] = (float)(rand() % 1000) * 1e-3f;
    }
    for (uint32_t channels = 1; channels <= 3; channels += 2) {
        tyn_extent size;
        const float *found = run(*state, channels, channels == 1, &size);
        assert_true(size.x == 14 && size.y == 12 && size.z == 10); // cells of 1.2 m / 14
        double dx = 1.2 / 14, worst = 0;
        const double low[3] = {0, 0.5 * (1 - 12 * dx), 0.5 * (0.8 - 10 * dx)};
        for (uint32_t q = 0; q < size.x * size.y * size.z; q++) {
            double p[3] = {low[0] + (q % 14 + 0.5) * dx, low[1] + (q / 14 % 12 + 0.5) * dx,
                           low[2] + (q / 168 + 0.5) * dx};
            for (uint32_t c = 0; c < 3; c++) {
                double expected = channels == 1 ? 10.0 * (c + 1) : 0; // the residuum
                for (uint32_t n = 0; n < GRIDS; n++) {
                    expected += (double)grids[n].irradiance[c] *
                                seen_at(&grids[n], n * channels + (channels == 1 ? 0 : c), p);
                }
                assert_true(isfinite(found[4 * q + c]));
                worst = fmax(worst, fabs((double)found[4 * q + c] - expected) / expected);
            }
            assert_float_equal(found[4 * q + 3], 0.25 * (2 + 4 + 9) / 3, 1e-5);
        }
        print_message("%u channels: largest relative difference %.1e\n", channels, worst);
        assert_true(worst < 1e-4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(equals_twin)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
