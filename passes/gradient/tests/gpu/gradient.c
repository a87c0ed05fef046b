// gradient.c -- samples with gradients against closed forms in a uniform medium, what is split, and the field between samples
// against all pairs of cells and samples; lights that stand for many directions, light that has scattered before, and empty bricks.
#include "gpu_test.h"
#include "numbers.h"
#include "passes/gradient/gradient/gradient.h"
#include "passes/light_list/common/light_list_args.h"
#include "passes/light_list/common/light_shades_args.h"
#include "shaders/common/counters.h"
#include "shaders/common/scene_args.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PORT(name) GRADIENT_PORT_##name

enum { MAX_LEVELS = GRADIENT_MAX_LEVELS };

typedef struct stage {
    tyn_gradient_params params;
    float extent[3];
    double sigma_s, sigma_a, g;
    struct light_list_block list;
    float turn;                              // of the camera about y, radians
    const struct light_shades_block *shades; // NULL: none
    const float *scattered; // of 3 x 3 x 3 cells, with one more at each face; or NULL
    const float *bricks;    // BRICKS^3 of least and largest density, or NULL
} stage;

enum { BRICKS = 4 };

// A sun and a lamp beside a uniform box, seen along -z.
static stage make_stage(float x, float y, float z)
{
    stage s = {.extent = {x, y, z}, .sigma_s = 2, .sigma_a = 0.5, .g = 0.4};
    tyn_pass_defaults(&tyn_pass_gradient, &s.params);
    memcpy(s.params.extent, s.extent, sizeof s.extent);
    s.params.mode = TYN_MEDIUM_DENSITY;
    s.params.voxel = tyn_gradient_voxel(s.extent, s.extent);
    s.params.voxels = 64;
    s.params.field = 16;
    s.params.num_lights = 2;
    s.params.lamps = 1;
    s.list.count = 2;
    s.list.lights[0] = (struct light_block){.kind = TYN_LIGHT_KIND_DIRECTIONAL,
                                            .color = {3, 2, 1},
                                            .direction = {0, -1, 0},
                                            .shadow = TYN_LIGHT_NO_SHADOW,
                                            .mean_cosine = 1};
    s.list.lights[1] = (struct light_block){.kind = TYN_LIGHT_KIND_POINT,
                                            .position = {-0.1f, 0.4f * y, 0.3f * z},
                                            .color = {0.5f, 1, 1.5f},
                                            .shadow = TYN_LIGHT_NO_SHADOW,
                                            .mean_cosine = 1,
                                            .cos_inner = -1,
                                            .cos_outer = -1,
                                            .direction = {0, 0, -1}};
    return s;
}

static double hg(double g, double mu)
{
    return (1 - g * g) / (4 * M_PI * pow(1 + g * g - 2 * g * mu, 1.5));
}

// Radiance towards the eye per sigma_s, of channel c.
static double light_at(const stage *s, const double x[3], int c)
{
    const double sigma = s->sigma_s + s->sigma_a;
    const double sun = (double)s->list.lights[0].color[c] *
                       exp(-sigma * ((double)s->extent[1] - x[1])) * hg(s->g, 0);
    double way[3], r2 = 0, to_face = 1;
    for (int a = 0; a < 3; a++) {
        way[a] = x[a] - (double)s->list.lights[1].position[a];
        r2 += way[a] * way[a];
    }
    to_face =
        x[0] / way[0]; // of the way, the part within the box: the lamp is beside the face x = 0
    const double r = sqrt(r2),
                 along = -way[2] / -r; // travels along way / r, is seen travelling along +z
    return sun +
           (double)s->list.lights[1].color[c] / r2 * exp(-sigma * r * to_face) * hg(s->g, along);
}

