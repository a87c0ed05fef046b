// lattice_ordinates.c -- light of principal ordinates on the lattice, in probes and in the balance.
#include "bound.h"
#include "light_chain.h"
#include "base/half.h"
#include "shaders/beams/columns_args.h"
#include "passes/lattice_ordinates/lattice_ordinates.h"
#include "numbers.h"
#include "random_unit.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Even over the sphere (Fibonacci's spiral), each with its share of it.
static struct ordinates_block sphere(uint32_t count)
{
    struct ordinates_block block = {.count = count};
    for (uint32_t n = 0; n < count; n++) {
        double z = 1 - (2 * n + 1.0) / count, r = sqrt(1 - z * z), angle = n * 2.399963229728653;
        struct ordinate *o = &block.list[n];
        o->direction[0] = (float)(r * cos(angle));
        o->direction[1] = (float)z;
        o->direction[2] = (float)(r * sin(angle));
        o->solid_angle = (float)(4 * M_PI / count);
        o->mean_cosine = (float)(1 - 1.0 / count);
    }
    return block;
}

// ---- the pass against its formula in double precision --------------------------------------------

enum { NX = 7, NY = 5, NZ = 6, CELLS = NX * NY * NZ, ROW = (NX + 1) / 2 * 2 };

typedef struct twin {
    uint32_t mode, channels, num_components, count;
    float extent[3], tint[3], sigma_s[3], sigma_a[3], g[3];
    float cells[3][CELLS][4], sunlight[3][CELLS][4];
    float *columns; // [ordinate][component][cell]
    struct ordinates_block ordinates;
} twin;

static double clamped_scattering(const twin *w, int c)
{
    return w->sigma_s[c] * fmin(1, (1 - w->g[c]) / 0.005);
}

// Depth of an ordinate to a cell in a channel.
static double depth(const twin *w, uint32_t n, uint32_t ch, int cell)
{
    const float *c = &w->columns[(size_t)n * w->num_components * CELLS + (size_t)cell];
    double g = fmin(w->g[ch], 0.995);
    return w->num_components > 1 ? c[(3 + ch) * CELLS] + c[(6 + ch) * CELLS]
                                 : c[0] * (w->sigma_a[ch] + clamped_scattering(w, (int)ch) *
                                                                (1 - (g > 0 ? g * g : 0)));
}

static void expected(const twin *w, uint32_t ch, int cell, double sum[4])
{
    static const int size[3] = {NX, NY, NZ}, stride[3] = {1, NX, NX * NY};
    const int at[3] = {cell % NX, cell / NX % NY, cell / NX / NY};
    double dx = w->extent[0] / NX;
    for (int k = 0; k < 4; k++) {
        sum[k] = w->sunlight[ch][cell][k];
    }
    for (uint32_t n = 0; n < w->ordinates.count; n++) {
        const struct ordinate *o = &w->ordinates.list[n];
        const float *d = o->direction, *e = o->irradiance, *t = w->tint;
        double tau = depth(w, n, ch, cell), squares = 0, least = 1e9;
        bool enters = false;
        for (int a = 0; a < 3; a++) {
            // The other cell of a pair; of the last one without, the one before along y and z.
            int other = at[a] ^ 1;
            other = other < size[a] ? other : a == 0 ? at[a] : at[a] - 1;
            squares += pow(depth(w, n, ch, cell + (other - at[a]) * stride[a]) - tau, 2);
            int layer = d[a] < 0 ? size[a] - 1 - at[a] : at[a];
            double way = (layer + 0.5) / fabs(d[a]);
            enters = way < least ? layer == 0 : enters;
            least = minimum(least, way);
        }
        double own = dx * (w->cells[ch][cell][0] + w->cells[ch][cell][1]);
        tau = fmax(tau, 0.5 * own);
        double x = enters ? tau : fmin(fmax(0.5 * sqrt(squares), 0.5 * own), tau);
        double light = exp(-tau) * (x > 1e-6 ? sinh(x) / x : 1);
        light *= w->channels == 1 ? (e[0] * t[0] + e[1] * t[1] + e[2] * t[2]) /
                                        (t[0] * t[0] + t[1] * t[1] + t[2] * t[2])
                                  : e[ch];
        sum[0] += light;
        for (int k = 0; k < 3; k++) {
            sum[k + 1] += o->mean_cosine * d[k] * light;
        }
    }
}

