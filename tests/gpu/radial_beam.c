// radial_beam.c -- optical depths from local lights against line integrals in double precision, and the
// octahedral map of their directions.
#include "bound.h"
#include "gpu_test.h"
#include "passes/radial_beam/radial_beam.h"
#include "numbers.h"
#include "point_pass.h"
#include "octahedral_eval.comp.h"
#include "radial_eval.comp.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- a medium and its line integrals --------------------------------------------------------------

enum { SIZE = 32, COUNT = 2000, LIGHTS = 6 };
static float texels[SIZE * SIZE * SIZE];
static const float extent[3] = {1, 1.2f, 0.8f};

static struct medium_block medium_of(bool homogeneous)
{
    struct medium_block m = {.mode = TYN_MEDIUM_DENSITY, .max_density = 1, .sigma_t_max = 1};
    for (int i = 0; i < 3; i++) {
        m.extent[i] = extent[i];
        m.size[i] = homogeneous ? 1 : SIZE;
        m.voxel[i] = extent[i] / (float)m.size[i];
        m.bricks[i] = (m.size[i] + TYN_BRICK - 1) / TYN_BRICK;
        m.sigma_s[i] = 1;
        m.sigma_a[i] = 0.5f;
        m.phase[i].g = 0.5f;
    }
    return m;
}

static void fill(double tilt)
{
    for (int i = 0; i < SIZE * SIZE * SIZE; i++) {
        double a = (i % SIZE + 0.5) / SIZE - 0.45, b = (i / SIZE % SIZE + 0.5) / SIZE - 0.6,
               c = (i / (SIZE * SIZE) + 0.5) / SIZE - 0.5;
        texels[i] = (float)(exp(-(a * a + b * b + c * c) / 0.05) + tilt * (a + 0.45));
    }
}

static double density(const struct medium_block *m, const double p[3])
{
    int i0[3], i1[3];
    double w[3], sum = 0;
    if (m->size[0] == 1) {
        return texels[0];
    }
    for (int i = 0; i < 3; i++) {
        double x = fmin(fmax(p[i] / m->voxel[i] - 0.5, 0), SIZE - 1.0);
        i0[i] = (int)x;
        i1[i] = i0[i] + 1 < SIZE ? i0[i] + 1 : i0[i];
        w[i] = x - i0[i];
    }
    for (int c = 0; c < 8; c++) {
        int x = c & 1 ? i1[0] : i0[0], y = c & 2 ? i1[1] : i0[1], z = c & 4 ? i1[2] : i0[2];
        sum += (c & 1 ? w[0] : 1 - w[0]) * (c & 2 ? w[1] : 1 - w[1]) * (c & 4 ? w[2] : 1 - w[2]) *
               texels[(z * SIZE + y) * SIZE + x];
    }
    return sum;
}

static double column(const struct medium_block *m, const float from[3], const float to[3])
{
    enum { STEPS = 600 };
    double sum = 0, length = 0;
    for (int i = 0; i < 3; i++) {
        length += pow((double)to[i] - from[i], 2);
    }
    length = sqrt(length);
    double enter = 0; // the point is in the box
    for (int i = 0; i < 3; i++) {
        double d = (double)to[i] - from[i];
        double face = from[i] < 0 ? 0 : from[i] > m->extent[i] ? m->extent[i] : from[i];
        enter = fabs(d) > 0 ? fmax(enter, (face - from[i]) / d) : enter;
    }
    for (int k = 0; k < STEPS; k++) {
        double t = enter + (1 - enter) * (k + 0.5) / STEPS, p[3];
        for (int i = 0; i < 3; i++) {
            p[i] = from[i] + t * ((double)to[i] - from[i]);
        }
        sum += density(m, p) * length * (1 - enter) / STEPS;
    }
    return sum;
}

// ---- the pass at points ---------------------------------------------------------------------------

typedef struct point {
    float p[3];
    uint32_t light;
} point;
typedef struct depth {
    float s[3], a[3], p[3];
} depth;

// Within the box, at its middle, at a corner, outside near and far, a spot from outside.
static const struct light_block lamps[LIGHTS] = {
    {.color = {6, 1, 1}, .kind = TYN_LIGHT_KIND_POINT, .position = {0.3f, 0.9f, 0.2f}},
    {.color = {5, 1, 1}, .kind = TYN_LIGHT_KIND_POINT, .position = {0.5f, 0.6f, 0.4f}},
    {.color = {4, 1, 1}, .kind = TYN_LIGHT_KIND_POINT, .position = {0, 0, 0}},
    {.color = {3, 1, 1}, .kind = TYN_LIGHT_KIND_POINT, .position = {-0.2f, 0.5f, 0.4f}},
    {.color = {2, 1, 1}, .kind = TYN_LIGHT_KIND_POINT, .position = {5, 20, -8}},
    {.color = {1, 1, 1},
     .kind = TYN_LIGHT_KIND_SPOT,
     .position = {0.5f, 2, 0.4f},
     .direction = {0, -1, 0},
     .cos_inner = 0.9f,
     .cos_outer = 0.8f},
};
static point points[COUNT];

