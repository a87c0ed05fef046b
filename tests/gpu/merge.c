// merge.c -- radiance towards the eye and its ghost layer, against the formula on the CPU.
#include "bound.h"
#include "gpu_test.h"
#include "shaders/beams/columns_args.h"
#include "shaders/common/counters.h"
#include "lobe_series.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/common/scene_args.h"
#include "base/half.h"
#include "passes/merge/merge.h"
#include "passes/scatter_lut/scatter_lut.h"
#include "numbers.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NX = 5, NY = 3, NZ = 4, CELLS = NX * NY * NZ };

static const float extent[3] = {2.5f, 1.4f, 1.9f}; // dx = 0.5: the box reaches 0.05 beyond y and z

static float random_01(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (float)(*seed >> 8) / 16777216.0f;
}

// J of a cell inside the lattice.
static double inside(const float *cells, const float *moments, const struct camera_block *camera,
                     int x, int y, int z, int ch)
{
    const int c[3] = {x, y, z}, n[3] = {NX, NY, NZ};
    double v[3], length = 0, flux = 0;
    int i = ((ch * NZ + z) * NY + y) * NX + x;
    for (int a = 0; a < 3; a++) {
        double p = 0.5 * (extent[a] - 0.5 * n[a]) + 0.5 * (c[a] + 0.5);
        v[a] = camera->orthographic ? -camera->forward[a] : camera->origin[a] - p;
        length += v[a] * v[a];
    }
    for (int a = 0; a < 3; a++) {
        flux += v[a] / sqrt(length) * moments[4 * i + 1 + a];
    }
    return fmax(0, moments[4 * i] + 3 * cells[4 * i + 2] * flux) / (4 * 3.14159265358979);
}

// Along each axis outside: 2 J_0 - J_1.
static double outside(const float *cells, const float *moments, const struct camera_block *camera,
                      int x, int y, int z, int ch)
{
    int c[3] = {x, y, z};
    const int n[3] = {NX, NY, NZ};
    for (int a = 0; a < 3; a++) {
        int inward = c[a] < 0 ? 1 : c[a] >= n[a] ? -1 : 0;
        if (inward) {
            int near[3] = {c[0], c[1], c[2]}, far[3] = {c[0], c[1], c[2]};
            near[a] += inward;
            far[a] += 2 * inward;
            return 2 * outside(cells, moments, camera, near[0], near[1], near[2], ch) -
                   outside(cells, moments, camera, far[0], far[1], far[2], ch);
        }
    }
    return inside(cells, moments, camera, x, y, z, ch);
}

static void against_cpu(void **state)
{
    gpu_test *t = *state;
    float cells[3 * CELLS * 4], moments[3 * CELLS * 4];
    uint32_t seed = 7;
    for (int i = 0; i < 3 * CELLS * 4; i++) {
        cells[i] = random_01(&seed);
        moments[i] = i % 4 ? 2 * random_01(&seed) - 1 : random_01(&seed);
    }
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        for (uint32_t channels = 1; channels <= 3; channels += 2) {
            const struct medium_block medium = {.extent = {extent[0], extent[1], extent[2]}};
            const struct camera_block camera = {.origin = {0.7f, 3, -1},
                                                .orthographic = (uint32_t)orthographic,
                                                .forward = {0.6f, 0, 0.8f}};
            const tyn_merge_params params = {.channels = channels};
            tyn_extent texels = {NX, NY, NZ * channels};
            tyn_graph_begin(t->graph);
            tyn_ref refs[TYN_MAX_PORTS] = {
                [MERGE_PORT_MEDIUM] = gpu_buffer(t, "medium", &medium, sizeof medium),
                [MERGE_PORT_CAMERA] = gpu_buffer(t, "camera", &camera, sizeof camera),
                [MERGE_PORT_CELLS] = gpu_image(t, "cells", TYN_IMAGE_3D, texels, 4, cells),
                [MERGE_PORT_MOMENTS] = gpu_image(t, "moments", TYN_IMAGE_3D, texels, 4, moments),
            };
            assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_merge, &params, refs), TYN_OK);
            tyn_graph_output(t->graph, "inscatter", refs[MERGE_PORT_INSCATTER], true);
            gpu_run(t);
            const float *j = gpu_map(t, "inscatter");
            for (int i = 0; i < (NX + 2) * (NY + 2) * (NZ + 2); i++) {
                int x = i % (NX + 2) - 1, y = i / (NX + 2) % (NY + 2) - 1;
                int z = i / (NX + 2) / (NY + 2) - 1;
                for (int ch = 0; ch < (int)channels; ch++) {
                    double expected = fmax(0, outside(cells, moments, &camera, x, y, z, ch));
                    assert_true(fabs(j[(channels == 1 ? 1 : 4) * i + ch] - expected) < 1e-5);
                }
            }
        }
    }
}

