// env_glow.c -- the smeared environment against sums over the sphere in double precision.
#include "bound.h"
#include "gpu_test.h"
#include "passes/env_glow/env_glow.h"
#include "numbers.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { WIDTH = TYN_GLOW_WIDTH, HEIGHT = TYN_GLOW_HEIGHT, TERMS = 1200 };

// ---- the kernel, straight from its definition -----------------------------------------------------

static double window(double theta, double theta_1)
{
    double x = theta / theta_1 - 0.5;
    return x <= 0 ? 1 : x >= 1 ? 0 : 1 - x * x * (3 - 2 * x);
}

static double lobe_density(double g, double theta, double theta_1)
{
    double p = (1 - g * g) / (4 * PI * pow(1 + g * g - 2 * g * cos(theta), 1.5));
    return 2 * PI * p * window(theta, theta_1) * sin(theta);
}

// Legendre moments of one forward scattering, the first is 1.
static void lobe_moments(double g, double *phi)
{
    const int n = 20000;
    double lo = 0, hi = 2, theta_1 = 1;
    for (int i = 0; i < 40; i++) {
        theta_1 = 0.5 * (lo + hi);
        double sum = 0;
        for (int q = 0; q < n; q++) {
            double theta = 1.5 * theta_1 * (q + 0.5) / n;
            sum += lobe_density(g, theta, theta_1) * 1.5 * theta_1 / n;
        }
        *(sum < g * g ? &lo : &hi) = theta_1;
    }
    memset(phi, 0, TERMS * sizeof *phi);
    for (int q = 0; q < n; q++) {
        double theta = 1.5 * theta_1 * (q + 0.5) / n, mu = cos(theta), before = 1, p = mu;
        double weight = lobe_density(g, theta, theta_1) * 1.5 * theta_1 / n / (g * g);
        for (int l = 0; l < TERMS; l++) {
            phi[l] += weight * before;
            double next = ((2 * l + 3) * mu * p - (l + 1) * before) / (l + 2);
            before = p;
            p = next;
        }
    }
}

// Of all orders >= 1: sum_n t^n / n! phi^n, normalised. Poisson weights, one by one.
static double all_orders(double t, double phi)
{
    double weight = exp(-t), sum = 0, total = 0;
    for (int n = 1; n < 400 + 4 * t; n++) {
        weight *= t / n;
        sum += weight * pow(phi, n);
        total += weight;
    }
    return sum / total;
}

static double level_depth(uint32_t level)
{
    return level == 0 ? 1e-6 : TYN_GLOW_DEPTH * (exp(TYN_GLOW_STEP * level) - 1);
}

// ---- running it -----------------------------------------------------------------------------------

static const float *smear(gpu_test *t, uint32_t w, uint32_t h, const float *map, float g0, float g1,
                          float g2, uint32_t *levels)
{
    tyn_graph_begin(t->graph);
    tyn_env_glow_params params = {{{.g = g0}, {.g = g1}, {.g = g2}}};
    tyn_ref refs[TYN_MAX_PORTS] = {
        [ENV_GLOW_PORT_SKY] = gpu_image(t, "sky", TYN_IMAGE_2D, (tyn_extent){w, h, 1}, 4, map),
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_env_glow, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "glow", refs[ENV_GLOW_PORT_GLOW], true);
    tyn_graph_output(t->graph, "counters", refs[ENV_GLOW_PORT_COUNTERS], true);
    gpu_run(t);
    tyn_extent extent;
    const float *glow = tyn_graph_map(t->graph, "glow", &extent, NULL);
    assert_true(extent.x == WIDTH && extent.y == HEIGHT);
    *levels = extent.z;
    return glow;
}

static void direction(double u, double v, double d[3])
{
    double phi = 2 * PI * u, theta = PI * v;
    d[0] = sin(theta) * sin(phi);
    d[1] = cos(theta);
    d[2] = -sin(theta) * cos(phi);
}

// Bilinear, x wraps.
static double lookup(uint32_t w, uint32_t h, const float *map, double u, double v, int c)
{
    double x = u * w - 0.5 + w, y = fmin(fmax(v * h - 0.5, 0), h - 1.0);
    uint32_t x0 = (uint32_t)x % w, y0 = (uint32_t)y, y1 = y0 + 1 < h ? y0 + 1 : y0;
    uint32_t x1 = (x0 + 1) % w;
    double fx = x - floor(x), fy = y - y0;
    return (1 - fy) * ((1 - fx) * map[4 * (y0 * w + x0) + c] + fx * map[4 * (y0 * w + x1) + c]) +
           fy * ((1 - fx) * map[4 * (y1 * w + x0) + c] + fx * map[4 * (y1 * w + x1) + c]);
}