static const depth *evaluate(gpu_test *t, const struct medium_block *m, uint32_t fine)
{
    static point_pass pass;
    static const point_input inputs[] = {
        {"medium", TYN_BUFFER, TYN_USE_UNIFORM},   {"radials", TYN_BUFFER, TYN_USE_STORAGE_READ},
        {"column", TYN_IMAGE_3D, TYN_USE_SAMPLED}, {"tau_a", TYN_IMAGE_3D, TYN_USE_SAMPLED},
        {"tau_p", TYN_IMAGE_3D, TYN_USE_SAMPLED},
    };
    point_pass_init(&pass, radial_eval_spirv, sizeof radial_eval_spirv, inputs, 5);
    tyn_graph_begin(t->graph);
    tyn_ref beam[RADIAL_BEAM_NUM_PORTS] = {{0}}, refs[7] = {{0}};
    beam[RADIAL_BEAM_PORT_MEDIUM] = gpu_buffer(t, "medium", m, sizeof *m);
    beam[RADIAL_BEAM_PORT_DENSITY] = gpu_image(
        t, "density", TYN_IMAGE_3D, (tyn_extent){m->size[0], m->size[1], m->size[2]}, 1, texels);
    tyn_radial_beam_params params;
    tyn_pass_defaults(&tyn_pass_radial_beam, &params);
    float colors[TYN_RADIAL_LAMPS_MAX][4];
    tyn_radial_beam_plan(&params, colors, m, lamps, LIGHTS, fine, 0);
    assert_int_equal(params.num_lamps, LIGHTS);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_radial_beam, &params, beam), TYN_OK);
    refs[0] = beam[RADIAL_BEAM_PORT_MEDIUM];
    refs[1] = beam[RADIAL_BEAM_PORT_GRIDS];
    refs[2] = beam[RADIAL_BEAM_PORT_RADIAL_COLUMN];
    refs[5] = gpu_buffer(t, "points", points, sizeof points);
    point_pass_params eval = {COUNT, sizeof(depth), m->mode, pass.results};
    assert_int_equal(tyn_graph_add(t->graph, &pass.desc, &eval, refs), TYN_OK);
    tyn_graph_output(t->graph, "results", refs[6], true);
    tyn_graph_output(t->graph, "counters", beam[RADIAL_BEAM_PORT_COUNTERS], true);
    gpu_run(t);
    return gpu_map(t, "results");
}

// Largest and mean error in units of the largest depth, and of a depth itself where `relative`.
static double compare(gpu_test *t, const struct medium_block *m, uint32_t fine, const char *name,
                      double *mean)
{
    uint32_t seed = 7;
    for (int n = 0; n < COUNT; n++) {
        points[n].light = (uint32_t)n % LIGHTS;
        for (int i = 0; i < 3; i++) {
            seed = seed * 1664525u + 1013904223u;
            double u = (seed >> 8) * 0x1p-24;
            // Some on faces and edges, some close to the light.
            u = n % 5 == 0 ? (u < 0.2 ? 0 : u > 0.8 ? 1 : u) : u;
            points[n].p[i] = (float)u * extent[i];
            const float *at = lamps[points[n].light].position;
            if (n % 7 == 0 && at[i] >= 0 && points[n].light < 3) {
                points[n].p[i] = fminf(at[i] + 0.02f * points[n].p[i], extent[i]);
            }
        }
        if (points[n].light == LIGHTS - 1) { // where the spot shines
            points[n].p[0] = 0.5f + 0.5f * (points[n].p[0] - 0.5f);
            points[n].p[2] = 0.4f + 0.5f * (points[n].p[2] - 0.4f);
        }
    }
    const depth *got = evaluate(t, m, fine);
    assert_int_equal(gpu_non_finite(t), 0);
    double most = 0, worst = 0, sum = 0;
    static double want[COUNT];
    for (int n = 0; n < COUNT; n++) {
        want[n] = column(m, lamps[points[n].light].position, points[n].p);
        most = maximum(most, want[n]);
    }
    for (int n = 0; n < COUNT; n++) {
        double error = fabs(got[n].s[0] - want[n]) / most;
        assert_true(error == error);
        assert_true(fabs(got[n].a[1] - 0.5 * got[n].s[1]) <= 1e-5 * most);
        assert_true(fabs(got[n].p[2] - 0.75 * got[n].s[2]) <= 1e-5 * most);
        worst = maximum(worst, error);
        sum += error / COUNT;
    }
    print_message("%-24s largest %.2e, mean %.2e of the largest depth\n", name, worst, sum);
    *mean = sum;
    return worst;
}

