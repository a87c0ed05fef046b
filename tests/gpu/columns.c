// columns.c -- optical depths along principal ordinates against line integrals in double precision.
#include "bound.h"
#include "gpu_test.h"
#include "base/half.h"
#include "medium_grid.h"
#include "passes/columns/columns.h"
#include "passes/columns_average/columns_average.h"
#include "numbers.h"
#include "random_unit.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- line integrals -------------------------------------------------------------------------------

// Integral to p, and the mean of those to the octants of the cell around it: the pass gives the former
// where neighbouring rays enter through one face, the latter across the kinks between faces.
static double column(const medium_grid *m, int texture, int channel, const double p[3],
                     const float d[3])
{
    const double way[3] = {(double)d[0], (double)d[1], (double)d[2]};
    return medium_grid_column(m, texture, channel, p, way, 4);
}

static double cell_column(const medium_grid *m, int texture, int channel, const double p[3],
                          const float d[3], double dx)
{
    double sum = 0;
    for (int k = 0; k < 8; k++) {
        double q[3];
        for (int i = 0; i < 3; i++) { // of the part of the cell that is in the box
            double from = fmax(p[i] - 0.5 * dx, 0), to = fmin(p[i] + 0.5 * dx, m->block.extent[i]);
            q[i] = from + (k >> i & 1 ? 0.75 : 0.25) * (to - from);
        }
        sum += column(m, texture, channel, q, d) / 8;
    }
    return sum;
}

// ---- the pass --------------------------------------------------------------------------------------

// Along axes, face and body diagonals, grazing, then anywhere.
static struct ordinates_block ordinates_make(uint32_t count)
{
    static const float special[][3] = {
        {1, 0, 0},  {-1, 0, 0},  {0, 1, 0},      {0, -1, 0},       {0, 0, 1},          {0, 0, -1},
        {1, 1, 0},  {-1, 0, -1}, {0, 1, -1},     {1, 1, 1},        {-1, 1, -1},        {1, -1, -1},
        {1, .5, 0}, {0, -1, .5}, {1e-4f, 0, -1}, {-.999f, 1, .1f}, {1, 1e-7f, -1e-7f},
    };
    struct ordinates_block block = {.count = count};
    uint32_t seed = 7;
    for (uint32_t n = 0; n < count; n++) {
        double d[3];
        for (int i = 0; i < 3; i++) {
            d[i] =
                n < sizeof special / sizeof special[0] ? special[n][i] : 2 * random_unit(&seed) - 1;
        }
        double norm = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int i = 0; i < 3; i++) {
            block.list[n].direction[i] = (float)(d[i] / norm);
        }
    }
    return block;
}

typedef struct result {
    const uint16_t *halves;
    uint32_t dims[3], components, non_finite;
    bool averaged;
} result;

static double result_at(const result *r, uint32_t n, uint32_t component, const uint32_t c[3])
{
    size_t row = (r->dims[0] + 1) / 2 * 2;
    size_t plane = ((size_t)n * r->components + component) * r->dims[2] + c[2];
    double root = tyn_half_to_float(r->halves[(plane * r->dims[1] + c[1]) * row + c[0]]);
    return root * root;
}

// Cells of a lattice as lattice.h plans it: cubes, what they reach beyond the box split evenly.
static void cells_of(const medium_grid *m, uint32_t cells, uint32_t dims[3], double *dx)
{
    const float *e = m->block.extent;
    *dx = fmax(e[0], fmax(e[1], e[2])) / cells;
    for (int i = 0; i < 3; i++) {
        dims[i] = (uint32_t)fmax(1, ceil(e[i] / *dx - 1e-4));
    }
}