// ---- with ordinates -----------------------------------------------------------------------------

enum { COUNT = 20 };

typedef struct ordinates_case {
    const char *name;
    uint32_t mode, channels, grey;
    float sigma_s[3], sigma_a[3], g[3], tint[3];
    double tolerance; // of the largest J
} ordinates_case;

static void random_ordinates(struct ordinates_block *block, uint32_t *seed)
{
    *block = (struct ordinates_block){.count = COUNT};
    for (int n = 0; n < COUNT; n++) {
        struct ordinate *o = &block->list[n];
        float z = 2 * random_01(seed) - 1, phi = 6.2831853f * random_01(seed);
        o->direction[0] = sqrtf(1 - z * z) * cosf(phi);
        o->direction[1] = sqrtf(1 - z * z) * sinf(phi);
        o->direction[2] = z;
        // Of the sizes that the table has, so that the exact cone may be compared.
        double s = floor(12 * random_01(seed)) / (TYN_TMS_CONES - 1);
        o->solid_angle = (float)(12.566370614 * s * s);
        o->mean_cosine = (float)(1 - s * s);
        for (int ch = 0; ch < 3; ch++) {
            o->irradiance[ch] = 3 * random_01(seed) - 1;
        }
    }
    block->list[COUNT].irradiance[0] = INFINITY; // not in use: never read
}

// Column densities, or depths that are consistent with one g.
static void random_columns(const ordinates_case *k, uint16_t *halves, uint32_t components,
                           uint32_t *seed)
{
    const uint32_t padded = (NX + 1) & ~1u, plane = padded * NY * NZ;
    for (uint32_t n = 0; n < COUNT; n++) {
        for (uint32_t i = 0; i < plane; i++) {
            float density = 4 * random_01(seed);
            for (uint32_t c = 0; c < components; c++) {
                uint32_t ch = c % 3;
                float f = k->g[ch] > 0 ? k->g[ch] * k->g[ch] : 0;
                float value = components == 1 ? density
                              : c < 3         ? density * k->sigma_s[ch]
                              : c < 6         ? density * k->sigma_a[ch]
                                              : density * k->sigma_s[ch] * (1 - f);
                halves[(n * components + c) * plane + i] = tyn_half_from_float(sqrtf(value));
            }
        }
    }
}

// The value at a cell as it is stored.
static double column_at(const uint16_t *halves, uint32_t components, uint32_t n, uint32_t c, int x,
                        int y, int z)
{
    const uint32_t padded = (NX + 1) & ~1u;
    double root = tyn_half_to_float(halves[((n * components + c) * NZ + (uint32_t)z) * NY * padded +
                                           (uint32_t)y * padded + (uint32_t)x]);
    return root * root;
}

typedef struct twin {
    double j[3][CELLS]; // before the clamp
    double largest;
} twin;

