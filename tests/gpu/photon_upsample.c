// photon_upsample.c -- the cache at finer cells, against a twin of Elek et al. 2012, Sec 4.3.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "passes/photon_upsample/photon_upsample.h"
#include "shaders/common/scene_args.h"
#include "shaders/photon/photon_args.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COARSE = 4, FINE = 8, N = COARSE * COARSE * COARSE, M = FINE * FINE * FINE };

#define SIGMA 6.0 // of a density of 1, 1/m
#define ANISOTROPY 0.85

static struct photon_light cells_light[N];
static float density[M], coarse[N][4];

static void make(bool even)
{
    srand(3);
    for (int i = 0; i < M; i++) {
        density[i] = even ? 1 : (float)rand() / (float)RAND_MAX;
    }
    for (int i = 0; i < N; i++) {
        // Delta scaled, as lattice_cells has it.
        const double mean = even ? 1 : 0.5 + 0.5 * rand() / RAND_MAX;
        coarse[i][0] = (float)(SIGMA * mean * (1 - ANISOTROPY * ANISOTROPY));
        coarse[i][2] = (float)(ANISOTROPY / (1 + ANISOTROPY));
        struct photon_light *l = &cells_light[i];
        for (int c = 0; c < 3; c++) {
            l->sun[c] = 1 + (float)rand() / (float)RAND_MAX;
            l->sky[c] = 1 + (float)rand() / (float)RAND_MAX;
            l->way[c] = (float)rand() / (float)RAND_MAX - 0.5f;
        }
        l->cosine = 0.3f * (float)rand() / (float)RAND_MAX;
        l->order = 4 * (float)rand() / (float)RAND_MAX;
    }
}

static const float (*run(gpu_test *t, const tyn_photon_upsample_params *params))[4]
{
    struct medium_block medium = {
        .extent = {1, 1, 1}, .size = {FINE, FINE, FINE}, .max_density = 1};
    for (int c = 0; c < 3; c++) {
        medium.sigma_s[c] = (float)SIGMA;
        medium.phase[c].g = (float)ANISOTROPY;
    }
    const tyn_extent size = {COARSE, COARSE, COARSE}, voxels = {FINE, FINE, FINE};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    refs[PHOTON_UPSAMPLE_PORT_MEDIUM] = gpu_buffer(t, "medium", &medium, sizeof medium);
    refs[PHOTON_UPSAMPLE_PORT_DENSITY] = gpu_image(t, "density", TYN_IMAGE_3D, voxels, 1, density);
    refs[PHOTON_UPSAMPLE_PORT_CELLS] = gpu_image(t, "cells", TYN_IMAGE_3D, size, 4, coarse[0]);
    refs[PHOTON_UPSAMPLE_PORT_LIGHT] = gpu_buffer(t, "light", cells_light, sizeof cells_light);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_photon_upsample, params, refs), TYN_OK);
    tyn_graph_output(t->graph, "sun", refs[PHOTON_UPSAMPLE_PORT_SUN_LIGHT], true);
    tyn_graph_output(t->graph, "sky", refs[PHOTON_UPSAMPLE_PORT_SKY_LIGHT], true);
    tyn_graph_output(t->graph, "way", refs[PHOTON_UPSAMPLE_PORT_SKY_WAY], true);
    gpu_run(t);
    return (const float(*)[4])gpu_map(t, "sun");
}

static tyn_photon_upsample_params defaults(void)
{
    tyn_photon_upsample_params p;
    tyn_pass_defaults(&tyn_pass_photon_upsample, &p);
    p.shape =
        (tyn_lattice_shape){.extent = {1, 1, 1}, .cells = COARSE, .channels = 1, .tint = {1, 1, 1}};
    p.cells = FINE;
    p.mode = TYN_MEDIUM_DENSITY;
    p.majorant = (float)SIGMA;
    return p;
}

static double mean3(const float v[3])
{
    return ((double)v[0] + (double)v[1] + (double)v[2]) / 3;
}

// As printed.
static double f_exp_1(double d, double lambda, double r)
{
    return lambda * exp(-lambda * d) / (1 - exp(-lambda * r));
}

static double f_exp(double d, double lambda, double r)
{
    const double edge = f_exp_1(r, lambda, r);
    const double value = (f_exp_1(d, lambda, r) - edge) / (1 - r * edge);
    return value > 0 ? value : 0;
}