// Puts what columns_average makes of the medium in the place of it, where that is worth while.
static bool average(gpu_test *t, const medium_grid *m, const uint32_t dims[3], tyn_ref *refs)
{
    tyn_columns_average_params params = {.mode = m->block.mode};
    if (!tyn_columns_average_size(&m->block, dims, params.size)) {
        return false;
    }
    tyn_ref in[COLUMNS_AVERAGE_NUM_PORTS] = {
        [COLUMNS_AVERAGE_PORT_DENSITY] = refs[COLUMNS_PORT_DENSITY],
        [COLUMNS_AVERAGE_PORT_SIGMA_A] = refs[COLUMNS_PORT_SIGMA_A],
        [COLUMNS_AVERAGE_PORT_G] = refs[COLUMNS_PORT_G],
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_columns_average, &params, in), TYN_OK);
    bool density = m->block.mode == TYN_MEDIUM_DENSITY;
    refs[COLUMNS_PORT_DENSITY] =
        in[density ? COLUMNS_AVERAGE_PORT_MEAN_DENSITY : COLUMNS_AVERAGE_PORT_MEAN_SIGMA_S];
    refs[COLUMNS_PORT_SIGMA_A] = in[COLUMNS_AVERAGE_PORT_MEAN_SIGMA_A];
    refs[COLUMNS_PORT_G] = in[COLUMNS_AVERAGE_PORT_MEAN_G];
    return true;
}

static result run_pass(gpu_test *t, const medium_grid *m, const struct ordinates_block *ordinates,
                       uint32_t count, uint32_t cells)
{
    double dx;
    bool density = m->block.mode == TYN_MEDIUM_DENSITY;
    result r = {.components = density ? 1 : COLUMNS_COMPONENTS};
    cells_of(m, cells, r.dims, &dx);
    tyn_columns_params params = {.mode = m->block.mode, .count = count};
    memcpy(params.extent, m->block.extent, sizeof params.extent);
    memcpy(params.dims, r.dims, sizeof params.dims);
    tyn_extent extent = {m->block.size[0], m->block.size[1], m->block.size[2]};
    int channels = density ? 1 : 4;
    tyn_graph_begin(t->graph);
    tyn_ref refs[COLUMNS_NUM_PORTS] = {
        [COLUMNS_PORT_MEDIUM] = gpu_buffer(t, "medium", &m->block, sizeof m->block),
        [COLUMNS_PORT_DENSITY] =
            gpu_image(t, "density", TYN_IMAGE_3D, extent, channels, m->texels[0]),
        [COLUMNS_PORT_ORDINATES] = gpu_buffer(t, "ordinates", ordinates, sizeof *ordinates),
    };
    if (!density) {
        refs[COLUMNS_PORT_SIGMA_A] =
            gpu_image(t, "sigma_a", TYN_IMAGE_3D, extent, channels, m->texels[1]);
        refs[COLUMNS_PORT_G] = gpu_image(t, "g", TYN_IMAGE_3D, extent, channels, m->texels[2]);
    }
    r.averaged = average(t, m, r.dims, refs);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_columns, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "columns", refs[COLUMNS_PORT_COLUMNS], true);
    tyn_graph_output(t->graph, "counters", refs[COLUMNS_PORT_COUNTERS], true);
    gpu_run(t);
    r.halves = gpu_map(t, "columns");
    r.non_finite = gpu_non_finite(t);
    return r;
}

typedef struct errors {
    double largest, mean; // |column - exact| / the largest exact one
    double relative;      // largest |column - exact| / exact
} errors;

