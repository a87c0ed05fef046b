// beam.c -- optical depths along suns against line integrals in double precision.
#include "bound.h"
#include "gpu_test.h"
#include "passes/beam/beam.h"
#include "medium_grid.h"
#include "numbers.h"
#include "point_pass.h"
#include "beam_eval.comp.h"
#include "random_unit.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static medium_grid grid_make(const float extent[3], const uint32_t size[3], uint32_t mode)
{
    medium_grid m = medium_grid_make(extent, size, mode);
    for (int i = 0; i < 3 && mode == TYN_MEDIUM_DENSITY; i++) {
        m.block.sigma_s[i] = 1 + (float)i;
        m.block.sigma_a[i] = 0.5f;
        m.block.phase[i].g = (float[]){0.5f, -0.5f, 0.999f}[i];
    }
    return m;
}

// ---- the pass at points ---------------------------------------------------------------------------

typedef struct point {
    float p[3];
    uint32_t sun;
} point;
typedef struct depth {
    float s[3], a[3], p[3];
} depth;

static bool broken(const medium_grid *m)
{
    const size_t channels = m->block.mode == TYN_MEDIUM_DENSITY ? 1 : 4;
    const size_t count = channels * m->block.size[0] * m->block.size[1] * m->block.size[2];
    bool all = true;
    for (int k = 0; k < (channels == 1 ? 1 : 3); k++) {
        for (size_t i = 0; i < count; i++) {
            all = all && isfinite(m->texels[k][i]);
        }
    }
    return !all;
}

// Values of the medium that are not finite have to be counted, and no others.
static const depth *evaluate(gpu_test *t, const medium_grid *m, const struct light_block *suns,
                             uint32_t num_suns, int32_t cells, const point *points, uint32_t count)
{
    static point_pass pass;
    static const point_input inputs[] = {
        {"medium", TYN_BUFFER, TYN_USE_UNIFORM},   {"beams", TYN_BUFFER, TYN_USE_STORAGE_READ},
        {"column", TYN_IMAGE_3D, TYN_USE_SAMPLED}, {"tau_a", TYN_IMAGE_3D, TYN_USE_SAMPLED},
        {"tau_p", TYN_IMAGE_3D, TYN_USE_SAMPLED},
    };
    point_pass_init(&pass, beam_eval_spirv, sizeof beam_eval_spirv, inputs, 5);
    bool density = m->block.mode == TYN_MEDIUM_DENSITY;
    tyn_extent extent = {m->block.size[0], m->block.size[1], m->block.size[2]};
    int channels = density ? 1 : 4;

    tyn_graph_begin(t->graph);
    tyn_ref beam[BEAM_NUM_PORTS] = {{0}}, refs[7] = {{0}};
    beam[BEAM_PORT_MEDIUM] = gpu_buffer(t, "medium", &m->block, sizeof m->block);
    if (density) {
        beam[BEAM_PORT_DENSITY] =
            gpu_image(t, "density", TYN_IMAGE_3D, extent, channels, m->texels[0]);
    } else {
        beam[BEAM_PORT_DENSITY] =
            gpu_image(t, "sigma_s", TYN_IMAGE_3D, extent, channels, m->texels[0]);
        beam[BEAM_PORT_SIGMA_A] =
            gpu_image(t, "sigma_a", TYN_IMAGE_3D, extent, channels, m->texels[1]);
        beam[BEAM_PORT_G] = gpu_image(t, "g", TYN_IMAGE_3D, extent, channels, m->texels[2]);
    }
    tyn_beam_params params;
    tyn_pass_defaults(&tyn_pass_beam, &params);
    params.cells = cells;
    tyn_beam_plan(&params, &m->block, suns, num_suns);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_beam, &params, beam), TYN_OK);

    refs[0] = beam[BEAM_PORT_MEDIUM];
    for (int i = 0; i < 4; i++) {
        refs[1 + i] = beam[BEAM_PORT_BEAMS + i];
    }
    refs[5] = gpu_buffer(t, "points", points, count * sizeof *points);
    point_pass_params eval = {count, sizeof(depth), m->block.mode, pass.results};
    assert_int_equal(tyn_graph_add(t->graph, &pass.desc, &eval, refs), TYN_OK);
    tyn_graph_output(t->graph, "results", refs[6], true);
    tyn_graph_output(t->graph, "counters", beam[BEAM_PORT_COUNTERS], true);
    gpu_run(t);
    assert_true((gpu_non_finite(t) > 0) == broken(m));
    return gpu_map(t, "results");
}