static double order_at(const double x[3])
{
    double sum = 0;
    for (int i = 0; i < 8; i++) {
        double w = 1;
        int q[3];
        for (int a = 0; a < 3; a++) {
            const double low = floor(x[a] - 0.5), t = x[a] - 0.5 - low;
            const int up = i >> a & 1, cell = (int)low + up;
            w *= up ? t : 1 - t;
            q[a] = cell < 0 ? 0 : cell >= COARSE ? COARSE - 1 : cell;
        }
        sum += w * (double)cells_light[(q[2] * COARSE + q[1]) * COARSE + q[0]].order;
    }
    return sum;
}

// Light of the sun and its mean cosine in a fine cell.
static void twin(const int at[3], int32_t lobe, double *light, double *cosine)
{
    double x[3];
    int middle[3];
    for (int a = 0; a < 3; a++) {
        x[a] = (at[a] + 0.5) * COARSE / FINE;
        middle[a] = (int)x[a];
    }
    const double here = SIGMA * (double)density[(at[2] * FINE + at[1]) * FINE + at[0]];
    const double order = order_at(x), r = 1.5 / COARSE;
    double total = 0, sum = 0, lobes = 0, lobe_sum = 0;
    for (int i = 0; i < 27; i++) {
        const int q[3] = {middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1};
        double d2 = 0;
        bool inside = true;
        for (int a = 0; a < 3; a++) {
            inside = inside && q[a] >= 0 && q[a] < COARSE;
            d2 += (q[a] + 0.5 - x[a]) * (q[a] + 0.5 - x[a]) / COARSE / COARSE;
        }
        if (!inside) {
            continue;
        }
        const int cell = (q[2] * COARSE + q[1]) * COARSE + q[0];
        const struct photon_light *l = &cells_light[cell];
        const double there = (double)coarse[cell][0] / (1 - ANISOTROPY * ANISOTROPY);
        const double w =
            f_exp(sqrt(d2), 0.5 * (here + there), r) * (1 - fabs(here - there) / SIGMA);
        const double moved = pow(ANISOTROPY, order - (double)l->order);
        const double mean = mean3(l->sun), weight = lobe ? w * mean * moved : w * mean;
        total += w;
        sum += w * (double)l->sun[1];
        lobes += weight;
        lobe_sum += weight * (lobe ? 1 : moved) * (double)l->cosine;
    }
    *light = sum / total;
    *cosine = lobe_sum / lobes;
}

static void as_published(void **state)
{
    for (int32_t lobe = 0; lobe < 2; lobe++) {
        tyn_photon_upsample_params p = defaults();
        p.lobe = lobe;
        make(false);
        const float(*sun)[4] = run(*state, &p);
        double worst = 0;
        for (int i = 0; i < M; i++) {
            double light, cosine;
            twin((int[]){i % FINE, i / FINE % FINE, i / FINE / FINE}, lobe, &light, &cosine);
            worst = maximum(worst, fabs((double)sun[i][1] / light - 1));
            worst = maximum(worst, fabs((double)sun[i][3] - cosine));
        }
        assert_true(worst < 5e-5);
    }
}

// What is the same everywhere stays so, by both filters.
static void even(void **state)
{
    make(true);
    for (int i = 0; i < N; i++) {
        cells_light[i] = (struct photon_light){.sun = {1, 2, 3},
                                               .cosine = 0.4f,
                                               .sky = {3, 2, 1},
                                               .order = 5,
                                               .way = {0.1f, 0.2f, -0.3f}};
    }
    for (int32_t filter = 0; filter < 2; filter++) {
        tyn_photon_upsample_params p = defaults();
        p.filter = filter;
        const float(*sun)[4] = run(*state, &p);
        const float(*sky)[4] = (const float(*)[4])gpu_map(*state, "sky"),
              (*way)[4] = (const float(*)[4])gpu_map(*state, "way");
        for (int i = 0; i < M; i++) {
            const double expected[] = {1, 2, 3, 0.4, 3, 2, 1, 5, 0.1, 0.2, -0.3};
            for (int k = 0; k < 11; k++) {
                const float v = k < 4 ? sun[i][k] : k < 8 ? sky[i][k - 4] : way[i][k - 8];
                assert_near((double)v, expected[k], 1e-5);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(as_published), cmocka_unit_test(even)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