static errors compare(const medium_grid *m, const struct ordinates_block *ordinates,
                      const result *r, uint32_t cells, const char *name)
{
    errors e = {0, 0, 0};
    uint32_t dims[3], count = 0, seed = 3;
    double dx, most = 0;
    cells_of(m, cells, dims, &dx);
    for (uint32_t n = 0; n < ordinates->count; n++) {
        for (uint32_t k = 0; k < 100; k++) {
            uint32_t c[3];
            double p[3];
            for (int i = 0; i < 3; i++) {
                c[i] = (uint32_t)(random_unit(&seed) * dims[i]);
                p[i] = (c[i] + 0.5) * dx + 0.5 * (m->block.extent[i] - dims[i] * dx);
            }
            double want = cell_column(m, 0, 0, p, ordinates->list[n].direction, dx);
            double got = result_at(r, n, 0, c), wrong = fabs(got - want);
            most = maximum(most, want);
            e.largest = maximum(e.largest, wrong);
            e.relative = want > 0 ? maximum(e.relative, wrong / want) : e.relative;
            e.mean += wrong;
            count++;
        }
    }
    e.largest /= most;
    e.mean /= most * count;
    printf("%-28s of the largest: mean %.2e, worst %.2e; worst relative %.2e\n", name, e.mean,
           e.largest, e.relative);
    return e;
}

// ---- tests ------------------------------------------------------------------------------------------

static const float cube[3] = {1, 1, 1};

static void homogeneous(void **state)
{
    static const struct {
        float extent[3];
        uint32_t size[3], cells;
    } boxes[] = {
        {{1, 1, 1}, {1, 1, 1}, 16},     {{1, 1, 1}, {9, 9, 9}, 16},
        {{3, 1, 0.7f}, {5, 4, 3}, 13},  {{1, 1, 1}, {1, 1, 1}, 1},
        {{0.1f, 4, 2}, {1, 1, 1}, 24},  {{0.03f, 2, 0.07f}, {3, 200, 7}, 32},
        {{5, 0.01f, 5}, {4, 1, 4}, 16},
    };
    struct ordinates_block ordinates = ordinates_make(64);
    for (size_t b = 0; b < sizeof boxes / sizeof boxes[0]; b++) {
        medium_grid m = medium_grid_make(boxes[b].extent, boxes[b].size, TYN_MEDIUM_DENSITY);
        for (uint32_t i = 0; i < boxes[b].size[0] * boxes[b].size[1] * boxes[b].size[2]; i++) {
            m.texels[0][i] = 3;
        }
        result r = run_pass(*state, &m, &ordinates, 64, boxes[b].cells);
        errors e = compare(&m, &ordinates, &r, boxes[b].cells, "homogeneous");
        assert_within(e.relative, 1e-3, NULL); // a half has 11 digits, its square 10
        medium_grid_free(&m);
    }
}

static void blob(void **state)
{
    static const uint32_t size[3] = {48, 48, 48};
    struct ordinates_block ordinates = ordinates_make(64);
    medium_grid m = medium_grid_make(cube, size, TYN_MEDIUM_DENSITY);
    for (uint32_t i = 0; i < 48 * 48 * 48; i++) {
        double x = (i % 48 + .5) / 48 - .5, y = (i / 48 % 48 + .5) / 48 - .5,
               z = (i / 48 / 48 + .5) / 48 - .4;
        m.texels[0][i] = (float)exp(-(x * x + y * y + z * z) / (2 * 0.15 * 0.15));
    }
    result r = run_pass(*state, &m, &ordinates, 64, 24);
    errors e = compare(&m, &ordinates, &r, 24, "gaussian, sigma 3.6 cells");
    assert_within(e.mean, 1e-3, NULL);
    assert_within(e.largest, 0.02, NULL);
    medium_grid_free(&m);
}

// On cells of two voxels, and of four, where the medium is averaged.
static void step(void **state)
{
    static const uint32_t size[3] = {64, 64, 64};
    struct ordinates_block ordinates = ordinates_make(64);
    medium_grid m = medium_grid_make(cube, size, TYN_MEDIUM_DENSITY);
    for (uint32_t i = 0; i < 64 * 64 * 64; i++) {
        uint32_t x = i % 64, y = i / 64 % 64, z = i / 64 / 64;
        m.texels[0][i] = x > 20 && x < 50 && y > 30 && z < 40 ? 1 : 0;
    }
    for (uint32_t cells = 32; cells >= 16; cells -= 16) {
        result r = run_pass(*state, &m, &ordinates, 64, cells);
        assert_int_equal(r.averaged, cells == 16);
        errors e = compare(&m, &ordinates, &r, cells, "block with sharp faces");
        assert_true(e.mean < (cells == 16 ? 0.006 : 0.002) &&
                    e.largest < (cells == 16 ? 0.25 : 0.1));
    }
    medium_grid_free(&m);
}