static void run(gpu_test *t, const stage *s)
{
    struct medium_block medium = {
        .extent = {s->extent[0], s->extent[1], s->extent[2]}, .size = {1, 1, 1}, .max_density = 1};
    for (int c = 0; c < 3; c++) {
        medium.sigma_s[c] = (float)s->sigma_s;
        medium.sigma_a[c] = (float)s->sigma_a;
        medium.phase[c].g = (float)s->g;
        medium.bricks[c] = BRICKS;
        medium.brick_size[c] = s->extent[c] / BRICKS;
    }
    static const float one = 1;
    const struct camera_block camera = {
        .orthographic = 1, .forward = {-sinf(s->turn), 0, -cosf(s->turn)}, .origin = {0, 0, 5}};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    refs[PORT(MEDIUM)] = gpu_buffer(t, "medium", &medium, sizeof medium);
    refs[PORT(DENSITY)] = gpu_image(t, "density", TYN_IMAGE_3D, (tyn_extent){1, 1, 1}, 1, &one);
    refs[PORT(LIGHT_LIST)] = gpu_buffer(t, "list", &s->list, sizeof s->list);
    refs[PORT(CAMERA)] = gpu_buffer(t, "camera", &camera, sizeof camera);
    if (s->shades) {
        refs[PORT(LIGHT_SHADES)] = gpu_buffer(t, "shades", s->shades, sizeof *s->shades);
    }
    if (s->scattered) {
        refs[PORT(SCATTERED)] =
            gpu_image(t, "scattered", TYN_IMAGE_3D, (tyn_extent){5, 5, 5}, 4, s->scattered);
    }
    if (s->bricks) {
        refs[PORT(BRICKS)] = gpu_image(t, "bricks", TYN_IMAGE_3D,
                                       (tyn_extent){BRICKS, BRICKS, BRICKS}, 2, s->bricks);
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_gradient, &s->params, refs), TYN_OK);
    tyn_graph_output(t->graph, "inscatter", refs[PORT(INSCATTER)], true);
    tyn_graph_output(t->graph, "samples", refs[PORT(SAMPLES)], true);
    tyn_graph_output(t->graph, "states", refs[PORT(STATES)], true);
    tyn_graph_output(t->graph, "counters", refs[PORT(COUNTERS)], true);
    gpu_run(t);
    assert_int_equal(gpu_non_finite(t), 0);
}

// ---- grids ------------------------------------------------------------------------------------------

typedef struct level {
    int size[3];
    size_t first, count;
    double spacing[3], radius;
} level;

static int levels_of(const stage *s, level levels[MAX_LEVELS])
{
    const double longest = fmax(s->extent[0], fmax(s->extent[1], s->extent[2]));
    size_t first = 0;
    int n = 0;
    for (int cells = s->params.cells; cells <= s->params.grid; cells *= 2, n++) {
        level *l = &levels[n];
        l->first = first;
        l->count = 1;
        l->radius = longest / cells;
        for (int a = 0; a < 3; a++) {
            l->size[a] = (int)ceil((double)s->extent[a] / l->radius - 1e-3);
            l->spacing[a] = (double)s->extent[a] / l->size[a];
            l->count *= (size_t)l->size[a];
        }
        first += l->count;
    }
    assert_int_equal(tyn_gradient_points(&s->params), first);
    return n;
}

static void place(const level *l, size_t point, double x[3])
{
    const size_t nx = (size_t)l->size[0], ny = (size_t)l->size[1];
    const size_t at[3] = {point % nx, point / nx % ny, point / nx / ny};
    for (int a = 0; a < 3; a++) {
        x[a] = ((double)at[a] + 0.5) * l->spacing[a];
    }
}

// ---- cases ------------------------------------------------------------------------------------------

