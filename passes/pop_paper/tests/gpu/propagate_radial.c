// propagate_radial.c -- the six-neighbour propagation around local lights against a CPU twin in double
// precision, and what must hold for any light: solid angles, power, symmetry, finite numbers.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "propagate_radial_twin.h"
#include "passes/pop_paper/propagate_radial/propagate_radial.h"
#include "passes/pop_paper/propagate_radial/propagate_radial_args.h"
#include "shaders/common/scene_args.h"
#include "shaders/light/shadow_args.h"
#include "vector.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PORT(name) PROPAGATE_RADIAL_PORT_##name
#define PI 3.14159265358979323846

enum { FACE = 16 }; // texels along a side of a face of the lamp's map, and of the VPL's

typedef struct setup {
    struct medium_block medium;
    const float *density;
    struct camera_block camera;
    struct radial_vpls vpls;
    const float *atlas,
        *distances; // of a cube map of the first lamp, of the first VPL's map; or NULL
    struct shadow_light map;
    tyn_propagate_radial_params params;
} setup;

typedef struct texel {
    float c[4];
} texel;

typedef struct entry { // of the map: what starts, solid angle
    float c[2];
} entry;

typedef struct outcome {
    const entry *map;
    const texel *cells, *state;
    const float *sum, *lit;
    const struct propagate_radial_grid *grids;
    uint32_t n, layers, channels;
} outcome;

static setup setup_of(const float extent[3], const uint32_t size[3], const float *density)
{
    setup s = {.density = density};
    tyn_pass_defaults(&tyn_pass_propagate_radial, &s.params);
    for (int i = 0; i < 3; i++) {
        s.medium.extent[i] = s.params.extent[i] = extent[i];
        s.medium.size[i] = s.params.size[i] = size[i];
        s.medium.voxel[i] = extent[i] / (float)size[i];
    }
    s.camera.orthographic = 1;
    s.camera.forward[2] = -1;
    s.params.channels = 1;
    return s;
}

static struct light_block *add_lamp(setup *s, float x, float y, float z)
{
    struct light_block *light = &s->params.lamps[s->params.num_lamps++];
    *light = (struct light_block){
        .kind = TYN_LIGHT_KIND_POINT, .position = {x, y, z}, .color = {1, 1, 1}};
    return light;
}

static outcome run(gpu_test *t, const setup *s)
{
    const uint32_t *size = s->medium.size;
    tyn_ref refs[PROPAGATE_RADIAL_NUM_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    refs[PORT(MEDIUM)] = gpu_buffer(t, "medium", &s->medium, sizeof s->medium);
    refs[PORT(CAMERA)] = gpu_buffer(t, "camera", &s->camera, sizeof s->camera);
    refs[PORT(DENSITY)] = gpu_image(t, "density", TYN_IMAGE_3D,
                                    (tyn_extent){size[0], size[1], size[2]}, 1, s->density);
    if (s->params.max_vpls) {
        refs[PORT(VPLS)] = gpu_buffer(t, "vpls", &s->vpls, sizeof s->vpls);
    }
    static struct shadow_light maps[TYN_SHADOW_MAX];
    maps[TYN_SHADOW_LAMP(0)] = s->map;
    if (s->atlas) {
        refs[PORT(SHADOW_ATLAS)] = gpu_image(t, "shadow_atlas", TYN_IMAGE_2D,
                                             (tyn_extent){3 * FACE, 2 * FACE, 1}, 1, s->atlas);
        refs[PORT(SHADOWS)] = gpu_buffer(t, "shadows", maps, sizeof maps);
        refs[PORT(VPL_DISTANCES)] = gpu_image(t, "vpl_distances", TYN_IMAGE_2D,
                                              (tyn_extent){16 * FACE, FACE, 1}, 1, s->distances);
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_propagate_radial, &s->params, refs), TYN_OK);
    static const int shown[] = {PORT(GRIDS), PORT(MAP),  PORT(CELLS), PORT(STATE),
                                PORT(SUM),   PORT(SEEN), PORT(LIT)};
    for (int i = 0; i < 7; i++) {
        tyn_graph_output(t->graph, tyn_pass_propagate_radial.ports[shown[i]].name, refs[shown[i]],
                         true);
    }
    gpu_run(t);
    return (outcome){gpu_map(t, "map"),
                     gpu_map(t, "cells"),
                     gpu_map(t, "state"),
                     gpu_map(t, "sum"),
                     gpu_map(t, "lit"),
                     gpu_map(t, "grids"),
                     ((uint32_t)s->params.cells + 1) & ~1u,
                     (uint32_t)s->params.shells + 1,
                     s->params.channels};
}

