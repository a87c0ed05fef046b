// beam.c -- optical depths along suns against line integrals in double precision.
#include "gpu_test.h"
#include "passes/beam/beam.h"
#include "point_pass.h"
#include "beam_eval.comp.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- a medium and its line integrals --------------------------------------------------------------

typedef struct grid {
    struct medium_block block;
    float *texels[3]; // density; or sigma_s, sigma_a, g as RGBA
} grid;

static grid grid_make(const float extent[3], const uint32_t size[3], uint32_t mode)
{
    grid m = {{.mode = mode, .sigma_t_max = 1, .max_density = 1}};
    for (int i = 0; i < 3; i++) {
        m.block.extent[i] = extent[i];
        m.block.size[i] = size[i];
        m.block.voxel[i] = extent[i] / (float)size[i];
        m.block.bricks[i] = (size[i] + TYN_BRICK - 1) / TYN_BRICK;
        m.block.brick_size[i] = m.block.voxel[i] * TYN_BRICK;
        m.block.sigma_s[i] = mode == TYN_MEDIUM_DENSITY ? 1 + (float)i : 0;
        m.block.sigma_a[i] = mode == TYN_MEDIUM_DENSITY ? 0.5f : 0;
        m.block.g[i] = mode == TYN_MEDIUM_DENSITY ? (float[]){0.5f, -0.5f, 0.999f}[i] : 0;
    }
    size_t count = (size_t)size[0] * size[1] * size[2];
    for (int k = 0; k < (mode == TYN_MEDIUM_DENSITY ? 1 : 3); k++) {
        m.texels[k] = calloc(count * (mode == TYN_MEDIUM_DENSITY ? 1 : 4), sizeof(float));
    }
    return m;
}

static void grid_free(grid *m)
{
    for (int k = 0; k < 3; k++) {
        free(m->texels[k]);
    }
}

// Trilinear between voxel centres, constant in the outer half voxels; periodic axes wrap as a whole.
static double grid_value(const grid *m, int texture, int channel, const double p[3])
{
    int channels = m->block.mode == TYN_MEDIUM_DENSITY ? 1 : 4, i0[3], i1[3];
    double w[3];
    for (int i = 0; i < 3; i++) {
        double q = p[i] / m->block.extent[i];
        q = m->block.repeat[i] ? q - floor(q) : q;
        double x = fmin(fmax(q * m->block.size[i] - 0.5, 0), m->block.size[i] - 1.0);
        i0[i] = (int)x;
        i1[i] = i0[i] + 1 < (int)m->block.size[i] ? i0[i] + 1 : i0[i];
        w[i] = x - i0[i];
    }
    double sum = 0;
    for (int c = 0; c < 8; c++) {
        int x = c & 1 ? i1[0] : i0[0], y = c & 2 ? i1[1] : i0[1], z = c & 4 ? i1[2] : i0[2];
        double weight =
            (c & 1 ? w[0] : 1 - w[0]) * (c & 2 ? w[1] : 1 - w[1]) * (c & 4 ? w[2] : 1 - w[2]);
        size_t texel = ((size_t)z * m->block.size[1] + (size_t)y) * m->block.size[0] + (size_t)x;
        sum += weight * m->texels[texture][texel * (size_t)channels + (size_t)channel];
    }
    return sum;
}

static double entry_distance(const grid *m, const double p[3], const double d[3])
{
    double length = 1e30;
    for (int i = 0; i < 3; i++) {
        if (!m->block.repeat[i] && fabs(d[i]) > 1e-9) {
            length = fmin(length, (d[i] > 0 ? p[i] : p[i] - m->block.extent[i]) / d[i]);
        }
    }
    return fmax(length, 0);
}

static double column(const grid *m, int texture, int channel, const double p[3], const double d[3])
{
    double length = entry_distance(m, p, d), sum = 0, finest = 1e30;
    for (int i = 0; i < 3; i++) {
        finest = fmin(finest, m->block.voxel[i]);
    }
    int n = (int)(length / finest * 16) + 16;
    for (int i = 0; i < n; i++) {
        double s = length * (i + 0.5) / n,
               q[3] = {p[0] - s * d[0], p[1] - s * d[1], p[2] - s * d[2]};
        sum += grid_value(m, texture, channel, q) * length / n;
    }
    return sum;
}