// Coefficients that are textures: three integrals of three channels.
static void coefficients(void **state)
{
    static const uint32_t size[3] = {20, 24, 16};
    static const float extent[3] = {1, 1.2f, 0.8f};
    struct ordinates_block ordinates = ordinates_make(20);
    medium_grid m = medium_grid_make(extent, size, TYN_MEDIUM_COEFFICIENTS);
    medium_grid scaled = medium_grid_make(extent, size, TYN_MEDIUM_COEFFICIENTS);
    for (uint32_t i = 0; i < 20 * 24 * 16; i++) {
        double x = i % 20 / 20.0, y = i / 20 % 24 / 24.0, z = i / 480 / 16.0;
        for (int c = 0; c < 3; c++) {
            float s = (float)(2 + sin(5 * x + c) * cos(4 * y)), g = 0.3f * (float)c;
            m.texels[0][4 * i + (size_t)c] = s;
            m.texels[1][4 * i + (size_t)c] = (float)(1 + 0.5 * sin(4 * z - 2 * c) * cos(3 * x));
            m.texels[2][4 * i + (size_t)c] = g;
            scaled.texels[0][4 * i + (size_t)c] = (1 - g * g) * s;
        }
    }
    for (uint32_t cells = 12; cells >= 6; cells -= 6) {
        result r = run_pass(*state, &m, &ordinates, 20, cells);
        assert_int_equal(r.averaged, cells == 6);
        double dx, worst = 0, most = 0;
        uint32_t dims[3], seed = 5;
        cells_of(&m, cells, dims, &dx);
        for (uint32_t n = 0; n < 20; n++) {
            for (uint32_t k = 0; k < 90; k++) {
                uint32_t c[3], which = k % 9;
                double p[3];
                for (int i = 0; i < 3; i++) {
                    c[i] = (uint32_t)(random_unit(&seed) * dims[i]);
                    p[i] = (c[i] + 0.5) * dx + 0.5 * (extent[i] - dims[i] * dx);
                }
                double want = cell_column(which < 6 ? &m : &scaled, which / 3 == 1 ? 1 : 0,
                                          (int)(which % 3), p, ordinates.list[n].direction, dx);
                most = maximum(most, want);
                worst = maximum(worst, fabs(result_at(&r, n, which, c) - want));
            }
        }
        printf("coefficients: worst %.2e of the largest\n", worst / most);
        assert_true(worst < (cells == 6 ? 0.06 : 0.03) * most);
    }
    medium_grid_free(&m);
    medium_grid_free(&scaled);
}