// Power in the middle of cell q of a stack.
static double light_of(const outcome *o, uint32_t stack, uint32_t q)
{
    uint32_t at = stack * o->n * o->n * o->layers + q;
    const float *c = o->state[at].c;
    return ((double)c[0] + 4.0 * (double)c[1] + (double)c[2]) *
           exp(0.5 * (double)o->cells[at].c[1]);
}

static double held(const outcome *o, uint32_t grid, uint32_t channel)
{
    double sum = 0;
    for (uint32_t q = 0; q < o->n * o->n * o->layers; q++) {
        sum += light_of(o, grid * o->channels + channel, q);
    }
    return sum;
}

// ---- the map ----------------------------------------------------------------------------------

// Direction of an octahedral coordinate: the faces folded out one by one.
static void direction(double u, double v, double d[3])
{
    double z = 1 - fabs(u) - fabs(v);
    d[0] = z >= 0 ? u : copysign(1 - fabs(v), u);
    d[1] = z >= 0 ? v : copysign(1 - fabs(u), v);
    d[2] = z;
    vector_normalise(d);
}

// Solid angle of a triangle of directions (Van Oosterom and Strackee 1983).
static double triangle(const double a[3], const double b[3], const double c[3])
{
    double volume = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                    a[2] * (b[0] * c[1] - b[1] * c[0]);
    return fabs(2 * atan2(volume, 1 + vector_dot(a, b) + vector_dot(b, c) + vector_dot(c, a)));
}

// Edges of texels are great circles, and those that are cut by the fold |u| + |v| = 1 are cut along a diagonal.
static double solid_angle(int n, int i, int j)
{
    double corner[2][2][3], u = (2 * i + 1.0) / n - 1, v = (2 * j + 1.0) / n - 1;
    for (int b = 0; b < 2; b++) {
        for (int a = 0; a < 2; a++) {
            direction(2.0 * (i + a) / n - 1, 2.0 * (j + b) / n - 1, corner[b][a]);
        }
    }
    bool falling = u * v > 0; // the fold's direction in this quadrant
    return falling ? triangle(corner[0][0], corner[0][1], corner[1][0]) +
                         triangle(corner[1][1], corner[0][1], corner[1][0])
                   : triangle(corner[0][1], corner[0][0], corner[1][1]) +
                         triangle(corner[1][0], corner[0][0], corner[1][1]);
}

static const float one_voxel = 1;

