// raymarch_sky.c -- an environment map seen past the medium and through it.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "passes/raymarch/raymarch.h"
#include "shaders/light/glow_args.h"
#include "shaders/common/counters.h"
#include "random_unit.h"
#include "vector.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { MAP_W = 64, MAP_H = 32, SIZE = 24, GLOW_W = 8, GLOW_H = 4, GLOW_LEVELS = 18 };

typedef struct sky_scene {
    struct medium_block medium;
    struct shape_block shape;
    struct light_block light;
    struct camera_block camera;
    struct env_block env;
    float map[MAP_W * MAP_H * 4], glow[GLOW_W * GLOW_H * GLOW_LEVELS * 4];
    tyn_raymarch_params params;
    bool with_glow;
} sky_scene;

// A unit cube and a map turned against it. `tan_half` = half the field of view.
static void make_scene(sky_scene *s, float x, float y, float z, float tan_half)
{
    memset(s, 0, sizeof *s);
    float forward[3] = {x, y, z}, right[3], up[3] = {0.1f, 0.2f, 1};
    vector_normalisef(forward);
    vector_crossf(forward, up, right);
    vector_normalisef(right);
    vector_crossf(right, forward, up);
    float turned[3][3] = {{0.6f, 0.1f, 0.5f}, {0.3f, 0.9f, -0.2f}};
    vector_normalisef(turned[0]);
    vector_crossf(turned[0], turned[1], turned[2]);
    vector_normalisef(turned[2]);
    vector_crossf(turned[2], turned[0], turned[1]);
    uint32_t seed = 3;
    for (int i = 0; i < MAP_W * MAP_H * 4; i++) {
        s->map[i] = (float)(0.5 + random_unit(&seed));
    }
    s->map[4 * (15 * MAP_W + 20)] = 300; // a lamp
    for (int i = 0; i < GLOW_W * GLOW_H * GLOW_LEVELS * 4; i++) {
        s->glow[i] = (float)(0.5 + random_unit(&seed));
    }
    for (int i = 0; i < 3; i++) {
        s->camera.forward[i] = forward[i];
        s->camera.right[i] = right[i];
        s->camera.up[i] = up[i];
        s->camera.origin[i] = 0.5f - 3 * forward[i];
        memcpy(s->env.rows[i], turned[i], sizeof turned[i]);
        s->env.radiance[i] = (float)(i + 1);
        s->env.sky[i] = s->env.mean[i] = 0.7f;
        s->medium.extent[i] = s->medium.voxel[i] = s->params.extent[i] = 1;
        s->medium.brick_size[i] = TYN_BRICK;
        s->medium.size[i] = s->medium.bricks[i] = 1;
        s->shape.rows[i][i] = 1;
        s->shape.rows[i][3] = -0.5f;
    }
    s->camera.size[0] = s->camera.size[1] = SIZE;
    s->camera.half_width = s->camera.half_height = tan_half;
    s->env.has_map = 1;
    s->env.size[0] = MAP_W;
    s->env.size[1] = MAP_H;
    s->medium.num_shapes = 1;
    s->medium.max_density = 1;
    tyn_pass_defaults(&tyn_pass_raymarch, &s->params);
    memcpy(s->params.extent, s->medium.extent, sizeof s->medium.extent);
    s->params.width = s->params.height = SIZE;
    s->params.num_shapes = 1;
    s->params.background = 1;
    s->params.antialias = 0;
    s->params.longest_step = 0.02f;
    s->params.layers = RAYMARCH_LAYER_TRANSMITTANCE | RAYMARCH_LAYER_MULTIPLE;
}