static void make_twin(twin *w, const ordinates_case *k, const struct ordinates_block *ordinates,
                      const uint16_t *halves, const struct camera_block *camera, const float *cells,
                      const float *moments)
{
    static lobe_series series[3];
    static double c[COUNT][LOBE_TERMS];
    uint32_t components = k->mode == TYN_MEDIUM_DENSITY ? 1 : COLUMNS_COMPONENTS;
    for (int ch = 0; ch < 3; ch++) {
        lobe_series_make(&series[ch], k->g[ch]);
    }
    for (int n = 0; n < COUNT; n++) {
        lobe_cone(1 - ordinates->list[n].mean_cosine, LOBE_TERMS, c[n]);
    }
    *w = (twin){.largest = 0};
    for (int i = 0; i < CELLS; i++) {
        int x = i % NX, y = i / NX % NY, z = i / NX / NY;
        const int at[3] = {x, y, z}, size[3] = {NX, NY, NZ};
        double v[3], length = 0, sums[3] = {0, 0, 0};
        for (int a = 0; a < 3; a++) {
            double p = 0.5 * (extent[a] - 0.5 * size[a]) + 0.5 * (at[a] + 0.5);
            v[a] = camera->orthographic ? -camera->forward[a] : camera->origin[a] - p;
            length += v[a] * v[a];
        }
        for (int a = 0; a < 3; a++) {
            v[a] /= sqrt(length);
        }
        for (uint32_t n = 0; x < 3 && n < COUNT; n++) { // medium at x < 2
            const struct ordinate *o = &ordinates->list[n];
            double mu = 0;
            for (int a = 0; a < 3; a++) {
                mu += v[a] * o->direction[a];
            }
            for (uint32_t ch = 0; ch < 3; ch++) {
                double column = column_at(halves, components, n, 0, x, y, z);
                double tau_s = column * k->sigma_s[ch], tau_a = column * k->sigma_a[ch];
                if (components > 1) {
                    tau_s = column_at(halves, components, n, ch, x, y, z);
                    tau_a = column_at(halves, components, n, 3 + ch, x, y, z);
                }
                double f = series[ch].f, t = exp(-tau_a - tau_s * (1 - f));
                sums[ch] += o->irradiance[ch] * t * lobe_kernel(&series[ch], c[n], tau_s, mu);
            }
        }
        double dot = 0, norm = 0;
        for (int ch = 0; ch < 3; ch++) {
            dot += sums[ch] * k->tint[ch];
            norm += k->tint[ch] * k->tint[ch];
        }
        for (int ch = 0; ch < (int)k->channels; ch++) {
            int texel = (ch * NZ + z) * NY * NX + y * NX + x;
            double flux = 0;
            for (int a = 0; a < 3; a++) {
                flux += v[a] * moments[4 * texel + 1 + a];
            }
            w->j[ch][i] = (moments[4 * texel] + 3 * cells[4 * texel + 2] * flux) / 12.566370614 +
                          (k->channels == 1 ? dot / norm : sums[ch]);
            w->largest = fmax(w->largest, w->j[ch][i]);
        }
    }
}

static double clamped_at(const twin *w, const int c[3], int ch)
{
    return fmax(w->j[ch][(c[2] * NY + c[1]) * NX + c[0]], 0);
}

// What is blended towards c from the cells before it: 2 J_0 - J_1 along each axis outside.
static double continued(const twin *w, const int c[3], int ch)
{
    const int n[3] = {NX, NY, NZ};
    for (int a = 0; a < 3; a++) {
        const int inward = c[a] < 0 ? 1 : c[a] >= n[a] ? -1 : 0;
        if (inward) {
            int near[3] = {c[0], c[1], c[2]}, far[3] = {c[0], c[1], c[2]};
            near[a] += inward;
            far[a] += 2 * inward;
            return 2 * continued(w, near, ch) - continued(w, far, ch);
        }
    }
    return clamped_at(w, c, ch);
}

static double sum_of(const struct light_clamp *clamp, uint32_t first)
{
    double all = 0;
    for (int k = 0; k < TYN_LIGHT_SUM_BINS; k++) {
        all += ldexp(clamp->bins[first + (uint32_t)k], k - 135);
    }
    return all;
}