// ---- the pass at points ---------------------------------------------------------------------------

typedef struct point {
    float p[3];
    uint32_t sun;
} point;
typedef struct depth {
    float s[3], a[3], p[3];
} depth;

static const depth *evaluate(gpu_test *t, const grid *m, const struct light_block *suns,
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
    gpu_run(t);
    return gpu_map(t, "results");
}

static double random_unit(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) * 0x1p-24;
}

static struct light_block sun(double x, double y, double z)
{
    double n = sqrt(x * x + y * y + z * z);
    return (struct light_block){.color = {1, 1, 1},
                                .direction = {(float)(x / n), (float)(y / n), (float)(z / n)}};
}

enum { COUNT = 3000 };
static point points[COUNT];

static void random_points(const grid *m, uint32_t num_suns, uint32_t *seed)
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
} errors;

static errors compare(const grid *m, const struct light_block *suns, const depth *got,
                      const char *name)
{
    errors e = {0, 0, 0};
    static double want[COUNT];
    double most = 0;
    for (int n = 0; n < COUNT; n++) {
        double p[3], d[3];
        for (int i = 0; i < 3; i++) {
            p[i] = points[n].p[i];
            d[i] = suns[points[n].sun].direction[i];
        }
        want[n] = column(m, 0, 0, p, d);
        most = fmax(most, want[n]);
    }
    for (int n = 0; n < COUNT; n++) {
        double error = fabs(got[n].s[0] - want[n]);
        assert_true(error == error);
        e.largest = fmax(e.largest, error / most);
        e.mean += error / most / COUNT;
        if (want[n] > 1e-3 * most) {
            e.relative = fmax(e.relative, error / want[n]);
        }
    }
    printf("%-28s largest %.2e, mean %.2e of the largest depth; relative %.2e\n", name, e.largest,
           e.mean, e.relative);
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

// A homogeneous box, also as a constant grid: the length in the box, exactly, however the light falls.
static void homogeneous(void **state)
{
    gpu_test *t = *state;
    static const uint32_t sizes[][3] = {{1, 1, 1}, {16, 12, 20}};
    static const float extents[][3] = {{1, 1, 1}, {2, 0.5f, 30}};
    const struct light_block axes[4] = {sun(0, 0, 1), sun(0, -1, 0), sun(1, 0, 0), sun(-1, 0, 0)};
    uint32_t seed = 1;
    for (int k = 0; k < 4; k++) {
        grid m = grid_make(extents[k / 2], sizes[k % 2], TYN_MEDIUM_DENSITY);
        for (uint32_t i = 0; i < m.block.size[0] * m.block.size[1] * m.block.size[2]; i++) {
            m.texels[0][i] = 1;
        }
        random_points(&m, 4, &seed);
        errors e =
            compare(&m, axes, evaluate(t, &m, axes, 4, 160, points, COUNT), "homogeneous, axes");
        // Without a grid to the last digit; a constant grid is summed and interpolated in single precision.
        assert_true(k % 2 == 0 ? e.relative < 1e-6 : e.largest < 5e-6);
        e = compare(&m, oblique_suns(), evaluate(t, &m, oblique_suns(), 4, 160, points, COUNT),
                    "homogeneous, oblique");
        assert_true(e.largest < 1e-5 && (k % 2 || e.relative < 1e-3));
        grid_free(&m);
    }
}

static grid blob(uint32_t n, double tilt)
{
    grid m = grid_make((float[3]){1, 1.5f, 1}, (uint32_t[3]){n, n * 3 / 2, n}, TYN_MEDIUM_DENSITY);
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
    grid m = blob(32, 0);
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
    grid_free(&m);
    m = blob(32, 1); // dense up to the faces
    assert_true(
        compare(&m, suns, evaluate(t, &m, suns, 4, 160, points, COUNT), "dense box, oblique")
            .largest < 2e-3);
    grid_free(&m);
}

// Voxels of 0 and 1 at random: the roughest grid there is.
static void rough(void **state)
{
    gpu_test *t = *state;
    uint32_t seed = 9;
    grid m = grid_make((float[3]){1, 1, 1}, (uint32_t[3]){24, 24, 24}, TYN_MEDIUM_DENSITY);
    for (int i = 0; i < 24 * 24 * 24; i++) {
        m.texels[0][i] = random_unit(&seed) < 0.5 ? 0 : 1;
    }
    random_points(&m, 4, &seed);
    const struct light_block axes[4] = {sun(0, 0, 1), sun(0, 0, -1), sun(0, 1, 0), sun(-1, 0, 0)};
    errors e = compare(&m, axes, evaluate(t, &m, axes, 4, 160, points, COUNT), "rough, axes");
    assert_true(e.mean < 2e-3 && e.largest < 2e-2);
    e = compare(&m, oblique_suns(), evaluate(t, &m, oblique_suns(), 4, 160, points, COUNT),
                "rough, oblique");
    assert_true(e.mean < 6e-3 && e.largest < 6e-2);
    grid_free(&m);
}

// A slab without sides, and an alley that is periodic along one axis.
static void periodic(void **state)
{
    gpu_test *t = *state;
    uint32_t seed = 11;
    for (int k = 0; k < 2; k++) {
        grid m = grid_make((float[3]){1, 0.5f, 2}, (uint32_t[3]){24, 16, 20}, TYN_MEDIUM_DENSITY);
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
        assert_true(e.largest < 4e-3 && e.mean < 4e-4);
        grid_free(&m);
    }
}

// Depths of all three kinds from coefficient textures and from constants.
static void coefficients(void **state)
{
    gpu_test *t = *state;
    uint32_t seed = 13;
    grid m = grid_make((float[3]){1, 1, 1}, (uint32_t[3]){20, 20, 20}, TYN_MEDIUM_COEFFICIENTS);
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
            double s = column(&m, 0, c, p, d) * similar, a = column(&m, 1, c, p, d);
            assert_true(fabs(got[n].s[c] - s) < 3e-3 * s + 1e-3);
            assert_true(fabs(got[n].p[c] - (1 - f) * s) < 3e-3 * (1 - f) * s + 1e-3);
            assert_true(fabs(got[n].a[c] - a) < 1e-3);
        }
    }
    grid_free(&m);

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
        double length = 2 * entry_distance(&m, p, d);
        for (int c = 0; c < 3; c++) {
            double g = fmin(m.block.g[c], 0.995), f = g > 0 ? g * g : 0;
            double s =
                length * m.block.sigma_s[c] * (c == 2 ? (1 - m.block.g[2]) / (1 - 0.995) : 1);
            assert_true(fabs(got[n].s[c] - s) < 1e-4 * s + 1e-6);
            assert_true(fabs(got[n].p[c] - (1 - f) * s) < 1e-4 * s + 1e-6);
            assert_true(fabs(got[n].a[c] - 0.5 * length) < 1e-5 * length + 1e-6);
        }
    }
    grid_free(&m);
}

// NaN and infinity in a host's density do not spread beyond the columns they are in, nor as such.
static void not_finite(void **state)
{
    gpu_test *t = *state;
    uint32_t seed = 17;
    grid m = grid_make((float[3]){1, 1, 1}, (uint32_t[3]){8, 8, 8}, TYN_MEDIUM_DENSITY);
    m.texels[0][100] = NAN;
    m.texels[0][300] = INFINITY;
    random_points(&m, 4, &seed);
    const depth *got = evaluate(t, &m, oblique_suns(), 4, 160, points, COUNT);
    for (int n = 0; n < COUNT; n++) {
        assert_true(isfinite(got[n].s[0]) && got[n].s[0] >= 0);
    }
    grid_free(&m);
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