static void run(gpu_test *t, const sky_scene *s)
{
    const float one[1] = {1};
    const tyn_extent texel = {1, 1, 1};
    tyn_graph_begin(t->graph);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [RAYMARCH_PORT_MEDIUM] = gpu_buffer(t, "medium", &s->medium, sizeof s->medium),
        [RAYMARCH_PORT_DENSITY] = gpu_image(t, "density", TYN_IMAGE_3D, texel, 1, one),
        [RAYMARCH_PORT_DISTANCE] = gpu_image(t, "distance", TYN_IMAGE_3D, texel, 1, (float[1]){0}),
        [RAYMARCH_PORT_SHAPES] = gpu_buffer(t, "shapes", &s->shape, sizeof s->shape),
        [RAYMARCH_PORT_LIGHTS] = gpu_buffer(t, "lights", &s->light, sizeof s->light),
        [RAYMARCH_PORT_CAMERA] = gpu_buffer(t, "camera", &s->camera, sizeof s->camera),
        [RAYMARCH_PORT_ENVIRONMENT] = gpu_buffer(t, "environment", &s->env, sizeof s->env),
        [RAYMARCH_PORT_ENV_MAP] =
            gpu_image(t, "env_map", TYN_IMAGE_2D, (tyn_extent){MAP_W, MAP_H, 1}, 4, s->map),
    };
    if (s->with_glow) {
        refs[RAYMARCH_PORT_GLOW] = gpu_image(t, "glow", TYN_IMAGE_3D,
                                             (tyn_extent){GLOW_W, GLOW_H, GLOW_LEVELS}, 4, s->glow);
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_raymarch, &s->params, refs), TYN_OK);
    for (uint8_t p = RAYMARCH_PORT_RADIANCE; p < RAYMARCH_NUM_PORTS; p++) {
        if (refs[p].resource) {
            tyn_graph_output(t->graph, tyn_pass_raymarch.ports[p].name, refs[p], true);
        }
    }
    gpu_run(t);
}

static const float *pixel(gpu_test *t, const char *name, uint32_t x, uint32_t y)
{
    return (const float *)gpu_map(t, name) + 4 * (y * SIZE + x);
}

// ---- what a ray sees of the map -------------------------------------------------------------------

static void ray(const sky_scene *s, double px, double py, double d[3])
{
    double su = 2 * px / SIZE - 1, sv = 1 - 2 * py / SIZE, length = 0;
    for (int i = 0; i < 3; i++) {
        d[i] = s->camera.forward[i] + su * s->camera.half_width * s->camera.right[i] +
               sv * s->camera.half_height * s->camera.up[i];
        length += d[i] * d[i];
    }
    for (int i = 0; i < 3; i++) {
        d[i] /= sqrt(length);
    }
}

// Position in the map, 0 to 1.
static void map_position(const sky_scene *s, const double d[3], double *u, double *v)
{
    double m[3];
    for (int i = 0; i < 3; i++) {
        m[i] = s->env.rows[i][0] * d[0] + s->env.rows[i][1] * d[1] + s->env.rows[i][2] * d[2];
    }
    *u = 0.5 + atan2(m[0], -m[2]) / (2 * PI);
    *v = acos(fmin(fmax(m[1], -1), 1)) / PI;
}

// Linear interpolation in a w x h x levels texture of four channels; x wraps.
static double lookup(const float *texels, int w, int h, int levels, double u, double v, double z,
                     int c)
{
    double x = u * w - 0.5 + w, y = fmin(fmax(v * h - 0.5, 0), h - 1.0), sum = 0;
    z = fmin(fmax(z, 0), levels - 1.0);
    for (int k = 0; k < 8; k++) {
        int xi = (int)floor(x) + (k & 1), yi = (int)floor(y) + (k >> 1 & 1), zi = (int)z + (k >> 2);
        double weight = (k & 1 ? x - floor(x) : 1 - x + floor(x)) *
                        (k & 2 ? y - floor(y) : 1 - y + floor(y)) *
                        (k & 4 ? z - floor(z) : 1 - z + floor(z));
        yi = yi < h ? yi : h - 1;
        zi = zi < levels ? zi : levels - 1;
        sum += weight * texels[4 * ((zi * h + yi) * w + xi % w) + c];
    }
    return sum;
}

// What coordinates that are off by `shift` texels may change of it, and levels that are off by `deeper` besides.
static double lookup_error(const float *texels, int w, int h, int levels, double u, double v,
                           double z, int c, double shift, double deeper)
{
    const double exact = lookup(texels, w, h, levels, u, v, z, c);
    double most = 0;
    for (int k = 0; k < 8; k++) {
        const double x = k & 1 ? shift : -shift, y = k & 2 ? shift : -shift;
        const double off = lookup(texels, w, h, levels, u + x / w, v + y / h,
                                  z + (k & 4 ? shift + deeper : -shift - deeper), c);
        most = maximum(most, fabs(off - exact));
    }
    return most;
}