static void fill(twin *w, bool coefficients, uint32_t channels, bool sunlight)
{
    uint32_t seed = 4;
    memset(w, 0, sizeof *w);
    w->mode = coefficients ? TYN_MEDIUM_COEFFICIENTS : TYN_MEDIUM_DENSITY;
    w->channels = channels;
    w->num_components = coefficients ? COLUMNS_COMPONENTS : 1;
    w->count = 40;
    w->ordinates = sphere(33); // fewer than there is room for
    float extent[3] = {NX * 0.2f, NY * 0.2f, NZ * 0.2f};
    for (int c = 0; c < 3; c++) {
        w->extent[c] = extent[c];
        w->tint[c] = channels == 1 ? 1 / (float)(c + 1) : 1;
        w->sigma_s[c] = channels == 1 ? 3 : 2 + (float)c;
        w->sigma_a[c] = channels == 1 ? 0.5f : 0.3f * (float)c;
        w->g[c] = channels == 1 ? 0.6f : (float[]){-0.4f, 0.8f, 0.999f}[c];
    }
    for (uint32_t n = 0; n < w->ordinates.count; n++) {
        for (int c = 0; c < 3; c++) {
            w->ordinates.list[n].irradiance[c] = (float)(random_unit(&seed) - 0.4);
        }
    }
    for (uint32_t ch = 0; ch < 3; ch++) {
        for (int i = 0; i < CELLS; i++) {
            for (int k = 0; k < 4; k++) {
                w->cells[ch][i][k] = (float)(3 * random_unit(&seed));
                w->sunlight[ch][i][k] = sunlight ? (float)random_unit(&seed) : 0;
            }
        }
    }
    size_t values = (size_t)w->count * w->num_components * CELLS;
    w->columns = malloc(values * sizeof *w->columns);
    for (size_t i = 0; i < values; i++) {
        // What a half's square holds; now and then the centre of a thick cell is in the open.
        float root = tyn_half_to_float(
            tyn_half_from_float((float)((i % 7 ? 1.2 : 0.01) * (1 + random_unit(&seed)))));
        w->columns[i] = root * root;
    }
}

static void upload(gpu_test *t, const twin *w, bool sunlight, tyn_ref *refs)
{
    struct medium_block medium = {.mode = w->mode, .max_density = 1};
    for (int c = 0; c < 3; c++) {
        medium.extent[c] = w->extent[c];
        medium.size[c] = 1;
        medium.sigma_s[c] = w->sigma_s[c];
        medium.sigma_a[c] = w->sigma_a[c];
        medium.phase[c].g = w->g[c];
    }
    size_t planes = (size_t)w->count * w->num_components * NY * NZ;
    uint16_t *halves = calloc(planes * ROW, sizeof *halves);
    for (size_t i = 0; i < planes * NX; i++) {
        halves[i / NX * ROW + i % NX] = tyn_half_from_float(sqrtf(w->columns[i]));
    }
    tyn_extent texels = {NX, NY, NZ * w->channels};
    refs[LATTICE_ORDINATES_PORT_MEDIUM] = gpu_buffer(t, "medium", &medium, sizeof medium);
    refs[LATTICE_ORDINATES_PORT_ORDINATES] =
        gpu_buffer(t, "ordinates", &w->ordinates, sizeof w->ordinates);
    refs[LATTICE_ORDINATES_PORT_COLUMNS] = gpu_buffer(t, "columns", halves, planes * ROW * 2);
    refs[LATTICE_ORDINATES_PORT_CELLS] =
        gpu_image(t, "cells", TYN_IMAGE_3D, texels, 4, w->cells[0][0]);
    if (sunlight) {
        refs[LATTICE_ORDINATES_PORT_SUNLIGHT] =
            gpu_image(t, "sunlight", TYN_IMAGE_3D, texels, 4, w->sunlight[0][0]);
    }
    free(halves);
}

static void matches_twin(void **state)
{
    gpu_test *t = *state;
    static twin w;
    for (int variant = 0; variant < 5; variant++) {
        bool coefficients = variant == 2, sunlight = variant % 2;
        uint32_t channels = variant == 0 || variant == 3 ? 1 : 3;
        fill(&w, coefficients, channels, sunlight);
        tyn_lattice_ordinates_params params = {
            .shape = {.cells = NX, .channels = channels},
            .mode = w.mode,
            .grey = channels == 1,
            .count = w.count,
        };
        memcpy(params.shape.extent, w.extent, sizeof w.extent);
        memcpy(params.shape.tint, w.tint, sizeof w.tint);
        tyn_graph_begin(t->graph);
        tyn_ref refs[TYN_MAX_PORTS] = {{0}};
        upload(t, &w, sunlight, refs);
        assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_lattice_ordinates, &params, refs),
                         TYN_OK);
        tyn_graph_output(t->graph, "source", refs[LATTICE_ORDINATES_PORT_SOURCE], true);
        gpu_run(t);
        const float *got = gpu_map(t, "source");
        double worst = 0;
        for (uint32_t ch = 0; ch < channels; ch++) {
            for (int i = 0; i < CELLS; i++) {
                double want[4];
                expected(&w, ch, i, want);
                for (int k = 0; k < 4; k++) {
                    double wrong =
                        fabs(got[(ch * CELLS + (uint32_t)i) * 4 + (uint32_t)k] - want[k]);
                    worst = maximum(worst, wrong);
                }
            }
        }
        printf("variant %d: worst difference %.1e\n", variant, worst);
        assert_true(worst < 1e-4);
        free(w.columns);
    }
}