static struct light_block sun(double x, double y, double z)
{
    double n = sqrt(x * x + y * y + z * z);
    return (struct light_block){.color = {1, 1, 1},
                                .direction = {(float)(x / n), (float)(y / n), (float)(z / n)}};
}

enum { COUNT = 3000 };
static point points[COUNT];

static void random_points(const medium_grid *m, uint32_t num_suns, uint32_t *seed)
{
    for (uint32_t n = 0; n < COUNT; n++) {
        points[n].sun = n % num_suns;
        for (int i = 0; i < 3; i++) {
            double u = random_unit(seed);
            // A third on faces and edges of the box.
            u = n % 3 == 0 ? (u < 0.2 ? 0 : u > 0.8 ? 1 : u) : u;
            points[n].p[i] = (float)u * m->block.extent[i];
        }
    }
}

typedef struct errors {
    double largest, mean; // |tau - reference| / the largest reference
    double relative; // largest |tau - reference| / reference where the reference is over 1e-3 of it
    double most;     // the largest reference
} errors;

static errors compare(const medium_grid *m, const struct light_block *suns, const depth *got,
                      const char *name)
{
    errors e = {0};
    static double want[COUNT];
    double most = 0;
    for (int n = 0; n < COUNT; n++) {
        double p[3], d[3];
        for (int i = 0; i < 3; i++) {
            p[i] = points[n].p[i];
            d[i] = suns[points[n].sun].direction[i];
        }
        want[n] = medium_grid_column(m, 0, 0, p, d, 16);
        most = maximum(most, want[n]);
    }
    for (int n = 0; n < COUNT; n++) {
        double error = fabs(got[n].s[0] - want[n]);
        assert_true(error == error);
        e.largest = maximum(e.largest, error / most);
        e.mean += error / most / COUNT;
        if (want[n] > 1e-3 * most) {
            e.relative = maximum(e.relative, error / want[n]);
        }
    }
    printf("%-28s largest %.2e, mean %.2e of the largest depth; relative %.2e\n", name, e.largest,
           e.mean, e.relative);
    e.most = most;
    return e;
}

static const struct light_block *oblique_suns(void)
{
    static struct light_block suns[4];
    suns[0] = sun(0.5, 0.3, 0.81);
    suns[1] = sun(-0.7, -1, 0.2);
    suns[2] = sun(1, -1, -1);
    suns[3] = sun(1, 1e-4, 0);
    return suns;
}

// ---- tests ----------------------------------------------------------------------------------------

// What texture units may change of depths in a constant grid: each of `reads` is off by so much of the depth between two slices, which
// are as many as voxels along the axis most along the light.
static double filtered(const gpu_test *t, const medium_grid *m, const struct light_block *suns,
                       int num_suns, int reads)
{
    double most = 0;
    for (int n = 0; n < num_suns; n++) {
        int axis = 0;
        for (int a = 1; a < 3; a++) {
            axis = fabsf(suns[n].direction[a]) > fabsf(suns[n].direction[axis]) ? a : axis;
        }
        const double slice = (double)m->block.extent[axis] / m->block.size[axis];
        most = maximum(most, slice / fabs((double)suns[n].direction[axis]));
    }
    return reads * gpu_filter_shift(t) * most;
}