// Light that was set to 0, and of some rows that which was not: sigma_s' J over the square of the distance in cells, of a
// ghost an eighth along each axis. All cells are in the picture.
static void check_hidden(const twin *w, const ordinates_case *k, const struct camera_block *camera,
                         const float *cells, const struct counters_block *counters)
{
    const int n[3] = {NX, NY, NZ};
    double hidden = 0, shown = 0;
    uint32_t ghosts = 0;
    for (int i = 0; i < (NX + 2) * (NY + 2) * (NZ + 2); i++) {
        const int c[3] = {i % (NX + 2) - 1, i / (NX + 2) % (NY + 2) - 1,
                          i / (NX + 2) / (NY + 2) - 1};
        int near[3];
        double away = 0, part = 1, below = 0, above = 0;
        for (int a = 0; a < 3; a++) {
            near[a] = c[a] < 0 ? 0 : c[a] >= n[a] ? n[a] - 1 : c[a];
            part *= near[a] == c[a] ? 1 : 0.125;
            const double d =
                0.5 * (extent[a] - 0.5 * n[a]) + 0.5 * (near[a] + 0.5) - camera->origin[a];
            away += 4 * d * d;
        }
        const int cell = (near[2] * NY + near[1]) * NX + near[0];
        bool clamped = false, scatters = false;
        for (int ch = 0; ch < (int)k->channels; ch++) {
            const double sigma = cells[4 * (ch * CELLS + cell)];
            const double j = part < 1 ? continued(w, c, ch) : w->j[ch][cell];
            clamped = clamped || j < 0;
            scatters = scatters || sigma > 0;
            below += sigma * fmax(-j, 0);
            above += sigma * fmax(j, 0);
        }
        const double weight = camera->orthographic ? 1 : 1 / fmax(away, 1);
        hidden += part * weight * below;
        shown += part == 1 && (c[1] + 3 * c[2]) % 8 == 0 ? 8 * weight * above : 0;
        ghosts += part < 1 && clamped && scatters;
    }
    printf("    hidden %.4g, right %.4g; shown %.4g, right %.4g; %u ghosts, right %u\n",
           sum_of(&counters->clamp_0, TYN_LIGHT_HIDDEN), hidden,
           sum_of(&counters->clamp_0, TYN_LIGHT_SHOWN), shown, counters->ghosts, ghosts);
    assert_true(hidden > 0 &&
                fabs(sum_of(&counters->clamp_0, TYN_LIGHT_HIDDEN) / hidden - 1) < 0.02);
    assert_true(fabs(sum_of(&counters->clamp_0, TYN_LIGHT_SHOWN) / shown - 1) < 0.02);
    assert_true(ghosts > 0 && abs((int)ghosts - (int)counters->ghosts) <= 2);
}