static void maps(void **state)
{
    setup s = setup_of((float[]){1, 1, 1}, (uint32_t[]){1, 1, 1}, &one_voxel);
    s.medium.sigma_s[0] = 1;
    add_lamp(&s, 0.5f, 0.5f, 0.5f);
    struct light_block *spot = add_lamp(&s, 0.2f, 0.3f, 0.4f);
    *spot = (struct light_block){.position = {0.2f, 0.3f, 0.4f},
                                 .kind = TYN_LIGHT_KIND_SPOT,
                                 .direction = {0.6f, 0, 0.8f},
                                 .cos_inner = 0.9f,
                                 .cos_outer = 0.7f};
    spot = add_lamp(&s, 0, 0, 0);
    *spot = (struct light_block){.position = {0.5f, 0.5f, 3},
                                 .kind = TYN_LIGHT_KIND_SPOT,
                                 .direction = {0, 0, -1},
                                 .cos_inner = 0.999999f,
                                 .cos_outer = 0.9999989f}; // narrower than all points of a texel
    s.params.max_vpls = 2;
    s.vpls.count = 1;
    s.vpls.list[0] = (struct light_block){.position = {0.5f, 0.5f, 0},
                                          .kind = TYN_LIGHT_KIND_COSINE,
                                          .direction = {0, 0, 1},
                                          .radius = 0.5f,
                                          .color = {1, 2, 3}};
    for (int n = 2; n <= 32; n *= 4) {
        s.params.cells = n;
        outcome o = run(*state, &s);
        double worst = 0;
        const double power[] = {4 * PI, 2 * PI * (1 - (2 * 0.9 + 0.7) / 3),
                                2 * PI * (1 - (2 * 0.999999 + 0.9999989) / 3), PI};
        for (int k = 0; k < 4; k++) {
            double angles = 0, start = 0;
            for (int q = 0; q < n * n; q++) {
                const float *c = o.map[k * n * n + q].c;
                angles += c[1];
                start += c[0];
                if (k == 0) {
                    worst = maximum(worst, fabs(c[1] / solid_angle(n, q % n, q / n) - 1));
                }
            }
            // The outer half of a flattened map is seen from its few points only.
            assert_true(fabs(angles / (4 * PI) - 1) < (k == 2 ? 0.05 : 1e-3));
            // The narrowest spot's 1 - cos is a few ulps of the cosine, which has a root.
            const double cosine = gpu_ulps(*state, GPU_ROOT) / (1 - 0.999999);
            if (k == 2 && cosine > 0.05) {
                print_message("not judged: the narrowest spot's power, off by up to %.2f\n",
                              cosine);
            } else {
                assert_true(fabs(start / power[k] - 1) < (k == 2 ? 0.05 : 1e-5));
            }
        }
        print_message("%d x %d: solid angles within %.1e\n", n, n, worst);
        // Of texels that the fold cuts.
        assert_true(n == 2 ? worst <= 1e-5
                           : within(worst, n == 8 ? 1.2e-3 : 5e-3, NULL, "maps, %d cells", n));
        double r = 0.5 * sqrt(0.25 + 0.25 + 1); // half the way to the farthest corner
        assert_near(o.grids[3].mean_cosine, 0.5 + 0.5 * r / sqrt(r * r + 0.25), 1e-5);
        assert_int_equal(o.grids[3].layers, o.layers);
        assert_int_equal(o.grids[4].layers, 0); // there is none
        assert_true(held(&o, 4, 0) == 0);
    }
}

// A light that stands for a disc starts with its mean cosine to the power of beta, and without the prefilter as a beam.
static void prefilters(void **state)
{
    static const struct {
        uint32_t prefilter;
        float beta;
        double power;
    } cases[] = {{0, 1, 0}, {1, 1, 1}, {1, 3, 3}, {1, 0.5f, 0.5}};
    setup s = setup_of((float[]){1, 1, 1}, (uint32_t[]){1, 1, 1}, &one_voxel);
    s.medium.sigma_s[0] = 1;
    s.params.max_vpls = s.vpls.count = 1;
    s.vpls.list[0] = (struct light_block){.position = {0.5f, 0.5f, 0},
                                          .kind = TYN_LIGHT_KIND_COSINE,
                                          .direction = {0, 0, 1},
                                          .radius = 0.5f,
                                          .color = {1, 1, 1}};
    const double r = 0.5 * sqrt(0.25 + 0.25 + 1), mean = 0.5 + 0.5 * r / sqrt(r * r + 0.25);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        s.params.prefilter = cases[i].prefilter;
        s.params.beta = cases[i].beta;
        const outcome o = run(*state, &s);
        assert_near(o.grids[0].mean_cosine, pow(mean, cases[i].power), 1e-5);
    }
}