// A homogeneous box, also as a constant grid: the length in the box, exactly, however the light falls.
static void homogeneous(void **state)
{
    gpu_test *t = *state;
    static const uint32_t sizes[][3] = {{1, 1, 1}, {16, 12, 20}};
    static const float extents[][3] = {{1, 1, 1}, {2, 0.5f, 30}};
    const struct light_block axes[4] = {sun(0, 0, 1), sun(0, -1, 0), sun(1, 0, 0), sun(-1, 0, 0)};
    uint32_t seed = 1;
    for (int k = 0; k < 4; k++) {
        medium_grid m = grid_make(extents[k / 2], sizes[k % 2], TYN_MEDIUM_DENSITY);
        for (uint32_t i = 0; i < m.block.size[0] * m.block.size[1] * m.block.size[2]; i++) {
            m.texels[0][i] = 1;
        }
        random_points(&m, 4, &seed);
        errors e =
            compare(&m, axes, evaluate(t, &m, axes, 4, 160, points, COUNT), "homogeneous, axes");
        // Without a grid to the last digit. A constant grid is summed in single precision, 20 terms at most. Rays that enter
        // through another face than the first slice take the depth at their entry off.
        assert_true(k % 2 ? e.largest < 5e-6 + filtered(t, &m, axes, 4, 1) / e.most
                          : e.relative < 1e-6);
        e = compare(&m, oblique_suns(), evaluate(t, &m, oblique_suns(), 4, 160, points, COUNT),
                    "homogeneous, oblique");
        assert_true(e.largest <
                    1e-5 + (k % 2 ? filtered(t, &m, oblique_suns(), 4, 2) / e.most : 0));
        assert_true(k % 2 || within(e.relative, 1e-3, BOUND_FILTER, "homogeneous, oblique"));
        medium_grid_free(&m);
    }
}

static medium_grid blob(uint32_t n, double tilt)
{
    medium_grid m =
        grid_make((float[3]){1, 1.5f, 1}, (uint32_t[3]){n, n * 3 / 2, n}, TYN_MEDIUM_DENSITY);
    float *texel = m.texels[0];
    for (uint32_t z = 0; z < m.block.size[2]; z++) {
        for (uint32_t y = 0; y < m.block.size[1]; y++) {
            for (uint32_t x = 0; x < m.block.size[0]; x++) {
                double a = (x + 0.5) / n - 0.45, b = (y + 0.5) / n - 0.8, c = (z + 0.5) / n - 0.5;
                *texel++ = (float)(exp(-(a * a + b * b + c * c) / 0.05) + tilt * (a + 0.45) + tilt);
            }
        }
    }
    return m;
}

static void smooth(void **state)
{
    gpu_test *t = *state;
    const struct light_block axes[3] = {sun(0, 0, 1), sun(0, -1, 0), sun(-1, 0, 0)};
    uint32_t seed = 5;
    medium_grid m = blob(32, 0);
    random_points(&m, 3, &seed);
    assert_true(
        compare(&m, axes, evaluate(t, &m, axes, 3, 160, points, COUNT), "blob, axes").largest <
        2e-3);
    random_points(&m, 4, &seed);
    const struct light_block *suns = oblique_suns();
    assert_true(
        compare(&m, suns, evaluate(t, &m, suns, 4, 160, points, COUNT), "blob, oblique").largest <
        6e-3);
    compare(&m, suns, evaluate(t, &m, suns, 4, 20, points, COUNT), "blob, oblique, 20 cells");
    medium_grid_free(&m);
    m = blob(32, 1); // dense up to the faces
    assert_true(
        compare(&m, suns, evaluate(t, &m, suns, 4, 160, points, COUNT), "dense box, oblique")
            .largest < 2e-3);
    medium_grid_free(&m);
}