// Any medium on any lattice gives numbers, and beyond those in use no work is done.
static void extremes(void **state)
{
    static const struct {
        float extent[3];
        uint32_t size[3], cells, count;
    } boxes[] = {
        {{1, 1, 1}, {1, 1, 1}, 1, 1},
        {{1, 1, 1}, {2, 2, 2}, 8, 256},
        {{0.03f, 2, 0.07f}, {3, 200, 7}, 32, 40},
        {{10, 0.01f, 10}, {16, 2, 16}, 24, 40},
        {{1e-3f, 1e3f, 1}, {2, 50, 3}, 64, 20},
    };
    static const float values[] = {0, 1e-6f, 1, 1e8f};
    for (size_t b = 0; b < sizeof boxes / sizeof boxes[0]; b++) {
        struct ordinates_block ordinates = ordinates_make(boxes[b].count);
        ordinates.list[boxes[b].count / 2] = (struct ordinate){.direction = {0, 0, 0}};
        ordinates.list[boxes[b].count / 3] = (struct ordinate){.direction = {NAN, 0, 1}};
        for (size_t v = 0; v < sizeof values / sizeof values[0]; v++) {
            medium_grid m = medium_grid_make(boxes[b].extent, boxes[b].size, TYN_MEDIUM_DENSITY);
            uint32_t texels = boxes[b].size[0] * boxes[b].size[1] * boxes[b].size[2], seed = 11;
            for (uint32_t i = 0; i < texels; i++) {
                m.texels[0][i] = i % 3 ? (float)random_unit(&seed) * values[v] : 0;
            }
            result r = run_pass(*state, &m, &ordinates, boxes[b].count, boxes[b].cells);
            uint32_t bad = 0, c[3];
            double bound = 1.01 * values[v] * 1.8 *
                           fmax(m.block.extent[0], fmax(m.block.extent[1], m.block.extent[2]));
            for (uint32_t n = 0; n < boxes[b].count; n++) {
                for (c[2] = 0; c[2] < r.dims[2]; c[2]++) {
                    for (c[1] = 0; c[1] < r.dims[1]; c[1]++) {
                        for (c[0] = 0; c[0] < r.dims[0]; c[0]++) {
                            double x = result_at(&r, n, 0, c);
                            bad += !(x >= 0 && x <= bound);
                        }
                    }
                }
            }
            assert_int_equal(bad, 0);
            medium_grid_free(&m);
        }
    }
}

// NaN and infinity in a host's medium are not passed on, and are counted.
static void not_finite(void **state)
{
    static const float values[] = {1, NAN, INFINITY};
    for (int k = 0; k < 6; k++) {
        const uint32_t mode = k < 3 ? TYN_MEDIUM_DENSITY : TYN_MEDIUM_COEFFICIENTS;
        medium_grid m = medium_grid_make((float[]){1, 1, 1}, (uint32_t[]){8, 8, 8}, mode);
        m.texels[k / 3][4 * 36] = values[k % 3]; // density, or sigma_a
        const struct ordinates_block ordinates = ordinates_make(4);
        const result r = run_pass(*state, &m, &ordinates, 4, 8);
        assert_true((r.non_finite > 0) == (k % 3 > 0));
        for (uint32_t i = 0; i < 4 * r.components * 8 * 8 * 8; i++) {
            assert_true(isfinite(tyn_half_to_float(r.halves[i])));
        }
        medium_grid_free(&m);
    }
}

// More than fits is refused with a line that says what to do.
static void too_much(void **state)
{
    gpu_test *t = *state;
    tyn_columns_params params = {
        .extent = {1, 1, 1}, .dims = {64, 64, 64}, .mode = TYN_MEDIUM_COEFFICIENTS, .count = 64};
    float one[4] = {1, 1, 1, 1};
    struct ordinates_block ordinates = ordinates_make(1);
    tyn_graph_begin(t->graph);
    tyn_ref refs[COLUMNS_NUM_PORTS] = {
        [COLUMNS_PORT_MEDIUM] =
            gpu_buffer(t, "medium", &(struct medium_block){0}, sizeof(struct medium_block)),
        [COLUMNS_PORT_DENSITY] =
            gpu_image(t, "density", TYN_IMAGE_3D, (tyn_extent){1, 1, 1}, 4, one),
        [COLUMNS_PORT_ORDINATES] = gpu_buffer(t, "ordinates", &ordinates, sizeof ordinates),
    };
    t->quiet = true;
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_columns, &params, refs), TYN_ERR_PARAMS);
    t->quiet = false;
    assert_non_null(strstr(t->last_error, "lower ordinates.count or lattice.cells"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(homogeneous),  cmocka_unit_test(blob),     cmocka_unit_test(step),
        cmocka_unit_test(coefficients), cmocka_unit_test(extremes), cmocka_unit_test(too_much),
        cmocka_unit_test(not_finite),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