// ---- the chain -----------------------------------------------------------------------------------

static light_chain cube(float sigma_s, float sigma_a, float g, struct ordinates_block *ordinates)
{
    light_chain c = {
        .extent = {1, 1, 1}, .cells = 24, .cycles = -1, .channels = 3, .ordinates = ordinates};
    for (int k = 0; k < 3; k++) {
        c.sigma_s[k] = sigma_s;
        c.sigma_a[k] = sigma_a;
        c.g[k] = g;
    }
    return c;
}

// Distance that light has gone within the unit cube.
static double way(const float p[3], const float d[3])
{
    double length = 1e9;
    for (int a = 0; a < 3; a++) {
        length = d[a] > 0   ? fmin(length, p[a] / d[a])
                 : d[a] < 0 ? fmin(length, (p[a] - 1) / d[a])
                            : length;
    }
    return length;
}

// Without scattering the fluence is the sum of E e^-tau, the flux that along each ordinate; nothing has
// scattered.
static void absorption_only(void **state)
{
    static const float points[][3] = {{.5f, .5f, .5f}, {.11f, .8f, .3f}, {.98f, .04f, .6f}};
    struct ordinates_block ordinates = sphere(50);
    uint32_t seed = 2;
    for (uint32_t n = 0; n < 50; n++) {
        for (int c = 0; c < 3; c++) {
            ordinates.list[n].irradiance[c] = (float)random_unit(&seed);
        }
    }
    for (int scattered = 0; scattered < 2; scattered++) {
        light_chain c = cube(0, 2, 0, &ordinates);
        c.points = points;
        c.num_points = 3;
        c.scattered_only = scattered;
        light_chain_run(*state, &c);
        for (int i = 0; i < 3; i++) {
            double want[4] = {0};
            for (uint32_t n = 0; n < 50; n++) {
                const struct ordinate *o = &ordinates.list[n];
                double e =
                    scattered ? 0 : o->irradiance[1] * exp(-2 * way(points[i], o->direction));
                want[0] += e;
                for (int a = 0; a < 3; a++) {
                    want[a + 1] += e * o->mean_cosine * o->direction[a];
                }
            }
            printf("fluence %.4f, expected %.4f\n", c.results[i].fluence[1], want[0]);
            assert_within(fabs(c.results[i].fluence[1] - want[0]), 0.01 * want[0] + 1e-6, NULL);
            for (int a = 0; a < 3; a++) {
                assert_true(fabs(c.results[i].flux[3 * a + 1] - want[a + 1]) <
                            0.01 * want[0] + 1e-6);
            }
        }
        assert_true(fabs(c.balance.imbalance[0]) < 1e-5);
        light_chain_finish(&c);
    }
}

// A sky of mean 1 and of a rest that is positive here and negative there, with and without a sun: what
// enters is absorbed or escapes.
static void balances(void **state)
{
    static const float media[][3] = {{4, 0, 0}, {4, 1, 0.6f}, {12, 0.1f, 0.85f}, {30, 0, 0.5f}};
    static float density[16 * 16 * 16];
    uint32_t seed = 1;
    for (int i = 0; i < 16 * 16 * 16; i++) {
        density[i] = random_unit(&seed) < 0.5 ? 0 : (float)random_unit(&seed);
    }
    struct ordinates_block ordinates = sphere(40);
    for (uint32_t n = 0; n < 40; n++) {
        float *d = ordinates.list[n].direction, *e = ordinates.list[n].irradiance;
        e[0] = 0.3f * (d[1] < -0.8f ? 2 : -0.1f);
        e[1] = -0.25f * d[1];
        e[2] = (float)(0.3 * random_unit(&seed) - 0.15);
    }
    for (size_t m = 0; m < 2 * sizeof media / sizeof media[0]; m++) {
        const float *medium = media[m / 2];
        light_chain c = cube(medium[0], medium[1], medium[2], &ordinates);
        c.sweeps = 6;
        c.density = m % 2 ? density : NULL;
        c.size = m % 2 ? (tyn_extent){16, 16, 16} : (tyn_extent){1, 1, 1};
        if (m % 4 == 1) {
            c.num_suns = 1;
            c.sun_direction[0][1] = -1;
            c.sun_color[0][0] = c.sun_color[0][2] = 1;
        }
        c.environment[0] = c.environment[1] = c.environment[2] = 1;
        light_chain_run(*state, &c);
        for (int ch = 0; ch < 3; ch++) {
            const tyn_balance *b = &c.balance;
            printf(
                "sigma_s %g, %s, channel %d: entering %.4f, absorbed %.4f, escaped %.4f, imbalance "
                "%.1e\n",
                medium[0], m % 2 ? "grid" : "even", ch, b->entering[ch], b->absorbed_media[ch],
                b->escaped[ch], b->imbalance[ch]);
            // One channel of the densest medium is solved less well; the others are to rounding.
            const double left = fabs(b->imbalance[ch]);
            assert_true(m == 6 && ch == 0 ? within(left, 3e-4, NULL, "imbalance, sigma_s 30")
                                          : left <= 4e-5);
            double entering = 6 * M_PI; // from all sides; the sun's is its colour
            entering += c.num_suns ? c.sun_color[0][ch] : 0;
            for (uint32_t n = 0; n < ordinates.count; n++) {
                const float *d = ordinates.list[n].direction;
                entering +=
                    ordinates.list[n].irradiance[ch] * (fabs(d[0]) + fabs(d[1]) + fabs(d[2]));
            }
            assert_true(fabs(b->entering[ch] / entering - 1) < 1e-4);
        }
        light_chain_finish(&c);
    }
}