// Voxels of 0 and 1 at random: the roughest grid there is.
static void rough(void **state)
{
    gpu_test *t = *state;
    uint32_t seed = 9;
    medium_grid m = grid_make((float[3]){1, 1, 1}, (uint32_t[3]){24, 24, 24}, TYN_MEDIUM_DENSITY);
    for (int i = 0; i < 24 * 24 * 24; i++) {
        m.texels[0][i] = random_unit(&seed) < 0.5 ? 0 : 1;
    }
    random_points(&m, 4, &seed);
    const struct light_block axes[4] = {sun(0, 0, 1), sun(0, 0, -1), sun(0, 1, 0), sun(-1, 0, 0)};
    errors e = compare(&m, axes, evaluate(t, &m, axes, 4, 160, points, COUNT), "rough, axes");
    assert_within(e.mean, 2e-3, NULL);
    assert_within(e.largest, 2e-2, NULL);
    e = compare(&m, oblique_suns(), evaluate(t, &m, oblique_suns(), 4, 160, points, COUNT),
                "rough, oblique");
    assert_within(e.mean, 6e-3, NULL);
    assert_within(e.largest, 6e-2, NULL);
    medium_grid_free(&m);
}

// A slab without sides, and an alley that is periodic along one axis.
static void periodic(void **state)
{
    gpu_test *t = *state;
    uint32_t seed = 11;
    for (int k = 0; k < 2; k++) {
        medium_grid m =
            grid_make((float[3]){1, 0.5f, 2}, (uint32_t[3]){24, 16, 20}, TYN_MEDIUM_DENSITY);
        m.block.repeat[0] = 1;
        m.block.repeat[2] = k == 0;
        for (uint32_t z = 0; z < 20; z++) {
            for (uint32_t y = 0; y < 16; y++) {
                for (uint32_t x = 0; x < 24; x++) {
                    m.texels[0][(z * 16 + y) * 24 + x] =
                        (float)(1 +
                                0.8 * sin(2 * M_PI * (x + 0.5) / 24) *
                                    cos(2 * M_PI * (z + 0.5) / 20) +
                                0.2 * sin(y * 0.4));
                }
            }
        }
        const struct light_block suns[4] = {sun(0.1, -1, 0.2), sun(0.6, 1, -0.5), sun(1, -0.3, 0),
                                            sun(-3, 0.5, 1)};
        random_points(&m, 4, &seed);
        errors e = compare(&m, suns, evaluate(t, &m, suns, 4, 160, points, COUNT),
                           k ? "periodic along one axis" : "periodic slab");
        assert_within(e.largest, 4e-3, NULL);
        assert_within(e.mean, 4e-4, NULL);
        medium_grid_free(&m);
    }
}