// Folded neighbours are neighbours on the sphere too: no farther than the widest cell.
static void folds(void **state)
{
    (void)state;
    for (int n = 2; n <= 32; n += 2) {
        for (int q = 0; q < 4 * n * n; q++) {
            static const int step[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
            int i = q / 4 % n, j = q / 4 / n, at[2], back[2], returns = 0;
            radial_twin_beside(n, i, j, step[q % 4][0], step[q % 4][1], at);
            double a[3], b[3];
            direction((2 * i + 1.0) / n - 1, (2 * j + 1.0) / n - 1, a);
            direction((2 * at[0] + 1.0) / n - 1, (2 * at[1] + 1.0) / n - 1, b);
            assert_true(acos(minimum(vector_dot(a, b), 1)) < 6.0 / n);
            for (int k = 0; k < 4; k++) {
                radial_twin_beside(n, at[0], at[1], step[k][0], step[k][1], back);
                returns += back[0] == i && back[1] == j;
            }
            assert_true(returns > 0);
        }
    }
}

// ---- the twin ---------------------------------------------------------------------------------

enum { MAX_CELLS = 12 * 12 * 16 };

static double worst_of(const double *found, const double *expected, int n)
{
    double top = 0, result = 0;
    for (int i = 0; i < n; i++) {
        top = fmax(top, fabs(expected[i]));
    }
    for (int i = 0; i < n; i++) {
        double scale = fmax(fabs(expected[i]), 1e-4 * top);
        result = maximum(result, fabs(found[i] - expected[i]) / scale);
    }
    return result;
}

static double compare(const setup *s, const outcome *o, uint32_t grid, uint32_t channel,
                      radial_twin_sums *sums)
{
    static double start[144], angle[144], tau_s[MAX_CELLS], tau_a[MAX_CELLS], g[MAX_CELLS],
        lit[MAX_CELLS], mu[MAX_CELLS], light[MAX_CELLS], cosine[MAX_CELLS], seen[MAX_CELLS],
        found[3][MAX_CELLS];
    static bool cell[MAX_CELLS];
    static int first[144];
    int layer = (int)(o->n * o->n), total = layer * (int)o->layers;
    const entry *map = o->map + grid * (uint32_t)layer;
    uint32_t stack = grid * o->channels + channel;
    const texel *cells = o->cells + stack * (uint32_t)total;
    for (int q = 0; q < layer; q++) {
        start[q] = map[q].c[0];
        angle[q] = map[q].c[1];
        first[q] = -1;
    }
    for (int q = 0; q < total; q++) {
        const float *c = cells[q].c;
        cell[q] = c[3] > -1.5f;
        tau_s[q] = c[0];
        tau_a[q] = c[1];
        g[q] = c[2];
        mu[q] = c[3];
        lit[q] = s->params.shadowed ? o->lit[grid * (uint32_t)total + (uint32_t)q] : 1;
        first[q % layer] = cell[q] && first[q % layer] < 0 ? q / layer : first[q % layer];
    }
    const struct propagate_radial_grid *own = &o->grids[grid];
    static const radial_twin_scale scales[] = {RADIAL_TWIN_POWER, RADIAL_TWIN_RECIPROCAL,
                                               RADIAL_TWIN_SPACING};
    radial_twin twin = {(int)o->n,
                        (int)o->layers,
                        own->growth,
                        start,
                        angle,
                        tau_s,
                        tau_a,
                        g,
                        mu,
                        cell,
                        first,
                        own->mean_cosine,
                        lit,
                        scales[s->params.scale],
                        s->params.narrowing != 0,
                        s->params.last_event != 0,
                        s->params.rate == TYN_PROPAGATE_RATE_EXACT};
    *sums = radial_twin_run(&twin, s->params.iterations, light, cosine, seen);
    for (int q = 0; q < total; q++) {
        double of_cell = light_of(o, stack, (uint32_t)q);
        found[0][q] = cell[q] ? of_cell : 0;
        double spread = o->state[stack * (uint32_t)total + (uint32_t)q].c[3]; // after half a cell
        double half = 0.5 * tau_s[q],
               left = twin.exact_rate ? exp(-(1 - g[q]) * half) : pow(g[q], half);
        found[1][q] = cell[q] ? (1 - spread) / left * of_cell : 0;
        found[2][q] = o->sum[stack * (uint32_t)total + (uint32_t)q];
        cosine[q] *= light[q];
    }
    return maximum(maximum(worst_of(found[0], light, total), worst_of(found[1], cosine, total)),
                   worst_of(found[2], seen, total));
}

static setup blobs(float *density)
{
    const uint32_t size[3] = {9, 12, 7};
    srand(5);
    for (uint32_t q = 0; q < size[0] * size[1] * size[2]; q++) {
        density[q] = rand() % 4 ? (float)(rand() % 1000) * 1e-3f : 0;
    }
    setup s = setup_of((float[]){1.0f, 1.3f, 0.8f}, size, density);
    memcpy(s.medium.sigma_s, (float[]){2, 5, 9}, sizeof s.medium.sigma_s);
    memcpy(s.medium.sigma_a, (float[]){0.5f, 0.1f, 0}, sizeof s.medium.sigma_a);
    memcpy(s.medium.phase, (tyn_phase[]){{.g = 0.8f}, {.g = 0.3f}, {.g = 0.5f}},
           sizeof s.medium.phase);
    s.camera = (struct camera_block){.origin = {0.3f, 0.9f, 3}, .forward = {0, 0, -1}};
    s.params.channels = 3;
    s.params.cells = 11; // made even
    s.params.shells = 9;
    s.params.iterations = 13;
    add_lamp(&s, 0.4f, 0.7f, 0.3f);
    struct light_block *spot = add_lamp(&s, 0.9f, -0.5f, 1.5f);
    spot->kind = TYN_LIGHT_KIND_SPOT;
    memcpy(spot->direction, (float[]){-0.48f, 0.6f, -0.64f}, sizeof spot->direction);
    spot->cos_inner = 0.95f;
    spot->cos_outer = 0.8f;
    s.params.max_vpls = 1;
    s.vpls.count = 1;
    s.vpls.list[0] = (struct light_block){.position = {0.2f, 0, 0.6f},
                                          .kind = TYN_LIGHT_KIND_COSINE,
                                          .direction = {0, 1, 0},
                                          .radius = 0.2f,
                                          .color = {1, 2, 3}};
    return s;
}

// A hop has a root and two quotients of the lobe, quotients of the cells' sizes and of the light's spread, and two exponentials of
// about 1. Their errors add up.
static double hops_off(const gpu_test *t, const setup *s)
{
    return s->params.iterations * gpu_ulps(t, GPU_ROOT + 4 * GPU_QUOTIENT + 2 * GPU_EXP(1.0));
}

static void equals_twin(void **state)
{
    static float density[9 * 12 * 7];
    setup s = blobs(density);
    for (int reading = 0; reading < 12; reading++) {
        s.params.scale = reading % 3;
        s.params.rate = reading / 3 & 1;
        s.params.last_event = (uint32_t)(reading / 3 & 1);
        s.params.narrowing = (uint32_t)(reading / 6);
        outcome o = run(*state, &s);
        double difference = 0, balance = 0;
        for (uint32_t grid = 0; grid < 3; grid++) {
            for (uint32_t c = 0; c < 3; c++) {
                radial_twin_sums sums;
                difference = maximum(difference, compare(&s, &o, grid, c, &sums));
                double rest = sums.injected - sums.absorbed - sums.escaped - sums.held;
                if (s.params.scale != TYN_PROPAGATE_SCALE_SPACING) {
                    balance = maximum(balance, fabs(rest / sums.injected));
                    assert_true(fabs(held(&o, grid, c) - sums.held) < 1e-4 * sums.injected);
                }
            }
        }
        print_message("scale %d, rate %d, narrowing %u: largest difference %.1e, balance %.1e\n",
                      s.params.scale, s.params.rate, s.params.narrowing, difference, balance);
        // Lobes that point inwards keep 1 - a next to 2, where the parts that go outwards lose digits: as many more as the
        // device's functions are worse than their seven roundings.
        const double hops = hops_off(*state, &s);
        const double more = hops / (s.params.iterations * 7 * 0.5 * (double)FLT_EPSILON);
        assert_true(s.params.narrowing ? within(difference, 4e-3 * (1 + more), NULL, "narrowing")
                                       : difference < 4e-5 + hops);
        assert_true(balance < 1e-12);
    }
}

// A plate 0.2 m from the first lamp in the direction +x, which one face of its map shows; the second lamp has no map; all
// around the VPL there are surfaces at 0.3 m.
static void surfaces_stop_light(void **state)
{
    static float density[9 * 12 * 7], atlas[6 * FACE * FACE], distances[16 * FACE * FACE];
    setup s = blobs(density);
    for (int q = 0; q < 6 * FACE * FACE; q++) {
        atlas[q] = q % (3 * FACE) < FACE && q / (3 * FACE) < FACE ? 0.01f / 0.2f : 0;
    }
    for (int q = 0; q < 16 * FACE * FACE; q++) {
        distances[q] = 0.3f;
    }
    const float *at = s.params.lamps[0].position;
    s.map = (struct shadow_light){.rows = {{1, 0, 0, -at[0]}, {0, 1, 0, -at[1]}, {0, 0, 1, -at[2]}},
                                  .texels = FACE,
                                  .scale = 0.9f,
                                  .near = 0.01f,
                                  .kind = TYN_SHADOW_CUBE};
    s.atlas = atlas;
    s.distances = distances;
    s.params.shadowed = 1;
    outcome o = run(*state, &s);
    double off = 0, difference = 0;
    int dark = 0, partly = 0;
    enum { LOOKS = PROPAGATE_RADIAL_LOOKS };
    for (uint32_t grid = 0; grid < 3; grid++) {
        const struct propagate_radial_grid *own = &o.grids[grid];
        for (uint32_t place = 0; place < o.n * o.n; place++) {
            double found = 1;
            for (uint32_t k = 0; k < o.layers; k++) {
                double r = k ? 0.5 * (1 + own->growth) * own->inner * pow(own->growth, k - 1.0) : 0;
                double expected = 0;
                bool on_edge = false;
                for (uint32_t look = 0; look < LOOKS * LOOKS; look++) {
                    double d[3];
                    direction(2 * (place % o.n + (look % LOOKS + 0.5) / LOOKS) / o.n - 1,
                              2 * (place / o.n + (look / LOOKS + 0.5) / LOOKS) / o.n - 1, d);
                    const double beyond = d[0] - fmax(fabs(d[1]), fabs(d[2]));
                    on_edge = on_edge || fabs(beyond) < 1e-6; // of two faces of the map
                    bool plate = beyond >= 0;
                    double reach = grid == 2 ? 0.3 : grid == 0 && plate ? 0.2 / d[0] : INFINITY;
                    expected += r < reach ? 1.0 / (LOOKS * LOOKS) : 0;
                }
                found *= o.lit[(grid * o.layers + k) * o.n * o.n + place];
                off = on_edge ? off : maximum(off, fabs(found - expected));
                dark += expected < 0.01;
                partly += expected > 0.01 && expected < 0.99;
            }
        }
        for (uint32_t c = 0; c < 3; c++) {
            radial_twin_sums sums;
            difference = maximum(difference, compare(&s, &o, grid, c, &sums));
        }
    }
    print_message("%d cells dark, %d in part; lit off by %.1e, states by %.1e\n", dark, partly, off,
                  difference);
    assert_true(dark > 100 && partly > 10);
    assert_true(off < 1e-5);
    assert_true(difference < 4e-5 + hops_off(*state, &s));
}

// ---- what holds for any light -------------------------------------------------------------------

// Before any light is out of the grid all that started is in it.
static void keeps_power(void **state)
{
    setup s = setup_of((float[]){1, 1, 1}, (uint32_t[]){1, 1, 1}, &one_voxel);
    s.medium.sigma_s[0] = 5;
    s.medium.phase[0].g = 0.4f;
    s.params.cells = 10;
    s.params.shells = 12;
    s.params.iterations = 8;
    add_lamp(&s, 0.5f, 0.5f, 0.5f);
    for (s.params.scale = 0; s.params.scale < TYN_PROPAGATE_SCALE_SPACING; s.params.scale++) {
        outcome o = run(*state, &s);
        double error = held(&o, 0, 0) / (4 * PI) - 1;
        print_message("scale %d: power off by %.1e\n", s.params.scale, error);
        assert_true(fabs(error) < 1e-5);
    }
    s.params.scale = TYN_PROPAGATE_SCALE_POWER;
    // After 8 iterations a beam is in the middle of the eighth shell, and has crossed all that is before.
    s.medium.sigma_a[0] = 2;
    s.medium.sigma_s[0] = 0;
    outcome o = run(*state, &s);
    double width = sqrt(4 * PI) / 10, outer = sqrt(0.75) * exp(-width * 4);
    double r = 0.5 * (outer * exp(-width) + outer);
    print_message("beam: %.6f of %.6f\n", held(&o, 0, 0) / (4 * PI), exp(-2 * r));
    assert_near(held(&o, 0, 0) / (4 * PI), exp(-2 * r), 1e-5);
}

enum { BALL = 32 };

// A soft ball around a lamp that shines alike in all directions. `axis`: of the map; NULL: that of M.
static setup soft_ball(float *density, const float axis[3])
{
    for (int q = 0; q < BALL * BALL * BALL; q++) {
        double x = (q % BALL + 0.5) / BALL - 0.5, y = (q / BALL % BALL + 0.5) / BALL - 0.5;
        double z = ((q / BALL / BALL) + 0.5) / BALL - 0.5, r = sqrt(x * x + y * y + z * z);
        density[q] = (float)fmax(1 - r / 0.48, 0);
    }
    setup s = setup_of((float[]){1, 1, 1}, (uint32_t[]){BALL, BALL, BALL}, density);
    s.medium.sigma_s[0] = 12;
    s.medium.sigma_a[0] = 1;
    s.medium.phase[0].g = 0.5f;
    s.params.cells = s.params.shells = 16;
    s.params.iterations = 24;
    struct light_block *lamp = add_lamp(&s, 0.5f, 0.5f, 0.5f);
    if (axis) {
        lamp->kind = TYN_LIGHT_KIND_SPOT;
        lamp->cos_outer = -1;
        lamp->cos_inner = -0.999999f;
        memcpy(lamp->direction, axis, 3 * sizeof(float));
    }
    return s;
}

// Equal light stays equal over edges, corners and middle of the map, however that lies.
static void stays_symmetric(void **state)
{
    static float density[BALL * BALL * BALL];
    static double mean[2][17];
    for (int turned = 0; turned < 2; turned++) {
        setup s = soft_ball(density, turned ? (float[]){0.36f, 0.48f, 0.8f} : NULL);
        outcome o = run(*state, &s);
        const int n = 16, layer = 256;
        double spread = 0, mirrored = 0;
        for (int k = 0; k < 17; k++) {
            double low = INFINITY, high = 0, power = 0, angle = 0;
            for (int q = 0; q < layer; q++) {
                double light = light_of(&o, 0, (uint32_t)(k * layer + q));
                double per_angle = light / (double)o.map[q].c[1];
                low = minimum(low, per_angle);
                high = maximum(high, per_angle);
                power += light;
                angle += o.map[q].c[1];
                if (!turned) { // the map's own symmetries
                    int i = q % n, j = q / n;
                    int other[3] = {i * n + j, j * n + n - 1 - i, (n - 1 - i) * n + n - 1 - j};
                    for (int x = 0; x < 3; x++) {
                        double its = light_of(&o, 0, (uint32_t)(k * layer + other[x]));
                        mirrored = maximum(mirrored, fabs(its - light) / fmax(light, 1e-6));
                    }
                }
            }
            mean[turned][k] = power / angle;
            if (k < 15) { // the outermost are where the ball is thin
                spread = maximum(spread, (high - low) / (power / angle));
            }
        }
        print_message("turned %d: spread over a shell %.3f, of mirrored texels %.1e\n", turned,
                      spread, mirrored);
        assert_within(spread, 0.03, NULL);
        assert_true(mirrored < 1e-4);
    }
    double worst = 0;
    for (int k = 0; k < 15; k++) {
        worst = maximum(worst, fabs(mean[1][k] / mean[0][k] - 1));
    }
    print_message("shells of the turned grid differ by %.1e\n", worst);
    assert_true(worst < 5e-5);
}

static void batches(void **state)
{
    static float density[9 * 12 * 7], seen[1 << 16];
    setup s = blobs(density);
    run(*state, &s);
    tyn_extent size;
    VkFormat format;
    const void *all = tyn_graph_map(((gpu_test *)*state)->graph, "seen", &size, &format);
    size_t bytes = (size_t)size.x * size.y * size.z * sizeof(float);
    assert_true(bytes <= sizeof seen);
    memcpy(seen, all, bytes);
    s.params.buffer_bytes = 12 * 12 * 10 * 3 * 16; // one grid
    run(*state, &s);
    assert_memory_equal(seen, gpu_map(*state, "seen"), bytes);
}

static void stress(void **state)
{
    static const float places[][3] = {{0.5f, 0.5f, 0.5f},   {0, 0, 0},      {1, 0.3f, 0},
                                      {1.001f, 0.5f, 0.5f}, {-40, 3, 1000}, {0.5f, 0.5f, -1e6f}};
    static const float media[][3] = {{0, 0, 0},    {1e-6f, 0, 0},   {1e5f, 0, 0.999f},
                                     {0, 1e5f, 0}, {1e8f, 1e8f, 0}, {3, 1, -0.9f},
                                     {1e5f, 1, 0}};
    for (size_t m = 0; m < sizeof media / sizeof *media; m++) {
        setup s = setup_of((float[]){1, 1, 1}, (uint32_t[]){1, 1, 1}, &one_voxel);
        s.medium.sigma_s[0] = media[m][0];
        s.medium.sigma_a[0] = media[m][1];
        s.medium.phase[0].g = media[m][2];
        for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
            add_lamp(&s, places[i][0], places[i][1], places[i][2]);
        }
        for (int reading = 0; reading < 12; reading++) {
            s.params.cells = reading % 2 ? 6 : 2;
            s.params.shells = reading % 2 ? 5 : 1;
            s.params.scale = reading / 2 % 3;
            s.params.narrowing = (uint32_t)(reading / 6);
            s.params.init = reading / 6;
            s.params.iterations = 40;
            outcome o = run(*state, &s);
            uint32_t cells = o.n * o.n * o.layers * s.params.num_lamps;
            for (uint32_t q = 0; q < cells; q++) {
                const float *c = o.state[q].c;
                assert_true(isfinite(c[0]) && isfinite(c[1]) && isfinite(c[2]) && isfinite(c[3]));
                assert_true(c[0] >= 0 && c[1] >= 0 && c[2] >= 0);
                assert_true(isfinite(o.sum[q]) && o.sum[q] >= 0);
                assert_true(m > 0 || o.sum[q] == 0); // no medium, no light
            }
            for (uint32_t k = 0; k < s.params.num_lamps; k++) {
                if (s.params.scale != TYN_PROPAGATE_SCALE_SPACING && s.params.init == 0) {
                    double started = 0;
                    for (uint32_t q = 0; q < o.n * o.n; q++) {
                        started += o.map[k * o.n * o.n + q].c[0];
                    }
                    // Where next to nothing passes half a cell, what is in its middle is not to be had
                    // from what leaves it.
                    assert_true(media[m][1] > 10 || held(&o, k, 0) <= started * (1 + 1e-5));
                }
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps),
        cmocka_unit_test(prefilters),
        cmocka_unit_test(folds),
        cmocka_unit_test(equals_twin),
        cmocka_unit_test(surfaces_stop_light),
        cmocka_unit_test(keeps_power),
        cmocka_unit_test(stays_symmetric),
        cmocka_unit_test(batches),
        cmocka_unit_test(stress),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