// Light, its gradient and Eq 6 of all samples of the first grid.
static void samples(void **state)
{
    for (int linear = 0; linear < 2; linear++) {
        stage s = make_stage(1, 0.8f, 0.6f);
        s.params.extrapolation = linear;
        s.params.epsilon = 1;
        run(*state, &s);
        level levels[MAX_LEVELS];
        levels_of(&s, levels);
        const struct gradient_sample *found = gpu_map(*state, "samples");
        const double radius = levels[0].radius, delta = (double)s.params.voxel;
        double light = 0, slope = 0, error = 0;
        for (size_t i = 0; i < levels[0].count; i++) {
            double x[3], right[3], slopes[3][3], sum = 0;
            place(&levels[0], i, x);
            for (int c = 0; c < 3; c++) {
                right[c] = light_at(&s, x, c);
                light = maximum(light, fabs((double)found[i].light[c] / right[c] - 1));
                for (int a = 0; a < 3; a++) {
                    double plus[3] = {x[0], x[1], x[2]}, minus[3] = {x[0], x[1], x[2]};
                    plus[a] += delta;
                    minus[a] -= delta;
                    slopes[a][c] = (light_at(&s, plus, c) - light_at(&s, minus, c)) / (2 * delta);
                    const float *own = a == 0 ? found[i].dx : a == 1 ? found[i].dy : found[i].dz;
                    slope =
                        maximum(slope, fabs((double)own[c] - slopes[a][c]) / (right[c] / radius));
                }
            }
            for (int k = 0; k < 6; k++) {
                const int a = k / 2;
                double there[3] = {x[0], x[1], x[2]};
                there[a] += k % 2 ? -radius : radius;
                there[a] = fmin(fmax(there[a], 0), (double)s.extent[a]);
                for (int c = 0; c < 3; c++) {
                    const double change = (there[a] - x[a]) * slopes[a][c];
                    const double taken =
                        linear ? right[c] + change : right[c] * exp(fmin(change / right[c], 2));
                    sum += fabs(taken - light_at(&s, there, c)) * s.sigma_s / 18;
                }
            }
            sum *= pow(radius, 3) * exp(-(s.sigma_s + s.sigma_a) * ((double)s.extent[2] - x[2]));
            error = maximum(error, fabs((double)found[i].error - sum) / (sum + 1e-6));
        }
        print_message("%s: light %.1e, gradient %.1e, error %.1e off\n",
                      linear ? "linear" : "exponential", light, slope, error);
        assert_true(light < 1e-4);
        assert_true(slope < 1e-5);
        assert_true(error < 1e-4);
    }
}

// What is split follows from the errors; lists are in any order, points are not.
static void splitting(void **state)
{
    static const float boxes[][3] = {
        {1, 1, 1}, {1, 0.8f, 0.6f}, {0.31f, 2, 0.05f}, {5, 3.3f, 4.7f}};
    for (size_t k = 0; k < sizeof boxes / sizeof *boxes; k++) {
        stage s = make_stage(boxes[k][0], boxes[k][1], boxes[k][2]);
        s.params.epsilon = 2e-5f;
        run(*state, &s);
        level levels[MAX_LEVELS];
        const int n = levels_of(&s, levels);
        const size_t points = tyn_gradient_points(&s.params);
        const struct gradient_sample *found = gpu_map(*state, "samples");
        const uint32_t *states = gpu_map(*state, "states");
        const struct counters_block *counted = gpu_map(*state, "counters");
        double reference = 0;
        for (size_t i = 0; i < levels[0].count; i++) {
            reference += (double)found[i].seen * levels[0].spacing[0] * levels[0].spacing[1] *
                         levels[0].spacing[2] / pow(levels[0].radius, 3);
        }
        uint32_t *right = calloc(points, sizeof *right), total = 0;
        int doubtful = 0;
        for (size_t i = 0; i < levels[0].count; i++) {
            right[i] = GRADIENT_IS_LISTED;
        }
        for (int l = 0; l < n; l++) {
            const level *own = &levels[l], *next = &levels[l + 1];
            for (size_t i = 0; i < own->count; i++) {
                uint32_t *at = &right[own->first + i];
                const double share = (double)found[own->first + i].error / reference;
                const bool split = l + 1 < n && share > (double)s.params.epsilon;
                doubtful += *at && fabs(share / (double)s.params.epsilon - 1) < 1e-4;
                if (*at && !split) {
                    *at |= GRADIENT_IS_SAMPLE;
                    total++;
                }
                if (!*at || !split) {
                    continue;
                }
                double x[3];
                place(own, i, x);
                for (size_t j = 0; j < next->count; j++) {
                    double y[3], d2 = 0;
                    bool touches = true;
                    place(next, j, y);
                    for (int a = 0; a < 3; a++) {
                        d2 += (y[a] - x[a]) * (y[a] - x[a]);
                        touches = touches &&
                                  fabs(y[a] - x[a]) < 0.499 * (own->spacing[a] + next->spacing[a]);
                    }
                    if (d2 < own->radius * own->radius * (1 + 1e-6) || touches) {
                        right[next->first + j] = GRADIENT_IS_LISTED;
                    }
                }
            }
        }
        print_message("box %zu: %u samples of %zu points\n", k, total, points);
        assert_true(total > levels[0].count && doubtful == 0);
        assert_int_equal(memcmp(right, states, points * sizeof *right), 0);
        assert_int_equal(counted->pixels, total);
        free(right);
    }
}

