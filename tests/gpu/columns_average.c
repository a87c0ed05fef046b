// columns_average.c -- the medium averaged, against means of voxels.
#include "gpu_test.h"
#include "passes/columns_average/columns_average.h"
#include "voxels.h"
#include <math.h>
#include <stdlib.h>

enum { FINE = 16 };

static float density[FINE * FINE * FINE], coefficients[3][FINE * FINE * FINE][4];

static void fill(void)
{
    srand(4);
    for (int i = 0; i < FINE * FINE * FINE; i++) {
        density[i] = (float)rand() / (float)RAND_MAX;
        for (int c = 0; c < 3; c++) {
            coefficients[0][i][c] = i % 5 ? (float)rand() / (float)RAND_MAX : 0;
            coefficients[1][i][c] = (float)rand() / (float)RAND_MAX;
            // Backward, none, forward, and a peak narrower than the solvers resolve.
            coefficients[2][i][c] = c == 2 ? 0.999f : 2 * (float)rand() / (float)RAND_MAX - 1;
        }
    }
}

static void expect(double found, double right)
{
    if (!(fabs(found - right) <= 1e-5 * fabs(right) + 1e-6)) {
        fail_msg("%g, not %g", found, right);
    }
}

// Of texel `at` of the coarser grid, of side `side`: sigma_s, sigma_a and (1 - f) sigma_s; or density.
static void right_at(int side, const int at[3], int channel, uint32_t mode, double right[3])
{
    const int each = FINE / side / 2;
    right[0] = right[1] = right[2] = 0;
    for (int k = 0; k < each * each * each; k++) {
        const int p[3] = {at[0] * each + k % each, at[1] * each + k / each % each,
                          at[2] * each + k / each / each};
        if (mode == TYN_MEDIUM_DENSITY) {
            right[0] += voxels_mean(density, FINE, 1, 0, p);
            continue;
        }
        double v[3];
        for (int i = 0; i < 3; i++) {
            v[i] = voxels_mean(coefficients[i][0], FINE, 4, channel, p);
        }
        if (mode == TYN_MEDIUM_COEFFICIENTS) { // similarity: as much is scattered out of the peak
            v[0] *= fmin(1, (1 - v[2]) / 0.005);
        }
        const double g = fmin(v[2], 0.995);
        right[0] += v[0];
        right[1] += v[1];
        right[2] += v[0] * (g > 0 ? 1 - g * g : 1);
    }
    for (int i = 0; i < 3; i++) {
        right[i] /= each * each * each;
    }
}

static void means(void **state)
{
    gpu_test *t = *state;
    const tyn_pass_desc *pass = &tyn_pass_columns_average;
    const tyn_extent size = {FINE, FINE, FINE};
    fill();
    static const uint32_t modes[] = {TYN_MEDIUM_DENSITY, TYN_MEDIUM_COEFFICIENTS,
                                     TYN_MEDIUM_ONE_PHASE};
    for (int variant = 0; variant < 6; variant++) {
        const int side = variant / 3 ? FINE / 4 : FINE / 2;
        const uint32_t mode = modes[variant % 3];
        const bool whole = mode == TYN_MEDIUM_DENSITY, varies = mode == TYN_MEDIUM_COEFFICIENTS;
        tyn_columns_average_params params = {.mode = mode};
        for (int a = 0; a < 3; a++) {
            params.size[a] = (uint32_t)side;
        }
        tyn_ref refs[TYN_MAX_PORTS] = {{0}};
        tyn_graph_begin(t->graph);
        *gpu_port(pass, refs, "density") = gpu_image(
            t, "density", TYN_IMAGE_3D, size, whole ? 1 : 4, whole ? density : coefficients[0][0]);
        if (!whole) {
            *gpu_port(pass, refs, "sigma_a") =
                gpu_image(t, "sigma_a", TYN_IMAGE_3D, size, 4, coefficients[1][0]);
        }
        if (varies) {
            *gpu_port(pass, refs, "g") =
                gpu_image(t, "g", TYN_IMAGE_3D, size, 4, coefficients[2][0]);
        }
        assert_int_equal(tyn_graph_add(t->graph, pass, &params, refs), TYN_OK);
        const char *const names[] = {whole ? "mean_density" : "mean_sigma_s", "mean_sigma_a",
                                     "mean_g"};
        for (int i = 0; i < (whole ? 1 : varies ? 3 : 2); i++) {
            tyn_graph_output(t->graph, names[i], *gpu_port(pass, refs, names[i]), true);
        }
        gpu_run(t);
        const float *found[3] = {gpu_map(t, names[0]), whole ? NULL : gpu_map(t, names[1]),
                                 varies ? gpu_map(t, names[2]) : NULL};
        for (int i = 0; i < side * side * side; i++) {
            const int at[3] = {i % side, i / side % side, i / side / side};
            for (int c = 0; c < (whole ? 1 : 3); c++) {
                double right[3];
                right_at(side, at, c, mode, right);
                if (whole) {
                    expect((double)found[0][i], right[0]);
                    continue;
                }
                expect((double)found[0][4 * i + c], right[0]);
                expect((double)found[1][4 * i + c], right[1]);
                if (varies) {
                    const double g = (double)found[2][4 * i + c];
                    expect((double)found[0][4 * i + c] * (1 - g * g), right[2]);
                }
            }
        }
    }
}

// Two texels a cell, if the medium is finer than that by a quarter or more.
static void sizes(void **state)
{
    (void)state;
    const struct {
        uint32_t fine, cells, right; // 0: not worth while
    } cases[] = {{64, 16, 32}, {64, 32, 0}, {40, 16, 0}, {41, 16, 32}, {3, 1, 2}};
    for (int i = 0; i < 5; i++) {
        struct medium_block medium = {.extent = {2, 2, 2}};
        const uint32_t dims[3] = {cases[i].cells, cases[i].cells, cases[i].cells};
        uint32_t size[3];
        for (int a = 0; a < 3; a++) {
            medium.size[a] = cases[i].fine;
        }
        const bool averages = tyn_columns_average_size(&medium, dims, size);
        assert_int_equal(averages, cases[i].right != 0);
        assert_true(!averages || size[0] == cases[i].right);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(means), cmocka_unit_test(sizes)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
