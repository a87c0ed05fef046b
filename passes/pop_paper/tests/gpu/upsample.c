// upsample.c -- the bilateral upsampling against a CPU twin in double precision, and its limits.
#include "bound.h"
#include "gpu_test.h"
#include "passes/pop_paper/upsample/upsample.h"
#include "shaders/common/scene_args.h"
#include "numbers.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PORT(name) UPSAMPLE_PORT_##name

enum { NX = 24, NY = 20, NZ = 16, MX = 12, MY = 10, MZ = 8, MERGED = MX * MY * MZ };

static const float extent[3] = {1.2f, 1.0f, 0.8f};
static float density[NX * NY * NZ], merged[MERGED][4]; // cells of 0.1 m: light, sigma_s

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
    for (int q = 0; q < MERGED; q++) {
        for (int c = 0; c < 3; c++) {
            merged[q][c] = random_unit();
        }
        merged[q][3] = 5 * random_unit();
    }
}

static const float *run(gpu_test *t, float range, int32_t max_cells, tyn_extent *size)
{
    struct medium_block medium = {
        .extent = {extent[0], extent[1], extent[2]}, .size = {NX, NY, NZ}, .sigma_s = {2, 4, 9}};
    tyn_upsample_params params;
    tyn_pass_defaults(&tyn_pass_upsample, &params);
    params.cells = max_cells;
    params.range = range;
    memcpy(params.extent, extent, sizeof extent);
    memcpy(params.size, medium.size, sizeof params.size);
    tyn_ref refs[UPSAMPLE_NUM_PORTS] = {0};
    tyn_graph_begin(t->graph);
    refs[PORT(MEDIUM)] = gpu_buffer(t, "medium", &medium, sizeof medium);
    refs[PORT(DENSITY)] =
        gpu_image(t, "density", TYN_IMAGE_3D, (tyn_extent){NX, NY, NZ}, 1, density);
    refs[PORT(MERGED)] =
        gpu_image(t, "merged", TYN_IMAGE_3D, (tyn_extent){MX, MY, MZ}, 4, merged[0]);
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

static double light_at(const double p[3], double range, int c)
{
    const int n[3] = {MX, MY, MZ};
    double at[3], sum = 0, weights = 0, here = density_at(p) * (2 + 4 + 9) / 3;
    for (int a = 0; a < 3; a++) {
        at[a] = p[a] / 0.1 - 0.5;
    }
    for (int corner = 0; corner < 8; corner++) {
        double weight = 1;
        int index[3];
        for (int a = 0; a < 3; a++) {
            int base = (int)floor(at[a]), up = corner >> a & 1;
            weight *= up ? at[a] - base : 1 - (at[a] - base);
            index[a] = clamped(base + up, n[a]);
        }
        const float *cell = merged[(index[2] * MY + index[1]) * MX + index[0]];
        if (range > 0) {
            double d = fabs(here - cell[3]) / (here + cell[3]) / range;
            weight *= exp(-0.5 * d * d) + 1e-4;
        }
        sum += weight * cell[c];
        weights += weight;
    }
    return sum / weights;
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
                double expected = light_at(p, range, c);
                worst = maximum(worst, fabs(found[4 * q + (uint32_t)c] - expected) / expected);
            }
        }
        print_message("range %.2f: largest relative difference %.1e\n", range, worst);
        // The guide is filtered by the texture unit, and its errors grow with 1 / range^2.
        assert_true(range > 0 ? within(worst, 9e-3, NULL, "range %g", range) : worst < 1e-5);
    }
}

// Whatever the guide, a constant stays that constant.
static void keeps_a_constant(void **state)
{
    make_inputs();
    for (int q = 0; q < MERGED; q++) {
        merged[q][0] = merged[q][1] = merged[q][2] = 2.5f;
    }
    tyn_extent size;
    const float *found = run(*state, 0.05f, 16, &size);
    assert_int_equal(size.x, 18);
    for (uint32_t q = 0; q < size.x * size.y * size.z; q++) {
        for (uint32_t c = 0; c < 3; c++) {
            assert_near(found[4 * q + c], 2.5, 1e-5);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(equals_twin),
                                       cmocka_unit_test(keeps_a_constant)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
