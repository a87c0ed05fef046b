// lattice_cells.c -- coefficients averaged over cells, against means of voxels and closed forms.
#include "bound.h"
#include "gpu_test.h"
#include "passes/lattice_cells/lattice_cells.h"
#include "shaders/common/scene_args.h"
#include "voxels.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FINE = 16, CELLS = 4 };

typedef struct setup {
    struct medium_block medium;
    tyn_lattice_cells_params params;
    tyn_extent size;
    const float *density, *sigma_a, *g, *emission; // density alone, or four coefficients
} setup;

static setup start(float x, float y, float z, int32_t cells)
{
    setup s = {.params = {.shape = {.cells = cells, .channels = 3, .tint = {1, 1, 1}}}};
    const float extent[3] = {x, y, z};
    memcpy(s.medium.extent, extent, sizeof extent);
    memcpy(s.params.shape.extent, extent, sizeof extent);
    s.medium.max_density = 1;
    return s;
}

static const float *run(gpu_test *t, setup *s)
{
    const tyn_pass_desc *pass = &tyn_pass_lattice_cells;
    const bool whole = s->sigma_a == NULL;
    const uint32_t size[3] = {s->size.x, s->size.y, s->size.z};
    s->params.mode = s->medium.mode = whole ? TYN_MEDIUM_DENSITY : TYN_MEDIUM_COEFFICIENTS;
    for (int a = 0; a < 3; a++) {
        s->medium.size[a] = size[a];
        s->medium.voxel[a] = s->medium.extent[a] / (float)size[a];
    }
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    *gpu_port(pass, refs, "medium") = gpu_buffer(t, "medium", &s->medium, sizeof s->medium);
    *gpu_port(pass, refs, "density") =
        gpu_image(t, "density", TYN_IMAGE_3D, s->size, whole ? 1 : 4, s->density);
    if (!whole) {
        *gpu_port(pass, refs, "sigma_a") =
            gpu_image(t, "sigma_a", TYN_IMAGE_3D, s->size, 4, s->sigma_a);
        *gpu_port(pass, refs, "g") = gpu_image(t, "g", TYN_IMAGE_3D, s->size, 4, s->g);
        *gpu_port(pass, refs, "emission") =
            gpu_image(t, "emission", TYN_IMAGE_3D, s->size, 4, s->emission);
    }
    assert_int_equal(tyn_graph_add(t->graph, pass, &s->params, refs), TYN_OK);
    tyn_graph_output(t->graph, "cells", *gpu_port(pass, refs, "cells"), true);
    gpu_run(t);
    return gpu_map(t, "cells");
}

static void expect_within(double found, double right, double tolerance)
{
    if (!(fabs(found - right) <= tolerance)) {
        fail_msg("%g, not %g: more than %g off", found, right, tolerance);
    }
}

static void expect(double found, double right)
{
    expect_within(found, right, 1e-5 * fabs(right) + 1e-7);
}

// Delta scaling of a medium: sigma_s', g'. What is narrower than 0.995 is scattered as little out of it.
static void scale(double sigma_s, double g, double *scaled, double *cosine)
{
    sigma_s *= fmin(1, (1 - g) / 0.005);
    g = fmin(g, 0.995);
    *scaled = g > 0 ? (1 - g * g) * sigma_s : sigma_s;
    *cosine = g > 0 ? g / (1 + g) : g;
}

// Relative error of a mean of g' sigma_s': three quotients (of the narrowest g, of g', by sigma_s'), and roundings of voxels' means
// of 8, of sums of 8 cells, and of 8 products and differences.
static double rounding_of_cosine(const gpu_test *t)
{
    return (3 + 8 + 8 + 8) * 0.5 * (double)FLT_EPSILON + 3 * gpu_ulps(t, GPU_QUOTIENT);
}