static void homogeneous(void **state)
{
    double mean;
    struct medium_block m = medium_of(true);
    texels[0] = 1;
    assert_true(compare(*state, &m, LIGHTS, "homogeneous", &mean) < 1e-5);
    for (int i = 0; i < SIZE * SIZE * SIZE; i++) {
        texels[i] = 1;
    }
    m = medium_of(false);
    assert_true(compare(*state, &m, LIGHTS, "constant grid", &mean) < 1e-5);
}

static void smooth(void **state)
{
    double mean;
    struct medium_block m = medium_of(false);
    fill(0);
    assert_within(compare(*state, &m, LIGHTS, "blob", &mean), 2e-2, NULL);
    assert_true(within(mean, 1e-3, NULL, "smooth, mean"));
    assert_within(compare(*state, &m, 0, "blob, further lamps", &mean), 0.15, NULL);
    assert_true(within(mean, 6e-3, NULL, "further lamps, mean"));
    fill(1);
    assert_within(compare(*state, &m, LIGHTS, "dense at faces", &mean), 0.015, NULL);
    assert_true(within(mean, 4e-4, NULL, "dense at faces, mean"));
}

// NaN and infinity in a host's density are not passed on, and are counted.
static void not_finite(void **state)
{
    gpu_test *t = *state;
    static const float values[] = {NAN, INFINITY};
    const struct medium_block m = medium_of(false);
    for (int k = 0; k < 2; k++) {
        fill(0);
        texels[(SIZE / 2 * SIZE + SIZE / 2) * SIZE + SIZE / 2] = values[k];
        const depth *got = evaluate(t, &m, LIGHTS);
        assert_true(gpu_non_finite(t) > 0);
        for (int n = 0; n < COUNT; n++) {
            assert_true(isfinite(got[n].s[0]) && got[n].s[0] >= 0);
        }
    }
}

// ---- the map --------------------------------------------------------------------------------------

static void octahedron(void **state)
{
    enum { N = 24, SIDE = N + 2 };
    gpu_test *t = *state;
    static struct {
        int32_t x, y, n;
    } texel[SIDE * SIDE];
    typedef struct result {
        float direction[3], back[2];
    } result;
    for (int i = 0; i < SIDE * SIDE; i++) {
        texel[i].x = i % SIDE - 1;
        texel[i].y = i / SIDE - 1;
        texel[i].n = N;
    }
    static point_pass pass;
    point_pass_init(&pass, octahedral_eval_spirv, sizeof octahedral_eval_spirv, NULL, 0);
    tyn_graph_begin(t->graph);
    tyn_ref refs[2] = {gpu_buffer(t, "points", texel, sizeof texel)};
    point_pass_params eval = {SIDE * SIDE, sizeof(result), 0, pass.results};
    assert_int_equal(tyn_graph_add(t->graph, &pass.desc, &eval, refs), TYN_OK);
    tyn_graph_output(t->graph, "results", refs[1], true);
    gpu_run(t);
    const result *got = gpu_map(t, "results");
    double area = 0, widest = 0;
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            const result *r = &got[y * SIDE + x];
            const float *d = r->direction;
            double l = sqrt((double)d[0] * d[0] + (double)d[1] * d[1] + (double)d[2] * d[2]);
            assert_true(fabs(fabs(d[0]) + fabs(d[1]) + fabs(d[2]) - 1) < 1e-6);
            if (x > 0 && y > 0 && x <= N && y <= N) {
                area += 4.0 / (N * N) / (l * l * l);
                assert_true(fabs(r->back[0] - ((2 * x - 1.0) / N - 1)) < 1e-5);
                assert_true(fabs(r->back[1] - ((2 * y - 1.0) / N - 1)) < 1e-5);
            }
            // Neighbours in the map, its border among them, are neighbours on the sphere.
            for (int k = 0; k < 2; k++) {
                if (x + 1 - k >= SIDE || y + k >= SIDE) {
                    continue;
                }
                const float *q = got[(y + k) * SIDE + x + 1 - k].direction;
                double lq = sqrt((double)q[0] * q[0] + (double)q[1] * q[1] + (double)q[2] * q[2]);
                double dot = ((double)d[0] * q[0] + (double)d[1] * q[1] + (double)d[2] * q[2]);
                widest = maximum(widest, acos(minimum(dot / (l * lq), 1)));
            }
        }
    }
    print_message("octahedral map: area %.6f pi, neighbours at most %.3f apart\n", area / M_PI,
                  widest);
    assert_true(fabs(area / (4 * M_PI) - 1) < 1e-5);
    assert_true(widest < 2.5 * 2 / N);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(homogeneous), cmocka_unit_test(smooth),
                                       cmocka_unit_test(not_finite), cmocka_unit_test(octahedron)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