// A smooth sky with a bright window of a few texels, and a dark one.
static void make_map(uint32_t w, uint32_t h, float *map)
{
    for (uint32_t y = 0; y < h; y++) {
        for (uint32_t x = 0; x < w; x++) {
            double d[3];
            direction((x + 0.5) / w, (y + 0.5) / h, d);
            float *texel = map + 4 * (y * w + x);
            texel[0] = (float)(1 + 0.5 * d[1]);
            texel[1] = (float)(0.7 + 0.3 * d[0] * d[2]);
            texel[2] = (float)(1.5 + d[1] * d[1] * d[0]);
            texel[3] = 0;
            bool bright = x >= w / 4 && x < w / 4 + 3 && y >= h / 3 && y < h / 3 + 3;
            for (int c = 0; c < 3; c++) {
                texel[c] *= bright ? 40.0f : 1.0f;
            }
        }
    }
}

static const uint32_t some_texels[][2] = {{0, 0},   {127, 63}, {31, 1},  {36, 22},
                                          {34, 25}, {40, 30},  {100, 5}, {90, 40},
                                          {3, 60},  {64, 33},  {63, 20}, {25, 22}};

static void convolution(void **state)
{
    gpu_test *t = *state;
    enum { W = 64, H = 32 };
    static float map[W * H * 4];
    static double phi[TERMS], kernel[2001];
    make_map(W, H, map);
    const float gs[3] = {0.3f, 0.6f, 0.85f};
    uint32_t levels;
    const float *glow = smear(t, W, H, map, gs[0], gs[1], gs[2], &levels);
    double worst = 0;
    for (int c = 0; c < 3; c++) {
        lobe_moments(gs[c], phi);
        for (uint32_t level = 0; level < levels; level += 4) {
            double k[TERMS];
            for (int l = 0; l < TERMS; l++) {
                k[l] = all_orders(level_depth(level), phi[l]);
            }
            for (int i = 0; i <= 2000; i++) { // over theta
                double mu = cos(PI * i / 2000), before = 1, p = mu;
                kernel[i] = 0;
                for (int l = 0; l < TERMS && l < 300; l++) {
                    kernel[i] += (2 * l + 1) / (4 * PI) * k[l] * before;
                    double next = ((2 * l + 3) * mu * p - (l + 1) * before) / (l + 2);
                    before = p;
                    p = next;
                }
            }
            for (size_t s = 0; s < sizeof some_texels / sizeof some_texels[0]; s++) {
                uint32_t x = some_texels[s][0], y = some_texels[s][1];
                double v[3], sum = 0, total = 0;
                direction((x + 0.5) / WIDTH, (y + 0.5) / HEIGHT, v);
                enum { FINE = 4 }; // a quarter texel of the map
                for (int j = 0; j < H * FINE; j++) {
                    double omega = 2 * PI / (W * FINE) *
                                   (cos(PI * j / (H * FINE)) - cos(PI * (j + 1) / (H * FINE)));
                    for (int i = 0; i < W * FINE; i++) {
                        double d[3], uu = (i + 0.5) / (W * FINE), vv = (j + 0.5) / (H * FINE);
                        direction(uu, vv, d);
                        double mu = d[0] * v[0] + d[1] * v[1] + d[2] * v[2];
                        double at = acos(fmin(fmax(mu, -1), 1)) / PI * 2000;
                        int i0 = (int)fmin(at, 1999);
                        double weight = kernel[i0] + (at - i0) * (kernel[i0 + 1] - kernel[i0]);
                        sum += omega * weight * lookup(W, H, map, uu, vv, c);
                        total += omega * weight;
                    }
                }
                assert_within(fabs(total - 1), 2e-3, NULL);
                double value = glow[4 * ((level * HEIGHT + y) * WIDTH + x) + (uint32_t)c];
                double error = fabs(value - sum) / fmax(sum, 1);
                worst = maximum(worst, error);
                if (!(error <= 0.01)) {
                    fail_msg("g %g, depth %g, texel %u %u: %g instead of %g", gs[c],
                             level_depth(level), x, y, value, sum);
                }
            }
        }
    }
    print_message("convolution: within %.2g\n", worst);
}