// The cells lose what light loses on its way through the cube: E (1 - e^-tau) over the faces where it
// leaves.
static void loses_what_is_lost(void **state)
{
    static const float sigmas[] = {0.5f, 4, 12, 40};
    struct ordinates_block ordinates = sphere(32);
    for (uint32_t n = 0; n < 32; n++) {
        for (int c = 0; c < 3; c++) {
            ordinates.list[n].irradiance[c] = 1;
        }
    }
    for (size_t s = 0; s < sizeof sigmas / sizeof sigmas[0]; s++) {
        light_chain c = cube(sigmas[s], 0, 0, &ordinates);
        light_chain_run(*state, &c);
        double collided = 0, lost = 0;
        for (int i = 0; i < 24 * 24 * 24; i++) {
            collided += sigmas[s] * c.source[4 * i] / (24.0 * 24 * 24);
        }
        enum { F = 100 };
        for (uint32_t n = 0; n < 32; n++) {
            const float *d = ordinates.list[n].direction;
            for (int i = 0; i < 3 * F * F; i++) {
                float p[3];
                int a = i / (F * F);
                p[a] = d[a] > 0 ? 1 : 0;
                p[(a + 1) % 3] = ((float)(i % F) + 0.5f) / F;
                p[(a + 2) % 3] = ((float)(i / F % F) + 0.5f) / F;
                lost += fabs(d[a]) * -expm1(-sigmas[s] * way(p, d)) / (F * F);
            }
        }
        printf("sigma %g, %.2f a cell: lost %.4f, collided %+.2f %%\n", sigmas[s], sigmas[s] / 24,
               lost, 100 * (collided / lost - 1));
        assert_true(fabs(collided / lost - 1) < (sigmas[s] < 20 ? 0.004 : 0.015));
        light_chain_finish(&c);
    }
}

// Surroundings of 1 that come along ordinates alone, not from all sides: the medium that only scatters
// is nearly invisible still, 4 pi in every point.
static void furnace_of_ordinates(void **state)
{
    static float points[512][3];
    for (int i = 0; i < 512; i++) {
        for (int a = 0; a < 3; a++) {
            points[i][a] = ((float)(i >> 3 * a & 7) + 0.5f) / 8;
        }
    }
    struct ordinates_block ordinates = sphere(64);
    for (uint32_t n = 0; n < 64; n++) {
        for (int c = 0; c < 3; c++) {
            ordinates.list[n].irradiance[c] = ordinates.list[n].solid_angle;
        }
    }
    static const float media[][2] = {{4, 0}, {12, 0}, {12, 0.5f}, {40, 0.9f}};
    for (size_t m = 0; m < sizeof media / sizeof media[0]; m++) {
        light_chain c = cube(media[m][0], 0, media[m][1], &ordinates);
        c.sweeps = 6;
        c.points = (const float(*)[3])points;
        c.num_points = 512;
        light_chain_run(*state, &c);
        double mean = 0, worst = 0;
        for (int i = 0; i < 512; i++) {
            double ratio = c.results[i].fluence[0] / (4 * M_PI);
            mean += ratio / 512;
            worst = maximum(worst, fabs(ratio - 1));
        }
        printf("sigma_s %g, g %g: fluence of 4 pi: mean %+.2f %%, worst %.2f %%\n", media[m][0],
               media[m][1], 100 * (mean - 1), 100 * worst);
        assert_within(fabs(mean - 1), 0.012, NULL);
        assert_within(worst, 0.07, NULL);
        light_chain_finish(&c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matches_twin),
        cmocka_unit_test(absorption_only),
        cmocka_unit_test(balances),
        cmocka_unit_test(loses_what_is_lost),
        cmocka_unit_test(furnace_of_ordinates),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
