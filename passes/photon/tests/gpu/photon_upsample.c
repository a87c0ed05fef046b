// photon_upsample.c -- the cache at finer cells, against a twin of Elek et al. 2012, Sec 4.3.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "passes/photon/photon_upsample/photon_upsample.h"
#include "shaders/common/scene_args.h"
#include "passes/photon/common/photon_args.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COARSE = 4, FINE = 8, N = COARSE * COARSE * COARSE, M = FINE * FINE * FINE };
enum { LOBES = 2 };

#define SIGMA 6.0 // of a density of 1, 1/m
#define ANISOTROPY 0.85

static struct photon_light cells_light[LOBES][N];
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
        for (int lobe = 0; lobe < LOBES; lobe++) {
            struct photon_light *l = &cells_light[lobe][i];
            for (int c = 0; c < 3; c++) {
                l->fluence[c] = 1 + (float)rand() / (float)RAND_MAX;
                l->way[c] = 0.3f * ((float)rand() / (float)RAND_MAX - 0.5f);
            }
            l->order = 4 * (float)rand() / (float)RAND_MAX;
        }
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
    tyn_graph_output(t->graph, "fluence", refs[PHOTON_UPSAMPLE_PORT_FLUENCE], true);
    tyn_graph_output(t->graph, "way", refs[PHOTON_UPSAMPLE_PORT_WAY], true);
    gpu_run(t);
    return (const float(*)[4])gpu_map(t, "fluence");
}

static tyn_photon_upsample_params defaults(void)
{
    tyn_photon_upsample_params p;
    tyn_pass_defaults(&tyn_pass_photon_upsample, &p);
    p.shape =
        (tyn_lattice_shape){.extent = {1, 1, 1}, .cells = COARSE, .channels = 1, .tint = {1, 1, 1}};
    p.cells = FINE;
    p.lobes = LOBES;
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

// Cells in which there is nothing of the medium have no light of their own.
static double has_medium(const tyn_photon_upsample_params *p, int cell)
{
    return p->weighted && !(coarse[cell][0] > 0) ? 1e-6 : 1;
}

static double order_at(const tyn_photon_upsample_params *p, int lobe, const double x[3])
{
    double sum = 0, total = 0;
    for (int i = 0; i < 8; i++) {
        double w = 1;
        int q[3];
        for (int a = 0; a < 3; a++) {
            const double low = floor(x[a] - 0.5), t = x[a] - 0.5 - low;
            const int up = i >> a & 1, cell = (int)low + up;
            w *= up ? t : 1 - t;
            q[a] = cell < 0 ? 0 : cell >= COARSE ? COARSE - 1 : cell;
        }
        const int cell = (q[2] * COARSE + q[1]) * COARSE + q[0];
        w *= has_medium(p, cell);
        sum += w * (double)cells_light[lobe][cell].order;
        total += w;
    }
    return sum / total;
}

// Light of a lobe and its direction in a fine cell.
static void twin(const tyn_photon_upsample_params *p, int from, const int at[3], double *light,
                 double way[3])
{
    double x[3];
    int middle[3];
    for (int a = 0; a < 3; a++) {
        x[a] = (at[a] + 0.5) * COARSE / FINE;
        middle[a] = (int)x[a];
    }
    const double g = p->scaled ? ANISOTROPY / (1 + ANISOTROPY) : ANISOTROPY;
    const double left = 1 - ANISOTROPY * ANISOTROPY, sigma = SIGMA * (p->scaled ? left : 1);
    const double here = sigma * (double)density[(at[2] * FINE + at[1]) * FINE + at[0]];
    const double order = order_at(p, from, x), r = 1.5 / COARSE;
    double total = 0, sum = 0, lobes = 0, lobe_sum[3] = {0, 0, 0};
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
        const struct photon_light *l = &cells_light[from][cell];
        const double there = (double)coarse[cell][0] / (p->scaled ? 1 : left);
        const double w = f_exp(sqrt(d2), 0.5 * (here + there), r) *
                         (1 - fabs(here - there) / sigma) * has_medium(p, cell);
        const double moved = fmin(fmax(pow(g, order - (double)l->order), 0.25), 4);
        const double mean = mean3(l->fluence), weight = p->lobe ? w * mean * moved : w * mean;
        total += w;
        sum += w * (double)l->fluence[1];
        lobes += weight;
        for (int a = 0; a < 3; a++) {
            lobe_sum[a] += weight * (p->lobe ? 1 : moved) * (double)l->way[a];
        }
    }
    *light = sum / total;
    for (int a = 0; a < 3; a++) {
        way[a] = lobe_sum[a] / lobes;
    }
}

// As published, delta scaled, and where some cells are empty.
static void as_published(void **state)
{
    for (int32_t kind = 0; kind < 8; kind++) {
        tyn_photon_upsample_params p = defaults();
        p.lobe = kind & 1;
        p.scaled = kind >> 1 & 1;
        p.weighted = kind >> 2;
        p.majorant = (float)(SIGMA * (p.scaled ? 1 - ANISOTROPY * ANISOTROPY : 1));
        make(false);
        for (int i = 0; p.weighted && i < N; i += 3) {
            coarse[i][0] = 0;
        }
        const float(*found)[4] = run(*state, &p);
        const float(*ways)[4] = (const float(*)[4])gpu_map(*state, "way");
        double worst = 0;
        for (int i = 0; i < LOBES * M; i++) {
            double light, way[3];
            const int at[3] = {i % FINE, i / FINE % FINE, i / FINE / FINE % FINE};
            twin(&p, i / M, at, &light, way);
            worst = maximum(worst, fabs((double)found[i][1] / light - 1));
            for (int a = 0; a < 3; a++) {
                worst = maximum(worst, fabs((double)ways[i][a] - way[a]));
            }
        }
        assert_true(worst < 5e-5);
    }
}

// What is the same everywhere stays so, by both filters.
static void even(void **state)
{
    make(true);
    for (int i = 0; i < LOBES * N; i++) {
        cells_light[i / N][i % N] =
            (struct photon_light){.fluence = {1, 2, 3}, .order = 5, .way = {0.1f, 0.2f, -0.3f}};
    }
    for (int32_t filter = 0; filter < 2; filter++) {
        tyn_photon_upsample_params p = defaults();
        p.filter = filter;
        const float(*found)[4] = run(*state, &p);
        const float(*way)[4] = (const float(*)[4])gpu_map(*state, "way");
        for (int i = 0; i < LOBES * M; i++) {
            const double expected[] = {1, 2, 3, 5, 0.1, 0.2, -0.3};
            for (int k = 0; k < 7; k++) {
                assert_near((double)(k < 4 ? found[i][k] : way[i][k - 4]), expected[k], 1e-5);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(as_published), cmocka_unit_test(even)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
