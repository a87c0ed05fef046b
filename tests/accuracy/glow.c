// glow.c -- media with grids of colours: what they emit by a grid, as black bodies, and their albedo.
//
// Where nothing scatters, a picture is an integral along rays, which is taken here in double precision. Where it does,
// `path` tells what the others miss.
#include "built_in.h"
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "path_run.h"
#include "picture.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- grids --------------------------------------------------------------------------------------

enum { NX = 14, NY = 18, NZ = 12, CX = 9, CY = 11, CZ = 13 }; // of the density; of colours

static const uint32_t density_size[3] = {NX, NY, NZ}, color_size[3] = {CX, CY, CZ};

static double blob(const double p[3], double x, double y, double z, double width)
{
    const double d[3] = {p[0] - x, p[1] - y, p[2] - z};
    return exp(-(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / (2 * width * width));
}

// p in [0, 1]^3.
static double density_at_centre(const double p[3], int channel)
{
    (void)channel;
    return blob(p, 0.5, 0.6, 0.5, 0.2) + 0.4 * blob(p, 0.3, 0.25, 0.6, 0.12);
}

static double glow_at_centre(const double p[3], int channel)
{
    return fmax(0, blob(p, 0.45 + 0.05 * channel, 0.3, 0.5, 0.15) - 0.05) * (1 + channel);
}

static double albedo_at_centre(const double p[3], int channel)
{
    return channel == 0 ? 0.2 + 0.7 * p[0] : channel == 1 ? 0.6 : 0.9 - 0.8 * p[1];
}

typedef double (*field)(const double p[3], int channel);

static float *fill(const uint32_t n[3], uint32_t channels, field f)
{
    float *data = malloc((size_t)n[0] * n[1] * n[2] * channels * sizeof *data), *out = data;
    for (uint32_t k = 0; k < n[2]; k++) {
        for (uint32_t j = 0; j < n[1]; j++) {
            for (uint32_t i = 0; i < n[0]; i++) {
                const double p[3] = {(i + 0.5) / n[0], (j + 0.5) / n[1], (k + 0.5) / n[2]};
                for (uint32_t c = 0; c < channels; c++) {
                    *out++ = (float)f(p, (int)c);
                }
            }
        }
    }
    return data;
}

// Trilinear between voxel centres, constant in the outer half voxel.
static double look_up(const uint32_t n[3], uint32_t channels, const float *data, const double p[3],
                      uint32_t channel)
{
    size_t lo[3], hi[3];
    double t[3], sum = 0;
    for (int a = 0; a < 3; a++) {
        const double x = fmin(fmax(p[a] * n[a] - 0.5, 0), n[a] - 1.0);
        lo[a] = (size_t)x;
        hi[a] = lo[a] + 1 < n[a] ? lo[a] + 1 : lo[a];
        t[a] = x - (double)lo[a];
    }
    for (int k = 0; k < 8; k++) {
        const size_t x = k & 1 ? hi[0] : lo[0], y = k & 2 ? hi[1] : lo[1],
                     z = k & 4 ? hi[2] : lo[2];
        sum += (k & 1 ? t[0] : 1 - t[0]) * (k & 2 ? t[1] : 1 - t[1]) * (k & 4 ? t[2] : 1 - t[2]) *
               (double)data[((z * n[1] + y) * n[0] + x) * channels + channel];
    }
    return sum;
}

// ---- scenes -------------------------------------------------------------------------------------

static const float box_lo[3] = {-0.5f, -0.7f, -0.4f}, box_hi[3] = {0.5f, 0.7f, 0.4f};

static uint32_t add_colors(tyn_scene *scene, uint32_t channels, field f)
{
    const uint32_t at = scene->num_color_grids++;
    scene->color_grids = realloc(scene->color_grids, (at + 1) * sizeof *scene->color_grids);
    tyn_color_grid *g = &scene->color_grids[at];
    *g = (tyn_color_grid){.size = {CX, CY, CZ}, .channels = channels, .hash = at + 77};
    g->data = fill(color_size, channels, f);
    for (uint32_t i = 0; i < CX * CY * CZ * channels; i++) {
        g->max = g->data[i] > g->max ? g->data[i] : g->max;
    }
    return at + 1;
}

typedef enum glow { NO_GLOW, BY_GRID, GREY_GRID, BLACK_BODY } glow;

static tyn_scene *make(float sigma_s, float sigma_a, glow kind, bool albedo)
{
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_scene_init(scene);
    const tyn_medium medium = grey_medium(sigma_s, sigma_a, 0.4f);
    float *grid = fill(density_size, 1, density_at_centre);
    scene_add_box(scene, &medium, box_lo, box_hi, density_size, grid);
    free(grid);
    tyn_medium *m = &scene->media[0];
    if (kind == BLACK_BODY) {
        m->radiance_grid = add_colors(scene, 3, glow_at_centre);
    } else if (kind != NO_GLOW) {
        m->emission_grid = add_colors(scene, kind == BY_GRID ? 3 : 1, glow_at_centre);
        m->emission[0] = 2, m->emission[1] = 1, m->emission[2] = 0.25f;
    }
    if (albedo) {
        m->albedo_grid = add_colors(scene, 3, albedo_at_centre);
    }
    return scene;
}

static void end(tyn_scene *scene)
{
    tyn_scene_finish(scene);
    free(scene);
}

// ---- closed form --------------------------------------------------------------------------------

typedef struct local {
    double sigma_s, sigma_a, emission;
} local;

static local medium_at(const tyn_scene *scene, const double p[3], uint32_t c)
{
    const tyn_medium *m = &scene->media[0];
    const double density = look_up(density_size, 1, scene->volumes[0].data, p, 0);
    local l = {density * m->sigma_s[c], density * m->sigma_a[c], density * m->emission[c]};
    const uint32_t slots[3] = {m->albedo_grid, m->emission_grid, m->radiance_grid};
    double value[3] = {0};
    for (int k = 0; k < 3; k++) {
        const tyn_color_grid *g = slots[k] ? &scene->color_grids[slots[k] - 1] : NULL;
        value[k] = g ? look_up(color_size, g->channels, g->data, p, g->channels == 3 ? c : 0) : 0;
    }
    if (slots[0]) {
        const double sigma_t = l.sigma_s + l.sigma_a;
        l.sigma_s = sigma_t * value[0];
        l.sigma_a = sigma_t - l.sigma_s;
    }
    if (slots[1]) {
        l.emission = m->emission[c] * value[1];
    }
    l.emission += l.sigma_a * value[2];
    return l;
}

// Mean over a pixel of what reaches the eye along -z of a medium that does not scatter.
static double pixel(const tyn_scene *scene, uint32_t x, uint32_t y, uint32_t size, uint32_t c)
{
    enum { SUB = 3, STEPS = 240 };
    const double half = 0.75, dz = (double)(box_hi[2] - box_lo[2]) / STEPS;
    double sum = 0;
    for (int s = 0; s < SUB * SUB; s++) {
        const double u = (2 * (x + (s % SUB + 0.5) / SUB) / size - 1) * half;
        const double v = (1 - 2 * (y + (s / SUB + 0.5) / SUB) / size) * half;
        const double at[2] = {(u - box_lo[0]) / (box_hi[0] - box_lo[0]),
                              (v - box_lo[1]) / (box_hi[1] - box_lo[1])};
        double left = 1;
        for (int i = 0; i < STEPS && at[0] > 0 && at[0] < 1 && at[1] > 0 && at[1] < 1; i++) {
            const double p[3] = {at[0], at[1], 1 - (i + 0.5) / STEPS};
            const local l = medium_at(scene, p, c);
            const double depth = (l.sigma_s + l.sigma_a) * dz;
            sum += left * l.emission * dz * (depth > 1e-9 ? (1 - exp(-depth)) / depth : 1);
            left *= exp(-depth);
        }
    }
    return sum / (SUB * SUB);
}

enum { SIDE = 40, VALUES = SIDE * SIDE * 3 };

// Sum of absolute differences over the sum of what is right.
static double off_by(const picture *p, const double right[VALUES])
{
    double wrong = 0, all = 0;
    for (uint32_t i = 0; i < VALUES; i++) {
        wrong += fabs((double)p->rgb[i] - right[i]);
        all += right[i];
    }
    return relative(wrong, all);
}

static const struct kind {
    const char *name;
    float sigma_a;
    glow kind;
} kinds[] = {
    {"grid", 1.5f, BY_GRID},
    {"grey grid", 1.5f, GREY_GRID},
    {"grid without density", 0, BY_GRID},
    {"black body", 3, BLACK_BODY},
};

// Of what does not scatter every method gives the same picture.
static void without_scattering(void **state)
{
    gpu_test *t = *state;
    // What is left is of the media's resampled voxels; constellation marches by coarser steps.
    static const struct {
        const char *name;
        double bound;
    } methods[] = {{"pop", 0.005},      {"single", 0.005},       {"pop-paper", 0.005},
                   {"shdom", 0.005},    {"lpv", 0.005},          {"photon", 0.005},
                   {"gradient", 0.005}, {"constellation", 0.009}};
    for (int k = 0; k < 4; k++) {
        tyn_scene *scene = make(0, kinds[k].sigma_a, kinds[k].kind, false);
        tyn_view view = {0};
        view_orthographic(&view, (float[]){0, 0, 0}, 0, 0, -1, (float[]){0, 1, 0}, 0.75f, SIDE);
        static double right[VALUES];
        picture p;
        picture_render(&p, t->dev, "path", scene, &view, NULL, 256);
        double sum = 0, expected = 0, variance = 0;
        for (uint32_t i = 0; i < VALUES; i++) {
            right[i] = pixel(scene, i / 3 % SIDE, i / 3 / SIDE, SIDE, i % 3);
            sum += p.rgb[i];
            expected += right[i];
            variance += (double)p.se[i] * p.se[i];
        }
        printf("path, %s: %.6f +- %.6f, expected %.6f\n", kinds[k].name, sum, sqrt(variance),
               expected);
        assert_true(fabs(sum - expected) <= 3.5 * sqrt(variance));
        assert_true(sqrt(variance) <= 2e-3 * expected);
        picture_free(&p);
        for (size_t m = 0; m < sizeof methods / sizeof methods[0]; m++) {
            if (!is_built_in(methods[m].name)) {
                continue;
            }
            picture_render(&p, t->dev, methods[m].name, scene, &view, NULL, 1);
            const double off = off_by(&p, right);
            assert_true(within(off, methods[m].bound, NULL, "%s", methods[m].name));
            picture_free(&p);
        }
        end(scene);
    }
}

// ---- with scattering ----------------------------------------------------------------------------

static tyn_view aslant(void)
{
    tyn_view view = {0};
    view_orthographic(&view, (float[]){0, 0, 0}, 0.3f, -0.2f, -1, (float[]){0, 1, 0}, 0.75f, 32);
    return view;
}

static picture picture_of(gpu_test *t, const char *method, const tyn_scene *scene, uint32_t samples)
{
    const tyn_view view = aslant();
    picture p;
    picture_render(&p, t->dev, method, scene, &view, NULL, samples);
    return p;
}

static picture reference_of(gpu_test *t, const tyn_scene *scene, uint32_t depth)
{
    tyn_view view = aslant();
    view.max_depth = depth;
    picture p;
    path_reference(&p, t->dev, scene, &view, 512);
    return p;
}

// `pop` carries on what a grid emits and scatters it by the albedo of each place.
static void with_scattering(void **state)
{
    gpu_test *t = *state;
    static const struct {
        const char *name;
        glow kind;
        bool albedo, sun;
        double bound;
    } cases[] = {
        {"emission", BY_GRID, false, false, 0.03},
        {"black bodies", BLACK_BODY, false, false, 0.03},
        {"albedo", NO_GLOW, true, true, 0.03},
        {"all", BLACK_BODY, true, true, 0.03},
    };
    for (int i = 0; i < 4; i++) {
        tyn_scene *scene = make(6, 2, cases[i].kind, cases[i].albedo);
        if (cases[i].sun) {
            scene_add_sun(scene, 0.5f, -1, -0.6f, 3, 2.5f, 2);
        }
        picture path = reference_of(t, scene, 0), pop = picture_of(t, "pop", scene, 1);
        const picture_error e = picture_compare(&pop, &path, 4);
        printf("%s: rel_l1 %.4f, noise %.4f, bias %+.4f\n", cases[i].name, e.rel_l1, e.noise,
               e.bias);
        assert_true(within(e.rel_l1, cases[i].bound, NULL, "pop, %s", cases[i].name));
        picture_free(&path);
        picture_free(&pop);
        end(scene);
    }
}

// An albedo that is the same in all voxels is that of the coefficients; `single` is the first order of `path`.
static void albedo(void **state)
{
    gpu_test *t = *state;
    tyn_scene *scene = make(6, 2, NO_GLOW, true), *plain = make(1, 7, NO_GLOW, false);
    scene_add_sun(scene, 0.5f, -1, -0.6f, 3, 2.5f, 2);
    scene_add_sun(plain, 0.5f, -1, -0.6f, 3, 2.5f, 2);
    picture path = reference_of(t, scene, 1), one = picture_of(t, "single", scene, 1);
    const picture_error e = picture_compare(&one, &path, 4);
    assert_true(within(e.rel_l1, 0.03, NULL, "single against the first order of path"));
    picture_free(&path);
    picture_free(&one);

    tyn_color_grid *g = &scene->color_grids[0];
    const float even[3] = {0.125f, 0.5f, 0.75f};
    for (int i = 0; i < CX * CY * CZ * 3; i++) {
        g->data[i] = even[i % 3];
    }
    g->max = 0.75f;
    for (int c = 0; c < 3; c++) {
        plain->media[0].sigma_s[c] = 8 * even[c];
        plain->media[0].sigma_a[c] = 8 - 8 * even[c];
    }
    static const char *const methods[] = {"path", "pop", "single"};
    for (int m = 0; m < 3; m++) {
        picture a = picture_of(t, methods[m], scene, 512),
                b = picture_of(t, methods[m], plain, 512);
        const picture_error d = picture_compare(&a, &b, 4);
        printf("%s, even albedo: rel_l1 %.5f, noise %.5f\n", methods[m], d.rel_l1, d.noise);
        if (m == 0) {
            double sum[2] = {0}, variance = 0;
            for (uint32_t k = 0; k < a.width * a.height * 3; k++) {
                sum[0] += (double)a.rgb[k];
                sum[1] += (double)b.rgb[k];
                variance += (double)a.se[k] * (double)a.se[k] + (double)b.se[k] * (double)b.se[k];
            }
            printf("path, even albedo: %.4f and %.4f +- %.4f\n", sum[0], sum[1], sqrt(variance));
            assert_true(fabs(sum[0] - sum[1]) <= 3.5 * sqrt(variance));
            assert_true(sqrt(variance) <= 5e-3 * sum[1]);
        } else {
            assert_true(within(d.rel_l1, 0.006, NULL, "%s, even albedo", methods[m]));
        }
        picture_free(&a);
        picture_free(&b);
    }
    end(scene);
    end(plain);
}

// ---- energy -------------------------------------------------------------------------------------

static void energy(void **state)
{
    gpu_test *t = *state;
    enum { N = 96 };
    static const glow glows[] = {BY_GRID, BLACK_BODY};
    for (int i = 0; i < 2; i++) {
        tyn_scene *scene = make(6, 2, glows[i], true);
        double emitted[3] = {0};
        const double volume = 1.0 * 1.4 * 0.8 / ((double)N * N * N);
        for (int v = 0; v < N * N * N; v++) {
            const double p[3] = {(v % N + 0.5) / N, (v / N % N + 0.5) / N, (v / N / N + 0.5) / N};
            for (uint32_t c = 0; c < 3; c++) {
                emitted[c] += 4 * M_PI * volume * medium_at(scene, p, c).emission;
            }
        }
        static const char *const methods[] = {"path", "pop"};
        for (int m = 0; m < 2; m++) {
            tyn_offline *off = scene_open(t->dev, methods[m], NULL);
            tyn_view view = {
                .width = 8, .height = 8, .outputs = TYN_OUTPUT_BALANCE, .num_samples = 16};
            tyn_camera_frame_scene(&view.camera, scene);
            offline_frame(off, scene, &view);
            const tyn_balance *b = tyn_offline_output(off, TYN_OUTPUT_BALANCE);
            for (int c = 0; c < 3; c++) {
                const double given = b->emitted[c], gone = b->absorbed_media[c] + b->escaped[c];
                printf("%s: emits %.5f W, expected %.5f; absorbed or gone %.5f +- %.5f\n",
                       methods[m], given, emitted[c], gone, b->imbalance_se[c] * given);
                assert_true(within(fabs(given / emitted[c] - 1), m ? 6e-4 : 0.03, NULL,
                                   "%s, emitted", methods[m]));
                assert_true(within(fabs(gone / given - 1), m ? 2e-4 : 0.015, NULL, "%s, balance",
                                   methods[m]));
            }
            tyn_offline_destroy(&off);
        }
        end(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_scattering),
        cmocka_unit_test(with_scattering),
        cmocka_unit_test(albedo),
        cmocka_unit_test(energy),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