// What could be saved by keeping samples from frame to frame: at most the points that are followed for samples which are then split, as all
// others are followed anew where a light moves. And how many samples stay where they are if a little moves.
static void kept(void **state)
{
    uint32_t *before = NULL;
    static const char *const moves[] = {"nothing", "camera by 3 degrees", "lamp by 0.02"};
    for (int move = 0; move < 3; move++) {
        stage s = make_stage(1, 0.8f, 0.6f);
        s.params.epsilon = 2e-5f;
        s.turn = move == 1 ? 0.05f : 0;
        s.list.lights[1].position[1] += move == 2 ? 0.02f : 0;
        run(*state, &s);
        level levels[MAX_LEVELS];
        const int n = levels_of(&s, levels);
        const size_t points = tyn_gradient_points(&s.params);
        const uint32_t *states = gpu_map(*state, "states");
        size_t samples = 0, same = 0, traces = 0, split = 0;
        if (!before) {
            before = malloc(points * sizeof *before);
            memcpy(before, states, points * sizeof *before);
        }
        for (int l = 0; l < n; l++) {
            const size_t of_each = l + 1 < n ? 14 : 7;
            for (size_t i = levels[l].first; i < levels[l].first + levels[l].count; i++) {
                const bool is = states[i] & GRADIENT_IS_SAMPLE,
                           was = before[i] & GRADIENT_IS_SAMPLE;
                traces += states[i] ? of_each : 0;
                split += states[i] && !is ? of_each : 0;
                samples += is;
                same += is && was;
            }
        }
        const double saved = (double)split / (double)traces;
        print_message(
            "%s moved: %zu samples, %.1f %% stay; %.1f %% of all traces are of samples that "
            "are split\n",
            moves[move], samples, 100.0 * (double)same / (double)samples, 100 * saved);
        assert_true(saved < 0.15 && saved > 0.05);
        assert_true((double)same > 0.85 * (double)samples && (move == 0) == (same == samples));
    }
    free(before);
}

// Eq 4 over all pairs.
static void field(void **state)
{
    static const struct {
        int32_t interpolation, weight, extrapolation;
    } cases[] = {{GRADIENT_GRADIENT, 0, 0}, {GRADIENT_GRADIENT, 1, 1}, {GRADIENT_RBF, 0, 0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        stage s = make_stage(1, 0.8f, 0.6f);
        s.params.interpolation = cases[k].interpolation;
        s.params.weight = cases[k].weight;
        s.params.extrapolation = cases[k].extrapolation;
        s.params.grid = 32;
        run(*state, &s);
        level levels[MAX_LEVELS];
        const int n = levels_of(&s, levels);
        const struct gradient_sample *found = gpu_map(*state, "samples");
        const uint32_t *states = gpu_map(*state, "states");
        const float(*image)[4] = (const float(*)[4])gpu_map(*state, "inscatter");
        const int nx = 18, ny = 15, nz = 12; // 16 x 13 x 10 cubes about the box
        const double side = 1.0 / 16,
                     origin[3] = {0, 0.5 * (0.8 - 13 * side), 0.5 * (0.6 - 10 * side)};
        double worst = 0;
        for (int q = 0; q < nx * ny * nz; q++) {
            const int at[3] = {q % nx, q / nx % ny, q / nx / ny};
            double x[3], sum[3] = {0}, weights = 0;
            for (int a = 0; a < 3; a++) {
                x[a] = fmin(fmax(origin[a] + (at[a] - 0.5) * side, 0), (double)s.extent[a]);
            }
            for (int l = 0; l < n; l++) {
                for (size_t i = 0; i < levels[l].count; i++) {
                    const size_t p = levels[l].first + i;
                    double y[3], r = levels[l].radius;
                    if (!(states[p] & GRADIENT_IS_SAMPLE)) {
                        continue;
                    }
                    place(&levels[l], i, y);
                    const double away[3] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
                    const double d =
                        sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]);
                    if (d >= r) {
                        continue;
                    }
                    const double w = cases[k].interpolation == GRADIENT_RBF
                                         ? exp(-9 * d * d / (r * r)) + 1e-12
                                     : cases[k].weight ? r / fmax(d, 1e-4 * r)
                                                       : (r / fmax(d, 1e-4 * r) - 1) / (r * r * r);
                    weights += w;
                    for (int c = 0; c < 3; c++) {
                        const double own = (double)found[p].light[c];
                        const double change = away[0] * (double)found[p].dx[c] +
                                              away[1] * (double)found[p].dy[c] +
                                              away[2] * (double)found[p].dz[c];
                        sum[c] += w * (cases[k].interpolation == GRADIENT_RBF ? own
                                       : cases[k].extrapolation               ? own + change
                                                                : own * exp(fmin(change / own, 2)));
                    }
                }
            }
            const bool inside = at[0] > 0 && at[1] > 0 && at[2] > 0 && at[0] < nx - 1 &&
                                at[1] < ny - 1 && at[2] < nz - 1;
            assert_true(weights > 0 || !inside);
            for (int c = 0; c < 3 && weights > 0; c++) {
                const double right = fmax(sum[c] / weights, 0);
                worst = maximum(worst, fabs((double)image[q][c] - right) / (right + 1e-3));
            }
        }
        print_message("case %zu: %.1e off\n", k, worst);
        assert_true(worst < 1e-5);
    }
}