static double map_lookup(const sky_scene *s, double u, double v, int c)
{
    return s->env.radiance[c] * lookup(s->map, MAP_W, MAP_H, 1, u, v, 0, c);
}

// Mean over a pixel of the bilinear map.
static double pixel_mean(const sky_scene *s, uint32_t x, uint32_t y, int c)
{
    enum { N = 24 };
    double sum = 0;
    for (int j = 0; j < N; j++) {
        for (int i = 0; i < N; i++) {
            double d[3], u, v;
            ray(s, x + (i + 0.5) / N, y + (j + 0.5) / N, d);
            map_position(s, d, &u, &v);
            sum += map_lookup(s, u, v, c);
        }
    }
    return sum / (N * N);
}

// Mean over a box of half a texel about the pixel's centre.
static double texel_mean(const sky_scene *s, uint32_t x, uint32_t y, int c)
{
    enum { N = 24 };
    double d[3], u, v, sum = 0;
    ray(s, x + 0.5, y + 0.5, d);
    map_position(s, d, &u, &v);
    for (int j = 0; j < N; j++) {
        for (int i = 0; i < N; i++) {
            sum += map_lookup(s, u + 0.5 * ((i + 0.5) / N - 0.5) / MAP_W,
                              v + 0.5 * ((j + 0.5) / N - 0.5) / MAP_H, c);
        }
    }
    return sum / (N * N);
}

// Both kernels, the map's texels being white noise, the worst case, and a lamp.
static void background(void **state)
{
    gpu_test *t = *state;
    sky_scene *s = malloc(sizeof *s);
    // Half fields of view, as tangents: pixels of 0.01, 0.5, 1.6 and 4.7 texels.
    static const float fields[] = {0.01f, 0.6f, 2, 6}, limits[] = {0.001f, 0.005f, 0.025f, 0.015f};
    for (int k = 0; k < 8; k++) {
        make_scene(s, 0.3f, 0.4f, -0.8f, fields[k / 2]);
        if (k % 2) {
            s->params.first[0] = s->params.first[1] = SIZE / 3;
            s->params.end[0] = s->params.end[1] = 2 * SIZE / 3;
        }
        run(t, s);
        double off = 0, sum = 0;
        for (uint32_t y = 0; y < SIZE; y++) {
            for (uint32_t x = 0; x < SIZE; x++) {
                for (int c = 0; c < 3; c++) {
                    double seen = pixel(t, "radiance", x, y)[c];
                    bool small = fields[k / 2] < 0.1f;
                    double mean = small ? texel_mean(s, x, y, c) : pixel_mean(s, x, y, c);
                    assert_true(seen >= 0);
                    off += fabs(seen - mean);
                    sum += mean;
                }
            }
        }
        print_message("half field %g: %.3f %% off\n", fields[k / 2], 100 * off / sum);
        assert_true(
            within(off / sum, limits[k / 2], BOUND_FILTER, "half field %g", (double)fields[k / 2]));
    }
    free(s);
}

// ---- through the medium ---------------------------------------------------------------------------

// `device`: what texture units and functions may change.
static void assert_close(double value, double expected, double relative, double device,
                         const char *what)
{
    const double most = relative * fabs(expected) + device + 1e-7;
    if (!(relative > 1e-4
              ? within(fabs(value - expected), most, NULL, "%s within %g", what, relative)
              : fabs(value - expected) <= most)) {
        fail_msg("%s: %.8g instead of %.8g", what, value, expected);
    }
}

// Path of a ray in the unit cube, and where it ends.
static double chord(const sky_scene *s, const double d[3], double *far)
{
    double begin = 0, end = 1e30;
    for (int a = 0; a < 3; a++) {
        double t0 = (0 - s->camera.origin[a]) / d[a], t1 = (1 - s->camera.origin[a]) / d[a];
        begin = fmax(begin, fmin(t0, t1));
        end = fmin(end, fmax(t0, t1));
    }
    *far = fabs(end);
    return fmax(end - begin, 0);
}