// Of a uniform map nothing but degree 0 is to be left. Degree l comes from l steps of a recurrence, each with two roots of quotients
// that are off independently: so by sqrt(l) of them. At the poles it counts sqrt(l + 1/2), and the degrees' errors add up likewise.
static double rounding_of_degrees(const gpu_test *t)
{
    double sum = 0;
    for (int l = 2; l < HEIGHT; l += 2) { // odd ones cancel between mirrored rows
        sum += l * (l + 0.5);
    }
    return M_SQRT2 * (gpu_ulps(t, GPU_ROOT) + 0.5 * gpu_ulps(t, GPU_QUOTIENT)) * sqrt(sum);
}

// A uniform map stays as it is, at every depth; so does one that is a single texel.
static void uniform(void **state)
{
    gpu_test *t = *state;
    static float map[WIDTH * HEIGHT * 4];
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        memcpy(map + 4 * i, (const float[4]){1, 2.5f, 1e-3f, 7}, 4 * sizeof(float));
    }
    const double off = 1e-5 + rounding_of_degrees(t);
    double worst = 0;
    for (int size = 0; size < 2; size++) {
        uint32_t levels;
        const float *glow =
            smear(t, size ? 1 : WIDTH, size ? 1 : HEIGHT, map, 0.2f, 0.9f, 0.99f, &levels);
        for (uint32_t i = 0; i < levels * WIDTH * HEIGHT * 4; i++) {
            double expected = i % 4 == 3 ? 1 : map[i % 4];
            worst = maximum(worst, fabs(glow[i] - expected) / expected);
            if (!(fabs(glow[i] - expected) <= off * expected)) {
                fail_msg("texel %u: %.8g instead of %g", i / 4, glow[i], expected);
            }
        }
    }
    print_message("uniform: within %.2g of %.2g\n", worst, off);
}

// Without forward scattering there is nothing but the mean, which nothing is weighted with; g near 1
// leaves the map sharp; energy is kept at every depth; nothing is negative.
static void limits(void **state)
{
    gpu_test *t = *state;
    static float map[WIDTH * HEIGHT * 4];
    make_map(WIDTH, HEIGHT, map);
    for (int i = 0; i < 4 * WIDTH; i++) {
        map[i] = 500; // a lamp in the zenith
    }
    double mean = 0, omega_sum = 0;
    for (int y = 0; y < HEIGHT; y++) {
        double omega = cos(PI * y / HEIGHT) - cos(PI * (y + 1) / HEIGHT);
        for (int x = 0; x < WIDTH; x++) {
            mean += omega * map[4 * (y * WIDTH + x)];
            omega_sum += omega;
        }
    }
    mean /= omega_sum;
    const float gs[] = {-0.5f, 0, 0.001f, 0.1f, 0.5f, 0.9f, 0.98f, 0.995f, 0.9999f};
    const double tolerances[] = {1e-5, 1e-5, 0.05, 3e-3, 6e-4, 5e-3, 0.025, 0.05, 0.05};
    for (size_t k = 0; k < sizeof gs / sizeof gs[0]; k++) {
        uint32_t levels;
        const float *glow = smear(t, WIDTH, HEIGHT, map, gs[k], gs[k], gs[k], &levels);
        for (uint32_t level = 0; level < levels; level++) {
            double sum = 0, below = 0;
            for (int y = 0; y < HEIGHT; y++) {
                double omega = cos(PI * y / HEIGHT) - cos(PI * (y + 1) / HEIGHT);
                for (int x = 0; x < WIDTH; x++) {
                    double value = glow[4 * ((level * HEIGHT + y) * WIDTH + x)];
                    assert_true(isfinite(value) && value >= 0);
                    below += value == 0;
                    sum += omega * value;
                }
            }
            // Where a cut series is clamped at 0 around the lamp it gains.
            const double tolerance = tolerances[k];
            const double off = fabs(sum / omega_sum / mean - 1);
            if (!(tolerance > 1e-4 ? within(off, tolerance, NULL, "g %g, mean", (double)gs[k])
                                   : off <= tolerance)) {
                fail_msg("g %g, level %u: mean %g instead of %g", gs[k], level, sum / omega_sum,
                         mean);
            }
            if (below > 0) {
                print_message("g %g, level %u: %g texels at 0\n", gs[k], level, below);
            }
        }
    }
    print_message("g 0.9999: %.2f ms\n", gpu_ms(t, "env_glow"));
}