// Atomics fill the lists in any order; what comes out is the same bytes.
static void same_bytes(void **state)
{
    stage s = make_stage(1, 0.8f, 0.6f);
    s.params.field = 32;
    float *first = NULL;
    const size_t size = 34ull * 28 * 22 * 16;
    for (int k = 0; k < 3; k++) {
        run(*state, &s);
        const float *image = gpu_map(*state, "inscatter");
        if (!first) {
            first = malloc(size);
            memcpy(first, image, size);
        }
        assert_int_equal(memcmp(first, image, size), 0);
    }
    free(first);
}

// Light followed to each cell, against the closed form.
static void voxels(void **state)
{
    stage s = make_stage(1, 1, 1);
    s.params.interpolation = GRADIENT_VOXEL;
    run(*state, &s);
    const float(*image)[4] = (const float(*)[4])gpu_map(*state, "inscatter");
    double worst = 0;
    for (int q = 0; q < 16 * 16 * 16; q++) {
        const int at[3] = {q % 16, q / 16 % 16, q / 256};
        const double x[3] = {(at[0] + 0.5) / 16, (at[1] + 0.5) / 16, (at[2] + 0.5) / 16};
        const float *found = image[((at[2] + 1) * 18 + at[1] + 1) * 18 + at[0] + 1];
        for (int c = 0; c < 3; c++) {
            worst = maximum(worst, fabs((double)found[c] / light_at(&s, x, c) - 1));
        }
    }
    assert_true(worst < 1e-4);
}

// A sun that stands for three directions of unequal shares; the second light, a lamp, is dark.
static void directions(void **state)
{
    stage s = make_stage(1, 1, 1);
    s.params.epsilon = 1;
    s.params.lamps = 0;
    s.list.count = 1;
    static struct light_shades_block shades;
    static const double along[3][3] = {{0.6, -0.8, 0}, {0, -0.6, -0.8}, {0, 0, 1}};
    static const double share[3] = {0.5, 0.3, 0.2}, spread[3] = {1, 0.9, 0.7};
    shades.lights[0] = (struct light_shades_range){.first = 2, .count = 3};
    double phase = 0;
    for (int k = 0; k < 3; k++) {
        struct light_shade *shade = &shades.shades[2 + k];
        *shade = (struct light_shade){.share = (float)share[k], .mean_cosine = (float)spread[k]};
        for (int a = 0; a < 3; a++) {
            shade->along[a] = (float)along[k][a];
        }
        phase += share[k] * hg(s.g * spread[k], along[k][2]); // seen along +z
    }
    s.shades = &shades;
    run(*state, &s);
    level levels[MAX_LEVELS];
    levels_of(&s, levels);
    const struct gradient_sample *found = gpu_map(*state, "samples");
    double worst = 0;
    for (size_t i = 0; i < levels[0].count; i++) {
        double x[3];
        place(&levels[0], i, x);
        for (int c = 0; c < 3; c++) {
            const double right = (double)s.list.lights[0].color[c] *
                                 exp(-(s.sigma_s + s.sigma_a) * (1 - x[1])) * phase;
            worst = maximum(worst, fabs((double)found[i].light[c] / right - 1));
        }
    }
    print_message("three directions: %.1e off\n", worst);
    assert_true(worst < 1e-4);
}