static void through_the_medium(void **state)
{
    gpu_test *t = *state;
    sky_scene *s = malloc(sizeof *s);
    static const struct {
        float sigma_s[3], sigma_a[3], g[3];
    } media[] = {
        {{2, 2, 2}, {0.3f, 0.3f, 0.3f}, {0.8f, 0.8f, 0.8f}},
        {{2, 5, 1}, {0, 0.3f, 2}, {0.8f, 0.5f, -0.3f}},
        {{150, 100, 200}, {0, 0, 0}, {0.98f, 0.98f, 0.99f}}, // e^-tau is 0, e^-tau' is not
        {{2, 5, 20}, {0, 0, 0}, {0.998f, 0.99f, 0.9999f}},   // lobes too narrow to resolve
    };
    for (int k = 0; k < 8; k++) {
        make_scene(s, 0.3f, 0.4f, -0.8f, 0.25f);
        memcpy(s->medium.sigma_s, media[k / 2].sigma_s, sizeof(tyn_vec3));
        memcpy(s->medium.sigma_a, media[k / 2].sigma_a, sizeof(tyn_vec3));
        for (int c = 0; c < 3; c++) {
            s->medium.phase[c].g = media[k / 2].g[c];
        }
        s->params.grey = k / 2 == 0;
        s->params.background = k % 2;
        s->with_glow = true;
        s->params.mean = 1;
        run(t, s);
        uint32_t hits = 0;
        for (uint32_t y = 0; y < SIZE; y += 2) {
            for (uint32_t x = 0; x < SIZE; x += 2) {
                double d[3], u, v;
                ray(s, x + 0.5, y + 0.5, d);
                map_position(s, d, &u, &v);
                double far, length = chord(s, d, &far);
                // Of a path that is short beside its distance the ends, two quotients, are what counts.
                double off_length = length > 0 ? 2 * gpu_ulps(t, GPU_QUOTIENT) * far : 0;
                hits += length > 0;
                for (int c = 0; c < 3; c++) {
                    double g = s->medium.phase[c].g, sigma_s = s->medium.sigma_s[c];
                    double wide = sigma_s * fmin(1, (1 - g) / 0.005); // what g = 0.995 replaces
                    double f = g > 0 ? fmin(g * g, 0.995 * 0.995) : 0;
                    double forward = (sigma_s - (1 - f) * wide) * length;
                    double scaled = exp(-((1 - f) * wide + s->medium.sigma_a[c]) * length);
                    double level = log(1 + forward / TYN_GLOW_DEPTH) / TYN_GLOW_STEP;
                    double sent = s->env.radiance[c] * scaled, through = sent * (1 - exp(-forward));
                    double smeared = lookup(s->glow, GLOW_W, GLOW_H, GLOW_LEVELS, u, v, level, c);
                    double glow = through * smeared;
                    // Where little is scattered, 1 less an exponential is as far off as that is.
                    double turned = sigma_s - (1 - f) * wide;
                    double off_through =
                        exp(-forward) * (gpu_ulps(t, GPU_EXP(forward)) + turned * off_length);
                    // The forward depth is in proportion to the logarithm of a product of exponentials, one a step.
                    double steps = ceil(length / (double)s->params.longest_step) + 1;
                    double ratio = turned / ((1 - f) * wide + s->medium.sigma_a[c]);
                    double off_level = steps * ratio * gpu_ulps(t, GPU_EXP(0.0)) /
                                       (TYN_GLOW_DEPTH + forward) / TYN_GLOW_STEP;
                    double device =
                        through * lookup_error(s->glow, GLOW_W, GLOW_H, GLOW_LEVELS, u, v, level, c,
                                               gpu_filter_shift(t), off_level) +
                        sent * smeared * off_through;
                    double behind =
                        s->params.background ? scaled * exp(-forward) * texel_mean(s, x, y, c) : 0;
                    assert_close(pixel(t, "multiple", x, y)[c], glow, 2e-3, device, "multiple");
                    assert_close(pixel(t, "radiance", x, y)[c], glow + behind, 2e-3, device,
                                 "radiance");
                }
            }
        }
        assert_true(hits > 30 && hits < 140);
        assert_int_equal(((const struct counters_block *)gpu_map(t, "counters"))->non_finite, 0);
    }
    free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(background),
        cmocka_unit_test(through_the_medium),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