static void with_ordinates(void **state)
{
    gpu_test *t = *state;
    static const ordinates_case cases[] = {
        {"one channel",
         TYN_MEDIUM_DENSITY,
         1,
         1,
         {.9f, .9f, .9f},
         {.1f, .1f, .1f},
         {.7f, .7f, .7f},
         {1, .6f, .3f},
         0.003},
        {"grey", TYN_MEDIUM_DENSITY, 3, 1, {2, 2, 2}, {0, 0, 0}, {.9f, .9f, .9f}, {1, 1, 1}, 0.003},
        {"coloured",
         TYN_MEDIUM_DENSITY,
         3,
         0,
         {.5f, 1, 2},
         {.4f, 0, .1f},
         {.3f, .95f, -.5f},
         {1, 1, 1},
         0.003},
        {"coefficients",
         TYN_MEDIUM_COEFFICIENTS,
         3,
         0,
         {.5f, 1, 2},
         {.4f, 0, .1f},
         {.3f, .8f, 0},
         {1, 1, 1},
         0.003},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const ordinates_case *k = &cases[i];
        uint32_t seed = 5 + (uint32_t)i;
        static float cells[3 * CELLS * 4], moments[3 * CELLS * 4];
        for (int c = 0; c < 3 * CELLS; c++) {
            float g = k->g[c / CELLS];
            cells[4 * c] = c % NX < 2 ? random_01(&seed) : 0;
            cells[4 * c + 2] = g > 0 ? g / (1 + g) : g;
            for (int a = 0; a < 4; a++) {
                moments[4 * c + a] = a ? random_01(&seed) - 0.5f : random_01(&seed);
            }
        }
        static struct ordinates_block ordinates;
        random_ordinates(&ordinates, &seed);
        uint32_t components = k->mode == TYN_MEDIUM_DENSITY ? 1 : COLUMNS_COMPONENTS;
        static uint16_t halves[COUNT * COLUMNS_COMPONENTS * ((NX + 1) & ~1) * NY * NZ];
        random_columns(k, halves, components, &seed);
        struct medium_block medium = {.extent = {extent[0], extent[1], extent[2]}};
        memcpy(medium.sigma_s, k->sigma_s, sizeof medium.sigma_s);
        memcpy(medium.sigma_a, k->sigma_a, sizeof medium.sigma_a);
        for (int c = 0; c < 3; c++) {
            medium.phase[c].g = k->g[c];
        }
        const struct camera_block camera = {
            .origin = {0.7f, 3, -1}, .orthographic = i == 1, .forward = {0.6f, 0, 0.8f}};
        const tyn_scatter_lut_params lut_params = {
            .mode = k->mode,
            .phase = {{.g = k->g[0]}, {.g = k->g[1]}, {.g = k->g[2]}},
            .g_max = 0.8f,
            .tms = 1};
        const tyn_merge_params params = {.channels = k->channels,
                                         .tint = {k->tint[0], k->tint[1], k->tint[2]},
                                         .mode = k->mode,
                                         .grey = k->grey};

        tyn_extent texels = {NX, NY, NZ * k->channels};
        tyn_graph_begin(t->graph);
        tyn_ref lut[SCATTER_LUT_NUM_PORTS] = {{0}};
        assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_scatter_lut, &lut_params, lut), TYN_OK);
        tyn_ref refs[TYN_MAX_PORTS] = {
            [MERGE_PORT_MEDIUM] = gpu_buffer(t, "medium", &medium, sizeof medium),
            [MERGE_PORT_CAMERA] = gpu_buffer(t, "camera", &camera, sizeof camera),
            [MERGE_PORT_CELLS] = gpu_image(t, "cells", TYN_IMAGE_3D, texels, 4, cells),
            [MERGE_PORT_MOMENTS] = gpu_image(t, "moments", TYN_IMAGE_3D, texels, 4, moments),
            [MERGE_PORT_ORDINATES] = gpu_buffer(t, "ordinates", &ordinates, sizeof ordinates),
            [MERGE_PORT_COLUMNS] = gpu_buffer(t, "columns", halves, sizeof halves),
            [MERGE_PORT_TMS] = lut[SCATTER_LUT_PORT_TMS],
            [MERGE_PORT_LUT_BLOCK] = lut[SCATTER_LUT_PORT_LUT_BLOCK],
        };
        assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_merge, &params, refs), TYN_OK);
        tyn_graph_output(t->graph, "inscatter", refs[MERGE_PORT_INSCATTER], true);
        tyn_graph_output(t->graph, "counters", refs[MERGE_PORT_COUNTERS], true);
        gpu_run(t);

        static twin w;
        make_twin(&w, k, &ordinates, halves, &camera, cells, moments);
        const float *got = gpu_map(t, "inscatter");
        double worst = 0;
        uint32_t negative = 0;
        for (int c = 0; c < CELLS; c++) {
            int x = c % NX + 1, y = c / NX % NY + 1, z = c / NX / NY + 1;
            bool clamped = false;
            for (int ch = 0; ch < (int)k->channels; ch++) {
                int texel = (z * (NY + 2) + y) * (NX + 2) + x;
                double value = got[(k->channels == 1 ? 1 : 4) * texel + ch];
                worst = maximum(worst, fabs(value - fmax(w.j[ch][c], 0)) / w.largest);
                clamped = clamped || (w.j[ch][c] < 0 && x <= 2);
                assert_true(value == value);
            }
            negative += clamped;
        }
        const struct counters_block *counters = gpu_map(t, "counters");
        printf("%s: largest error %.3f %% of the largest J; %u cells below 0\n", k->name,
               100 * worst, counters->clamped);
        assert_true(within(worst, k->tolerance, BOUND_FILTER, "%s", k->name));
        assert_true(abs((int)negative - (int)counters->clamped) <= 1);
        check_hidden(&w, k, &camera, cells, counters);
        assert_int_equal(counters->non_finite, 0);
    }
}

// Columns or kernels without ordinates are an error of whoever declares the graph.
static void refuses_half_the_ports(void **state)
{
    gpu_test *t = *state;
    float zeros[8] = {0};
    const tyn_merge_params params = {.channels = 1};
    tyn_graph_begin(t->graph);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [MERGE_PORT_MEDIUM] = gpu_buffer(t, "medium", zeros, sizeof zeros),
        [MERGE_PORT_CAMERA] = gpu_buffer(t, "camera", zeros, sizeof zeros),
        [MERGE_PORT_CELLS] = gpu_image(t, "cells", TYN_IMAGE_3D, (tyn_extent){2, 1, 1}, 4, zeros),
        [MERGE_PORT_MOMENTS] =
            gpu_image(t, "moments", TYN_IMAGE_3D, (tyn_extent){2, 1, 1}, 4, zeros),
        [MERGE_PORT_COLUMNS] = gpu_buffer(t, "columns", zeros, sizeof zeros),
    };
    t->quiet = true;
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_merge, &params, refs), TYN_ERR_PARAMS);
    t->quiet = false;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(against_cpu),
        cmocka_unit_test(with_ordinates),
        cmocka_unit_test(refuses_half_the_ports),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