// Harmonics come back with their own factor.
static void harmonics(void **state)
{
    gpu_test *t = *state;
    static float map[WIDTH * HEIGHT * 4];
    static double phi[TERMS];
    const int degrees[3] = {3, 11, 20}, orders[3] = {0, 1, 7};
    double norm[3];
    for (int c = 0; c < 3; c++) {
        norm[c] = 0;
        for (int pass = 0; pass < 2; pass++) {
            for (int y = 0; y < HEIGHT; y++) {
                for (int x = 0; x < WIDTH; x++) {
                    double theta = PI * (y + 0.5) / HEIGHT, mu = cos(theta), p = 1, before = 0;
                    int m = orders[c];
                    for (int i = 1; i <= m; i++) {
                        p *= (2 * i - 1) * sin(theta);
                    }
                    for (int l = m; l < degrees[c]; l++) {
                        double next = ((2 * l + 1) * mu * p - (l + m) * before) / (l - m + 1);
                        before = p;
                        p = next;
                    }
                    double f = p * cos(m * 2 * PI * (x + 0.5) / WIDTH + 0.3);
                    if (pass == 0) {
                        norm[c] = fmax(norm[c], fabs(f));
                    } else {
                        map[4 * (y * WIDTH + x) + c] = (float)(2 + f / norm[c]);
                    }
                }
            }
        }
    }
    const float g = 0.9f;
    lobe_moments(g, phi);
    uint32_t levels;
    const float *glow = smear(t, WIDTH, HEIGHT, map, g, g, g, &levels);
    double worst = 0;
    for (uint32_t level = 0; level < levels; level++) {
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            for (int c = 0; c < 3; c++) {
                double k = all_orders(level_depth(level), phi[degrees[c]]);
                double expected = 2 + k * (map[4 * i + c] - 2);
                double error =
                    fabs(glow[4 * (level * WIDTH * HEIGHT + (uint32_t)i) + c] - expected);
                worst = maximum(worst, error);
            }
        }
    }
    print_message("harmonics: within %.2g of their amplitude\n", worst);
    assert_within(worst, 1.5e-4, NULL);
}

// A lobe much narrower than the texels about a bright one: no dark rings, and nothing below 0.
static void bright_texel(void **state)
{
    gpu_test *t = *state;
    static float map[WIDTH * HEIGHT * 4];
    for (int i = 0; i < WIDTH * HEIGHT * 4; i++) {
        map[i] = i % 4 == 0 ? 0.0f : 1.0f;
    }
    for (int c = 0; c < 3; c++) {
        map[4 * (25 * WIDTH + 70) + c] = 20.0f;
    }
    uint32_t levels;
    const float *glow = smear(t, WIDTH, HEIGHT, map, 0.9999f, 0.97f, 0.9999f, &levels);
    float least = 1, most = 0;
    for (uint32_t i = 0; i < levels * WIDTH * HEIGHT; i++) {
        assert_true(glow[4 * i] >= 0);
        least = minimum(least, minimum(glow[4 * i + 1], glow[4 * i + 2]));
        most = maximum(most, glow[4 * i + 2]);
    }
    print_message("beside a texel of 20 in surroundings of 1: %.3f to %.3f\n", least, most);
    assert_true(least > 0.85 && most > 3);
}

static void bad_texels(void **state)
{
    gpu_test *t = *state;
    static float map[WIDTH * HEIGHT * 4];
    make_map(WIDTH, HEIGHT, map);
    map[4 * 1000] = NAN;
    map[4 * 3000 + 1] = INFINITY;
    uint32_t levels;
    const float *glow = smear(t, WIDTH, HEIGHT, map, 0.5f, 0.5f, 0.5f, &levels);
    const uint32_t met = gpu_non_finite(t); // filtered, a texel may be met at four places
    assert_true(met >= 2 && met <= 8);
    for (uint32_t i = 0; i < levels * WIDTH * HEIGHT * 4; i++) {
        assert_true(isfinite(glow[i]) && glow[i] > 0.2); // the others are still there
    }
    t->quiet = true;
    tyn_graph_begin(t->graph);
    tyn_env_glow_params params = {{{.g = 0.5f}, {.g = 1.0f}, {.g = 0.5f}}};
    tyn_ref refs[TYN_MAX_PORTS] = {
        [ENV_GLOW_PORT_SKY] =
            gpu_image(t, "sky", TYN_IMAGE_2D, (tyn_extent){WIDTH, HEIGHT, 1}, 4, map),
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_env_glow, &params, refs), TYN_ERR_PARAMS);
    t->quiet = false;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform), cmocka_unit_test(harmonics),    cmocka_unit_test(convolution),
        cmocka_unit_test(limits),  cmocka_unit_test(bright_texel), cmocka_unit_test(bad_texels),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