// Depths of all three kinds from coefficient textures and from constants.
static void coefficients(void **state)
{
    gpu_test *t = *state;
    uint32_t seed = 13;
    medium_grid m =
        grid_make((float[3]){1, 1, 1}, (uint32_t[3]){20, 20, 20}, TYN_MEDIUM_COEFFICIENTS);
    static const float gs[3] = {0.6f, -0.5f, 0.999f}; // the last is replaced by 0.995
    for (uint32_t i = 0; i < 8000; i++) {
        double x = i % 20 / 20.0, z = i / 400 / 20.0;
        for (uint32_t c = 0; c < 3; c++) {
            m.texels[0][4 * i + c] = (float)(1 + c + x);
            m.texels[1][4 * i + c] = (float)(0.3 * c * z);
            m.texels[2][4 * i + c] = gs[c];
        }
    }
    const struct light_block suns[2] = {sun(0.5, 0.3, 0.81), sun(-0.2, -1, 0.4)};
    random_points(&m, 2, &seed);
    const depth *got = evaluate(t, &m, suns, 2, 160, points, COUNT);
    for (int n = 0; n < 300; n++) {
        double p[3], d[3];
        for (int i = 0; i < 3; i++) {
            p[i] = points[n].p[i];
            d[i] = suns[points[n].sun].direction[i];
        }
        for (int c = 0; c < 3; c++) {
            double g = fmin(gs[c], 0.995), f = g > 0 ? g * g : 0;
            double similar = c == 2 ? (1 - gs[2]) / (1 - 0.995) : 1;
            double s = medium_grid_column(&m, 0, c, p, d, 16) * similar;
            double a = medium_grid_column(&m, 1, c, p, d, 16);
            assert_within(fabs(got[n].s[c] - s), 3e-3 * s + 1e-3, BOUND_FILTER);
            assert_within(fabs(got[n].p[c] - (1 - f) * s), 3e-3 * (1 - f) * s + 1e-3, BOUND_FILTER);
            assert_within(fabs(got[n].a[c] - a), 1e-3, BOUND_FILTER);
        }
    }
    medium_grid_free(&m);

    m = grid_make((float[3]){1, 1, 1}, (uint32_t[3]){1, 1, 1}, TYN_MEDIUM_DENSITY);
    m.texels[0][0] = 2;
    random_points(&m, 2, &seed);
    got = evaluate(t, &m, suns, 2, 160, points, COUNT);
    for (int n = 0; n < COUNT; n++) {
        double p[3], d[3];
        for (int i = 0; i < 3; i++) {
            p[i] = points[n].p[i];
            d[i] = suns[points[n].sun].direction[i];
        }
        double length = 2 * medium_grid_entry(&m, p, d);
        for (int c = 0; c < 3; c++) {
            double g = fmin(m.block.phase[c].g, 0.995), f = g > 0 ? g * g : 0;
            double s =
                length * m.block.sigma_s[c] * (c == 2 ? (1 - m.block.phase[2].g) / (1 - 0.995) : 1);
            assert_true(fabs(got[n].s[c] - s) < 1e-4 * s + 1e-6);
            assert_true(fabs(got[n].p[c] - (1 - f) * s) < 1e-4 * s + 1e-6);
            assert_true(fabs(got[n].a[c] - 0.5 * length) < 1e-5 * length + 1e-6);
        }
    }
    medium_grid_free(&m);
}

// NaN and infinity in a host's medium do not spread beyond the columns they are in, nor as such, and are counted.
static void not_finite(void **state)
{
    gpu_test *t = *state;
    static const float values[] = {NAN, INFINITY};
    for (int k = 0; k < 4; k++) {
        const uint32_t mode = k < 2 ? TYN_MEDIUM_DENSITY : TYN_MEDIUM_COEFFICIENTS;
        uint32_t seed = 17;
        medium_grid m = grid_make((float[3]){1, 1, 1}, (uint32_t[3]){8, 8, 8}, mode);
        m.texels[k / 2][100] = values[k % 2]; // density, or sigma_a
        random_points(&m, 4, &seed);
        const depth *got = evaluate(t, &m, oblique_suns(), 4, 160, points, COUNT);
        for (int n = 0; n < COUNT; n++) {
            assert_true(isfinite(got[n].s[0]) && got[n].s[0] >= 0);
            assert_true(isfinite(got[n].a[0]) && got[n].a[0] >= 0);
        }
        medium_grid_free(&m);
    }
}

static void refuses_no_sun(void **state)
{
    gpu_test *t = *state;
    tyn_beam_params params;
    tyn_pass_defaults(&tyn_pass_beam, &params);
    tyn_ref refs[BEAM_NUM_PORTS] = {{0}};
    float zero[34] = {0};
    t->quiet = true;
    tyn_graph_begin(t->graph);
    refs[BEAM_PORT_MEDIUM] = gpu_buffer(t, "medium", zero, sizeof zero);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_beam, &params, refs), TYN_ERR_PARAMS);
    t->quiet = false;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(homogeneous),    cmocka_unit_test(smooth),
        cmocka_unit_test(rough),          cmocka_unit_test(periodic),
        cmocka_unit_test(coefficients),   cmocka_unit_test(not_finite),
        cmocka_unit_test(refuses_no_sun),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