// Densities, and coefficients that change from voxel to voxel, on cells of 4^3 of them.
static void means_of_voxels(void **state)
{
    enum { N = FINE * FINE * FINE };
    static float texels[4][N][4], density[N];
    srand(3);
    for (int i = 0; i < N; i++) {
        density[i] = (float)rand() / (float)RAND_MAX;
        for (int k = 0; k < 12; k++) {
            texels[k / 3][i][k % 3] = (float)rand() / (float)RAND_MAX;
        }
        texels[2][i][1] = 2 * texels[2][i][1] - 1;
        texels[2][i][2] = 0.999f;
    }
    for (int variant = 0; variant < 2; variant++) {
        setup s = start(2, 2, 2, CELLS);
        s.size = (tyn_extent){FINE, FINE, FINE};
        s.density = variant ? texels[0][0] : density;
        s.sigma_a = variant ? texels[1][0] : NULL;
        s.g = texels[2][0];
        s.emission = texels[3][0];
        for (int c = 0; c < 3; c++) {
            s.medium.sigma_s[c] = 2 + (float)c;
            s.medium.sigma_a[c] = 0.5f * (float)c;
            s.medium.phase[c].g = 0.8f * (float)(c - 1);
            s.medium.emission[c] = 3 - (float)c;
        }
        const float *found = run(*state, &s);
        // Each of a cell's 8 places is off by a quotient's ulps of FINE texels along three axes, and texels differ by up to 1.
        const double place = sqrt(3.0 / 8) * FINE * gpu_ulps(*state, GPU_QUOTIENT);
        for (int i = 0; i < CELLS * CELLS * CELLS * 3; i++) {
            const int n = i % (CELLS * CELLS * CELLS), c = i / (CELLS * CELLS * CELLS);
            double sum[4] = {0}; // sigma_s', sigma_a, g' sigma_s', emission
            double size =
                0; // of the terms of g' sigma_s', which have both signs and 1 - f of narrow lobes in them
            for (int k = 0; k < 8; k++) {
                const int at[3] = {2 * (n % CELLS) + k % 2, 2 * (n / CELLS % CELLS) + k / 2 % 2,
                                   2 * (n / CELLS / CELLS) + k / 4};
                double v[4], scaled, cosine;
                for (int q = 0; q < 4; q++) {
                    const float g[3] = {s.medium.phase[0].g, s.medium.phase[1].g,
                                        s.medium.phase[2].g};
                    const float *constant[] = {s.medium.sigma_s, s.medium.sigma_a, g,
                                               s.medium.emission};
                    v[q] = variant  ? voxels_mean(texels[q][0], FINE, 4, c, at)
                           : q == 2 ? (double)constant[q][c]
                                    : (double)constant[q][c] * voxels_mean(density, FINE, 1, 0, at);
                }
                scale(v[0], v[2], &scaled, &cosine);
                sum[0] += scaled / 8;
                sum[1] += v[1] / 8;
                sum[2] += scaled * cosine / 8;
                size += v[0] * fmin(1, (1 - v[2]) / 0.005) * fabs(cosine) / 8;
                sum[3] += v[3] / 8;
            }
            expect((double)found[4 * i], sum[0]);
            expect((double)found[4 * i + 1], sum[1]);
            expect_within((double)found[4 * i + 2] * sum[0], sum[2],
                          rounding_of_cosine(*state) * size + place);
            expect((double)found[4 * i + 3], sum[3]);
        }
    }
}

// One channel is the coefficients' first, and emission along the tint. Sides that are no whole number of cells: what
// the cells have of the medium in all is the same.
static void one_channel_in_a_flat_box(void **state)
{
    static const float one = 1;
    setup s = start(2, 1.25f, 0.25f, 8);
    s.size = (tyn_extent){1, 1, 1};
    s.density = &one;
    s.params.shape.channels = 1;
    const float tint[3] = {0.5f, 1, 0.25f};
    memcpy(s.params.shape.tint, tint, sizeof tint);
    for (int c = 0; c < 3; c++) {
        s.medium.sigma_s[c] = 3;
        s.medium.sigma_a[c] = 1;
        s.medium.phase[c].g = 0.5f;
        s.medium.emission[c] = 4 * tint[c];
    }
    const float *found = run(*state, &s);
    const tyn_extent dims = tyn_lattice_dims(s.params.shape.extent, 8);
    assert_true(dims.x == 8 && dims.y == 5 && dims.z == 1);
    for (uint32_t i = 0; i < dims.x * dims.y * dims.z; i++) {
        expect((double)found[4 * i], 0.75 * 3);
        expect((double)found[4 * i + 1], 1);
        expect((double)found[4 * i + 2], 1. / 3);
        expect((double)found[4 * i + 3], 4);
    }
    // A quarter of the outermost cells along y lies beyond the box.
    s = start(2, 1.25f + 0.125f, 0.25f, 8);
    s.size = (tyn_extent){1, 1, 1};
    s.density = &one;
    s.medium.sigma_a[0] = s.medium.sigma_a[1] = s.medium.sigma_a[2] = 1;
    found = run(*state, &s);
    double sum = 0;
    for (uint32_t i = 0; i < 8 * 6 * 1; i++) {
        sum += 0.25 * 0.25 * 0.25 * (double)found[4 * i + 1];
    }
    print_message("of a volume of %.4f m^3 the cells have %.4f\n", 2 * 1.375 * 0.25, sum);
    assert_within(fabs(sum / (2 * 1.375 * 0.25) - 1), 0.1, NULL);
}

// What is thicker than 4096 a cell is that thick, and no less bright.
static void dense(void **state)
{
    static const float one = 1;
    setup s = start(1, 1, 1, 2);
    s.size = (tyn_extent){1, 1, 1};
    s.density = &one;
    for (int c = 0; c < 3; c++) {
        s.medium.sigma_s[c] = 3e6f;
        s.medium.sigma_a[c] = 1e6f;
        s.medium.emission[c] = 8e6f;
    }
    const float *found = run(*state, &s);
    expect((double)found[0], 0.75 * 4096 / 0.5);
    expect((double)found[1], 0.25 * 4096 / 0.5);
    expect((double)found[3], 2 * 4096 / 0.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(means_of_voxels),
        cmocka_unit_test(one_channel_in_a_flat_box),
        cmocka_unit_test(dense),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
