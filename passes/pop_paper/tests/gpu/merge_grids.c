// merge_grids.c -- the merge of the aligned grids against a CPU twin in double precision, and its limits.
#include "bound.h"
#include "gpu_test.h"
#include "passes/pop_paper/merge_grids/merge_grids.h"
#include "passes/pop_paper/common/propagate_radial_grid.h"
#include "shaders/common/scene_args.h"
#include "numbers.h"
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

// `off`: of the coordinate, cells.
static double seen_at(const struct grid *g, uint32_t stack, const double p[3], const double off[3])
{
    double at[3], sum = 0;
    for (int a = 0; a < 3; a++) {
        at[a] = 0;
        for (int x = 0; x < 3; x++) {
            at[a] += g->axes[a][x] * (p[x] - g->origin[x]) / g->cell;
        }
        at[a] = fmin(fmax(at[a] + off[a] - 0.5, 0), g->size[a] - 1.0);
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

// What texture units may change of it.
static double seen_error(const struct grid *g, uint32_t stack, const double p[3], double shift)
{
    const double exact = seen_at(g, stack, p, (double[]){0, 0, 0});
    double most = 0;
    for (int k = 0; k < 8; k++) {
        const double off[3] = {k & 1 ? shift : -shift, k & 2 ? shift : -shift,
                               k & 4 ? shift : -shift};
        most = maximum(most, fabs(seen_at(g, stack, p, off) - exact));
    }
    return most;
}

static void equals_twin(void **state)
{
    const double shift = gpu_filter_shift(*state);
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
                double off = 0;
                for (uint32_t n = 0; n < GRIDS; n++) {
                    const uint32_t stack = n * channels + (channels == 1 ? 0 : c);
                    const double irradiance = (double)grids[n].irradiance[c];
                    expected += irradiance * seen_at(&grids[n], stack, p, (double[]){0, 0, 0});
                    off += irradiance * seen_error(&grids[n], stack, p, shift);
                }
                assert_true(isfinite(found[4 * q + c]));
                worst =
                    maximum(worst, (fabs((double)found[4 * q + c] - expected) - off) / expected);
            }
            assert_near(found[4 * q + 3], 0.25 * (2 + 4 + 9) / 3, 1e-5);
        }
        print_message("%u channels: largest relative difference %.1e\n", channels, worst);
        assert_true(worst < 1e-4);
    }
}

// ---- radial grids -------------------------------------------------------------------------------

enum { SIDE = 12, LAYERS = 9, FINE = 20 };

// r^2 L_acc of a lamp: smooth in the direction and along the radius.
static double radial_seen(const double away[3])
{
    double r = sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]);
    return (2 + away[0] / r + 0.5 * away[2] / r) / (1 + r);
}

// A point of the octahedral map, r away. What lies beyond an edge is at the mirrored place of that edge.
static void point_of_map(double u, double v, double r, double d[3])
{
    double length = 0;
    if (fabs(u) > 1) {
        u = copysign(2 - fabs(u), u);
        v = -v;
    }
    if (fabs(v) > 1) {
        v = copysign(2 - fabs(v), v);
        u = -u;
    }
    d[2] = 1 - fabs(u) - fabs(v);
    d[0] = d[2] >= 0 ? u : copysign(1 - fabs(v), u);
    d[1] = d[2] >= 0 ? v : copysign(1 - fabs(u), v);
    for (int a = 0; a < 3; a++) {
        length += d[a] * d[a];
    }
    for (int a = 0; a < 3; a++) {
        d[a] *= r / sqrt(length);
    }
}

static double mean_of_cell(uint32_t q, double dx, const double lamp[3])
{
    double mean = 0;
    for (int n = 0; n < FINE * FINE * FINE; n++) {
        const int part[3] = {n % FINE, n / FINE % FINE, n / FINE / FINE};
        const uint32_t cell[3] = {q % 24, q / 24 % 20, q / 480};
        double away[3], r2 = 0;
        for (int a = 0; a < 3; a++) {
            away[a] = (cell[a] + (part[a] + 0.5) / FINE) * dx - lamp[a];
            r2 += away[a] * away[a];
        }
        mean += radial_seen(away) / r2;
    }
    return mean / (FINE * FINE * FINE);
}