// With light that has scattered before all is delta scaled, and first scattering has the whole phase function over 1 - f.
static void scattered_before(void **state)
{
    float scattered[125][4];
    for (int q = 0; q < 125; q++) { // linear along x, as cells of thirds of the box are blended
        for (int c = 0; c < 3; c++) {
            scattered[q][c] = (float)(c + 1) * (1 + 0.3f * (float)(q % 5 - 1));
        }
        scattered[q][3] = 0;
    }
    for (uint32_t one = 0; one < 2; one++) {
        stage s = make_stage(1, 1, 1);
        s.params.epsilon = 1;
        s.params.lamps = 0;
        s.list.count = 1;
        s.scattered = &scattered[0][0];
        s.params.one_channel = one;
        s.params.tint[0] = 1;
        s.params.tint[1] = 0.5f;
        s.params.tint[2] = 0.25f;
        run(*state, &s);
        level levels[MAX_LEVELS];
        levels_of(&s, levels);
        const struct gradient_sample *found = gpu_map(*state, "samples");
        const double f = s.g * s.g, sigma = s.sigma_a + (1 - f) * s.sigma_s;
        double worst = 0;
        for (size_t i = 0; i < levels[0].count; i++) {
            double x[3];
            place(&levels[0], i, x);
            for (int c = 0; c < 3; c++) {
                const double once = (double)s.list.lights[0].color[c] * exp(-sigma * (1 - x[1])) *
                                    hg(s.g, 0) / (1 - f);
                const double before =
                    (one ? (double)s.params.tint[c] : c + 1) * (1 + 0.3 * (3 * x[0] - 0.5));
                worst = maximum(worst, fabs((double)found[i].light[c] / (once + before) - 1));
            }
        }
        print_message("%s: %.1e off\n", one ? "one channel" : "three channels", worst);
        assert_true(worst < 1e-4);
    }
}

// Where bricks are empty there is no field; where cells may be blended with some that are not, it is as it would be.
static void empty_bricks(void **state)
{
    stage s = make_stage(1, 1, 1);
    s.params.field = 32;
    float bricks[BRICKS * BRICKS * BRICKS][2] = {{0}};
    bricks[(1 * BRICKS + 1) * BRICKS + 2][1] = 1; // 0.5 to 0.75, 0.25 to 0.5, 0.25 to 0.5
    run(*state, &s);
    const size_t size = 34ull * 34 * 34 * 16;
    float(*all)[4] = malloc(size);
    memcpy(all, gpu_map(*state, "inscatter"), size);
    s.bricks = &bricks[0][0];
    run(*state, &s);
    const float(*found)[4] = (const float(*)[4])gpu_map(*state, "inscatter");
    uint32_t kept = 0, gone = 0;
    for (int q = 0; q < 34 * 34 * 34; q++) {
        const int at[3] = {q % 34 - 1, q / 34 % 34 - 1, q / 34 / 34 - 1};
        const bool near =
            at[0] >= 15 && at[0] <= 24 && at[1] >= 7 && at[1] <= 16 && at[2] >= 7 && at[2] <= 16;
        const bool same = memcmp(all[q], found[q], sizeof all[q]) == 0;
        const bool dark = found[q][0] == 0 && found[q][1] == 0 && found[q][2] == 0;
        assert_true(near ? same : same || dark);
        kept += near;
        gone += dark;
    }
    print_message("%u cells kept, %u of 39304 dark\n", kept, gone);
    assert_true(kept == 1000 && gone > 34000);
    free(all);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions),   cmocka_unit_test(scattered_before),
        cmocka_unit_test(empty_bricks), cmocka_unit_test(kept),
        cmocka_unit_test(samples),      cmocka_unit_test(splitting),
        cmocka_unit_test(field),        cmocka_unit_test(same_bytes),
        cmocka_unit_test(voxels)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