// A lamp's light, and that of an equal VPL, arrives with the power that its own grid has, wherever the
// cells are.
static void radial_power(void **state)
{
    gpu_test *t = *state;
    static const double lamp[3] = {0.43, 0.52, 0.31};
    static float tile[LAYERS][SIDE + 2][SIDE + 2];
    const double growth = exp(sqrt(4 * 3.14159265358979) / SIDE);
    const double inner = 1.2 * pow(growth, 1 - LAYERS);
    for (int k = 0; k < LAYERS; k++) {
        double r = k == 0 ? 0.5 * inner : inner * pow(growth, k - 0.5);
        for (int j = 0; j < SIDE + 2; j++) {
            for (int i = 0; i < SIDE + 2; i++) {
                double d[3];
                point_of_map((2 * i - 1.0) / SIDE - 1, (2 * j - 1.0) / SIDE - 1, r, d);
                tile[k][j][i] = (float)radial_seen(d);
            }
        }
    }
    struct medium_block medium = {.extent = {extent[0], extent[1], extent[2]},
                                  .size = {NX, NY, NZ},
                                  .voxel = {extent[0] / NX, extent[1] / NY, extent[2] / NZ}};
    struct propagate_radial_place place = {
        .position = {(float)lamp[0], (float)lamp[1], (float)lamp[2]},
        .per_inner = (float)(1 / inner),
        .to_map = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
        .per_layer = (float)(1 / log(growth)),
        .intensity = {1, 2, 4},
        .layers = LAYERS,
    };
    tyn_merge_grids_params params;
    tyn_pass_defaults(&tyn_pass_merge_grids, &params);
    params.grid_cells = 4;
    params.num_lamps = params.num_vpls = params.channels = 1;
    params.lamp_cells = params.vpl_cells = SIDE;
    memcpy(params.extent, extent, sizeof extent);
    tyn_ref refs[MERGE_GRIDS_NUM_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    refs[MERGE_GRIDS_PORT_MEDIUM] = gpu_buffer(t, "medium", &medium, sizeof medium);
    refs[MERGE_GRIDS_PORT_DENSITY] =
        gpu_image(t, "density", TYN_IMAGE_3D, (tyn_extent){NX, NY, NZ}, 1, density);
    refs[MERGE_GRIDS_PORT_LAMP_PLACES] = refs[MERGE_GRIDS_PORT_VPL_PLACES] =
        gpu_buffer(t, "places", &place, sizeof place);
    refs[MERGE_GRIDS_PORT_LAMP_SEEN] = refs[MERGE_GRIDS_PORT_VPL_SEEN] = gpu_image(
        t, "seen", TYN_IMAGE_3D, (tyn_extent){SIDE + 2, SIDE + 2, LAYERS}, 1, &tile[0][0][0]);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_merge_grids, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "merged", refs[MERGE_GRIDS_PORT_MERGED], true);
    gpu_run(t);
    tyn_extent size;
    VkFormat format;
    const float *found = tyn_graph_map(t->graph, "merged", &size, &format);
    assert_true(size.x == 24 && size.y == 20 && size.z == 16); // twice as fine as the map
    double sum = 0, expected = 0, worst = 0;
    for (uint32_t q = 0; q < size.x * size.y * size.z; q++) {
        double of_cell = (double)found[4 * q], mean = 2 * mean_of_cell(q, 1.2 / 24, lamp);
        assert_near(found[4 * q + 2], 4 * of_cell, 1e-5 * of_cell);
        sum += of_cell;
        expected += mean;
        worst = maximum(worst, fabs(of_cell - mean) / mean);
    }
    print_message("light of a lamp: sum %+.2f %%, worst cell %.1f %%\n", 100 * (sum / expected - 1),
                  100 * worst);
    assert_within(fabs(sum / expected - 1), 8e-3, NULL);
    assert_within(worst, 0.06, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equals_twin),
        cmocka_unit_test(radial_power),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
