// scatter_lut.c -- the table of forward scattering against the double precision series.
#include "bound.h"
#include "gpu_test.h"
#include "passes/scatter_lut/scatter_lut.h"
#include "numbers.h"
#include "point_pass.h"
#include "scatter_lut_eval.comp.h"
#include "random_unit.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

// ---- the series, straight from its definition -----------------------------------------------------

typedef struct series {
    double g, f, theta_1;
    int terms;
    double lobe[2500], rest[2500]; // F_l, g^l - F_l
} series;

static double phase(double g, double theta)
{
    double y = 2 * sin(0.5 * theta) * sin(0.5 * theta);
    return (1 - g * g) / (4 * PI * pow((1 - g) * (1 - g) + 2 * g * y, 1.5));
}

static double window(const series *s, double theta)
{
    double x = s->theta_1 > 0 ? theta / s->theta_1 - 0.5 : 1;
    return x <= 0 ? 1 : x >= 1 ? 0 : 1 - x * x * (3 - 2 * x);
}

static double lobe_density(const series *s, double theta)
{
    return 2 * PI * phase(s->g, theta) * window(s, theta) * sin(theta);
}

static void series_make(series *s, double g)
{
    *s = (series){.g = g, .f = g > 0 ? g * g : 0, .terms = (int)(12 / (1 - fmax(g, 0))) + 64};
    if (s->terms > 2464) {
        s->terms = 2464;
    }
    if (s->f < 1e-6) {
        double power = 1;
        for (int l = 0; l < s->terms; l++, power *= g) {
            s->rest[l] = power;
        }
        return;
    }
    double lo = 0, hi = 2;
    int n = s->terms * 8 > 4000 ? s->terms * 8 : 4000;
    for (int i = 0; i < 45; i++) { // half width that holds the fraction f
        s->theta_1 = 0.5 * (lo + hi);
        double sum = 0;
        for (int q = 0; q < n; q++) {
            sum += lobe_density(s, 1.5 * s->theta_1 * (q + 0.5) / n) * 1.5 * s->theta_1 / n;
        }
        *(sum < s->f ? &lo : &hi) = s->theta_1;
    }
    for (int q = 0; q < n; q++) {
        double theta = 1.5 * s->theta_1 * (q + 0.5) / n, mu = cos(theta), before = 1, p = mu;
        double weight = lobe_density(s, theta) * 1.5 * s->theta_1 / n;
        for (int l = 0; l < s->terms; l++) {
            s->lobe[l] += weight * before;
            double next = ((2 * l + 3) * mu * p - (l + 1) * before) / (l + 2);
            before = p;
            p = next;
        }
    }
    double power = 1;
    for (int l = 0; l < s->terms; l++, power *= g) {
        s->rest[l] = power - s->lobe[l];
    }
}

static void series_kernels(const series *s, double tau, double theta, double k[2])
{
    double mu = cos(theta), before = 1, p = mu, h = window(s, theta), sum[2] = {0, 0};
    for (int l = 0; l < s->terms; l++) {
        double e = (2 * l + 1) / (4 * PI) * before * exp(-tau * (1 - s->lobe[l])) *
                   -expm1(-tau * s->lobe[l]);
        sum[0] += e * s->rest[l];
        sum[1] += e * s->lobe[l];
        double next = ((2 * l + 3) * mu * p - (l + 1) * before) / (l + 2);
        before = p;
        p = next;
    }
    k[0] = phase(s->g, theta) * (1 - h) * exp(-tau) + fmax(sum[0], 0);
    k[1] = phase(s->g, theta) * h * exp(-tau) + fmax(sum[1], 0);
}

// What rounding of the series may come to, in ulps of the device's functions, each off independently: an exponential a term, and two
// quotients for each step of the recurrence up to it. P_l counts as its envelope, as terms of both signs cancel behind a lobe.
static double series_ulps(const series *s, double tau, double theta)
{
    double sum = 0;
    for (int l = 0; l < s->terms; l++) {
        const double x = tau * (1 - s->lobe[l]), envelope = 2 / (PI * (l + 0.5) * sin(theta));
        const double e = (2 * l + 1) / (4 * PI) * exp(-x) * -expm1(-tau * s->lobe[l]);
        const double ulps =
            GPU_EXP(tau * (s->lobe[l] - s->f)) * GPU_EXP(tau * (s->lobe[l] - s->f)) +
            l * 2 * GPU_QUOTIENT * GPU_QUOTIENT;
        sum +=
            e * e * fmin(envelope, 1) * ulps * (s->rest[l] * s->rest[l] + s->lobe[l] * s->lobe[l]);
    }
    return sqrt(sum);
}

// ---- the table at points --------------------------------------------------------------------------

typedef struct point {
    float tau, one_minus_mu, g;
    uint32_t channel;
    float tau_p;
    uint32_t sun;
    float cosine;
} point;

// Backward peaks tell angles apart that rounding does not: what is expected is of the angle that a point has.
static float away_by(double theta)
{
    return (float)(2 * sin(0.5 * theta) * sin(0.5 * theta));
}

static double theta_of(const point *p)
{
    return 2 * asin(sqrt(0.5 * (double)p->one_minus_mu));
}

static const float (*evaluate(gpu_test *t, const tyn_scatter_lut_params *lut_params,
                              const point *points, uint32_t count, uint32_t mixed))[2]
{
    static point_pass pass;
    static const point_input inputs[] = {{"lut", TYN_IMAGE_2D, TYN_USE_SAMPLED},
                                         {"lut_block", TYN_BUFFER, TYN_USE_UNIFORM}};
    point_pass_init(&pass, scatter_lut_eval_spirv, sizeof scatter_lut_eval_spirv, inputs, 2);
    tyn_graph_begin(t->graph);
    tyn_ref lut[SCATTER_LUT_NUM_PORTS] = {{0}}, refs[4] = {{0}};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_scatter_lut, lut_params, lut), TYN_OK);
    refs[0] = lut[SCATTER_LUT_PORT_LUT];
    refs[1] = lut[SCATTER_LUT_PORT_LUT_BLOCK];
    refs[2] = gpu_buffer(t, "points", points, count * sizeof *points);
    point_pass_params params = {count, 8, mixed, pass.results};
    assert_int_equal(tyn_graph_add(t->graph, &pass.desc, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "results", refs[3], true);
    gpu_run(t);
    return (const float(*)[2])gpu_map(t, "results");
}

enum { COUNT = 600 };

// Even over the logarithms of depth and angle, where the kernels vary. `deepest` in tau (1 - f).
static void scatter_points(point *points, uint32_t channel, double g, double deepest,
                           uint32_t *seed)
{
    double depth_max = deepest / (1 - (g > 0 ? g * g : 0)), width = 0.2 * (1 - fabs(g));
    for (int i = 0; i < COUNT; i++) {
        double tau = expm1(random_unit(seed) * log1p(4 * depth_max)) / 4;
        double theta = width * expm1(random_unit(seed) * log1p(PI / width));
        points[i] = (point){(float)tau, away_by(fmin(theta, PI)), 0, channel, 0, 0, 1};
    }
}

// Largest error relative to K_tms + K_lobe, beyond what the device's functions may be off by; NaN and negative values count as 1e30.
static double worst_error(const gpu_test *t, const series *s, const point *points,
                          const float (*got)[2], const char *name)
{
    double worst = 0, sum = 0, at[2] = {0, 0};
    for (int i = 0; i < COUNT; i++) {
        double k[2];
        series_kernels(s, points[i].tau, theta_of(&points[i]), k);
        const double ulp = gpu_ulps(t, 1),
                     off = ulp > 0 ? ulp * series_ulps(s, points[i].tau, theta_of(&points[i])) : 0;
        for (int part = 0; part < 2; part++) {
            double error = maximum(fabs(got[i][part] - k[part]) - off, 0) / (k[0] + k[1]);
            error = got[i][part] >= 0 && error == error ? error : 1e30;
            sum += error;
            if (error > worst) {
                worst = error;
                at[0] = points[i].tau;
                at[1] = theta_of(&points[i]);
            }
        }
    }
    printf("%s g %6.3f: largest error %.3f %% (tau %.3g, theta %.3g), mean %.4f %%\n", name, s->g,
           100 * worst, at[0], at[1], 100 * sum / (2 * COUNT));
    return worst;
}

static void rows_of_channels(void **state)
{
    gpu_test *t = *state;
    static const float sets[][3] = {{0.9f, 0.5f, 0.9f},    {0, 1e-8f, 0.03f},
                                    {-0.6f, -0.95f, 0.3f}, {0.6f, 0.85f, 0.95f},
                                    {0.8f, 0.98f, 0.995f}, {0.0011f, 0.01f, 0.99f}};
    static const double most[][3] = {{2.4e-3, 1e-3, 2.7e-3}, {1e-5, 1e-5, 2.3e-4},
                                     {1e-5, 1e-5, 6e-4},     {1.2e-3, 2e-3, 4.5e-3},
                                     {1.5e-3, 5e-3, 7e-3},   {1e-5, 7e-5, 6e-3}};
    static point points[3 * COUNT];
    static series s;
    uint32_t seed = 7;
    for (size_t n = 0; n < sizeof sets / sizeof *sets; n++) {
        tyn_scatter_lut_params params = {
            .mode = TYN_MEDIUM_DENSITY,
            .phase = {{.g = sets[n][0]}, {.g = sets[n][1]}, {.g = sets[n][2]}}};
        for (uint32_t c = 0; c < 3; c++) {
            scatter_points(points + c * COUNT, c, sets[n][c], 20, &seed);
        }
        const float(*got)[2] = evaluate(t, &params, points, 3 * COUNT, 0);
        printf("built in %.2f ms\n", gpu_ms(t, "scatter_lut"));
        for (uint32_t c = 0; c < 3; c++) {
            series_make(&s, sets[n][c]);
            double worst = worst_error(t, &s, points + c * COUNT, got + c * COUNT, "row");
            assert_true(within(worst, most[n][c], most[n][c] <= 1e-4 ? BOUND_ROUNDING : NULL,
                               "row of g %g", (double)sets[n][c]));
        }
    }
}

// Without scattering before, the sum is the phase function itself; at g above 0.995 that of 0.995.
static void single_scattering(void **state)
{
    gpu_test *t = *state;
    point points[200];
    static const float g[3] = {0.9f, -0.7f, 0.999f};
    for (int i = 0; i < 200; i++) {
        points[i] = (point){0, away_by(PI * pow(i / 199.0, 3)), 0, (uint32_t)i % 3, 0, 0, 1};
    }
    tyn_scatter_lut_params params = {.mode = TYN_MEDIUM_DENSITY,
                                     .phase = {{.g = g[0]}, {.g = g[1]}, {.g = g[2]}}};
    const float(*got)[2] = evaluate(t, &params, points, 200, 0);
    for (int i = 0; i < 200; i++) {
        double p = phase(fmin(g[i % 3], 0.995), theta_of(&points[i]));
        assert_within(fabs(got[i][0] + got[i][1] - p), 2e-4 * p, BOUND_FILTER);
    }
}

// All directions together: the light that is still going forward after the last scattering,
// f e^{-tau (1 - f)}, and what left the beam in it, (1 - f) times that. Also far beyond the table.
static void sums_over_directions(void **state)
{
    gpu_test *t = *state;
    enum { DEPTHS = 5, ANGLES = 4000 };
    static point points[DEPTHS * ANGLES];
    const double g = 0.8, f = g * g, taus[DEPTHS] = {0.01, 0.5, 3, 30, 80};
    static const double most[DEPTHS] = {1e-6, 9e-5, 1.5e-4, 1.5e-5, 4e-5};
    for (int i = 0; i < DEPTHS * ANGLES; i++) {
        points[i] = (point){
            (float)taus[i / ANGLES], away_by(PI * (i % ANGLES + 0.5) / ANGLES), 0, 0, 0, 0, 1};
    }
    tyn_scatter_lut_params params = {.mode = TYN_MEDIUM_DENSITY,
                                     .phase = {{.g = 0.8f}, {.g = 0.8f}, {.g = 0.8f}}};
    const float(*got)[2] = evaluate(t, &params, points, DEPTHS * ANGLES, 0);
    for (int d = 0; d < DEPTHS; d++) {
        double sum[2] = {0, 0};
        for (int a = 0; a < ANGLES; a++) {
            for (int part = 0; part < 2; part++) {
                sum[part] +=
                    2 * PI * got[d * ANGLES + a][part] * sin(theta_of(&points[a])) * PI / ANGLES;
            }
        }
        double beam = exp(-taus[d] * (1 - f));
        printf("tau %5.2f: lobe %.5f of %.5f, rest %.5f of %.5f\n", taus[d], sum[1] / beam, f,
               sum[0] / beam, 1 - f);
        assert_true(
            within(fabs(sum[1] / beam - f), most[d], BOUND_ROUNDING, "lobe at tau %g", taus[d]));
        assert_true(fabs(sum[0] / beam - (1 - f)) < 1e-4);
    }
}

// A beam with one g throughout, looked up between the rows of a table for varying g.
static void spread_rows(void **state)
{
    gpu_test *t = *state;
    static const double gs[] = {-0.4, 0, 0.02, 0.15, 0.5, 0.77, 0.9, 0.94, 0.95};
    static const double most[] = {1e-5, 1e-5, 6e-5, 0.013, 0.02, 0.011, 0.013, 0.014, 0.005};
    static point points[COUNT];
    static series s;
    uint32_t seed = 3;
    tyn_scatter_lut_params params = {.mode = TYN_MEDIUM_COEFFICIENTS, .g_max = 0.95f};
    for (size_t n = 0; n < sizeof gs / sizeof *gs; n++) {
        scatter_points(points, 0, gs[n], 6, &seed);
        for (int i = 0; i < COUNT; i++) {
            points[i].g = (float)gs[n];
            points[i].tau_p = points[i].tau * (float)(1 - (gs[n] > 0 ? gs[n] * gs[n] : 0));
        }
        const float(*got)[2] = evaluate(t, &params, points, COUNT, 1);
        series_make(&s, gs[n]);
        assert_true(within(worst_error(t, &s, points, got, "spread"), most[n],
                           most[n] <= 1e-4 ? BOUND_ROUNDING : NULL, "spread row of g %g", gs[n]));
    }
}

// ---- suns that are seen under an angle ------------------------------------------------------------

enum { FINE = 4000, SUN_ANGLES = 16, SUN_DEPTHS = 4 };

// K_tms + K_lobe of a point sun, for interpolation: even in theta^(1/2).
static void fine_kernel(const series *s, double tau, double *out)
{
    for (int i = 0; i <= FINE; i++) {
        double k[2], root = (double)i / FINE;
        series_kernels(s, tau, PI * root * root, k);
        out[i] = k[0] + k[1];
    }
}

static double at_angle(const double *fine, double cosine)
{
    double x = sqrt(acos(fmin(fmax(cosine, -1), 1)) / PI) * FINE;
    int i = x < FINE - 1 ? (int)x : FINE - 1;
    return fine[i] + (x - i) * (fine[i + 1] - fine[i]);
}

// The heat kernel on the sphere: the n-fold convolution of small discs, n large.
static double spot(double a, double c)
{
    double sum = 0, before = 1, p = c;
    for (int l = 0; l < 1200; l++) {
        sum += (2 * l + 1) / (4 * PI) * pow(a, 0.5 * l * (l + 1)) * before;
        double next = ((2 * l + 3) * c * p - (l + 1) * before) / (l + 2);
        before = p;
        p = next;
    }
    return sum;
}

// Mean over a sun around the direction `theta` away: the soft spot of mean cosine a, or an even disc.
static double over_sun(const double *fine, double theta, double a, bool disc)
{
    enum { RINGS = 100, SPOKES = 100 };
    static double of_a, weight[RINGS], cosine[RINGS];
    double sum = 0;
    if (of_a != a) {
        of_a = a;
        for (int r = 0; r < RINGS; r++) { // out to seven standard deviations
            double u = (r + 0.5) / RINGS, s = u * 14 * sqrt(0.5 * (1 - a));
            cosine[r] = cos(fmin(s, PI));
            weight[r] =
                s < PI ? spot(a, cosine[r]) * 2 * PI * sin(s) * 14 * sqrt(0.5 * (1 - a)) / RINGS
                       : 0;
        }
    }
    for (int r = 0; r < RINGS; r++) {
        double c = disc ? 1 - 2 * (1 - a) * (r + 0.5) / RINGS : cosine[r];
        double w = disc ? 1.0 / RINGS : weight[r];
        for (int k = 0; k < SPOKES; k++) {
            double phi = PI * (k + 0.5) / SPOKES;
            sum += w / SPOKES *
                   at_angle(fine, cos(theta) * c + sin(theta) * sqrt(1 - c * c) * cos(phi));
        }
    }
    return sum;
}

static void suns_of_finite_size(void **state)
{
    gpu_test *t = *state;
    enum { SUNS = 3, PER_ROW = SUN_DEPTHS * SUN_ANGLES };
    static const float g[3] = {0.9f, 0.6f, -0.5f};
    static const double a[SUNS] = {0.995, 0.98, 0.9999945};
    static const double taus[SUN_DEPTHS] = {0, 0.7, 3, 10};
    static point points[SUNS * 3 * PER_ROW];
    static series s[3];
    static double fine[FINE + 1];
    tyn_scatter_lut_params params = {.mode = TYN_MEDIUM_DENSITY,
                                     .phase = {{.g = g[0]}, {.g = g[1]}, {.g = g[2]}},
                                     .num_suns = SUNS,
                                     .mean_cosine = {(float)a[0], (float)a[1], (float)a[2]}};
    for (int i = 0; i < SUNS * 3 * PER_ROW; i++) {
        uint32_t sun = (uint32_t)(i / (3 * PER_ROW)), channel = (uint32_t)(i / PER_ROW % 3);
        double root = (i % SUN_ANGLES + 0.3) / SUN_ANGLES;
        points[i] = (point){.tau = (float)taus[i / SUN_ANGLES % SUN_DEPTHS],
                            .one_minus_mu = away_by(PI * root * root),
                            .channel = channel,
                            .sun = sun};
    }
    const float(*got)[2] = evaluate(t, &params, points, SUNS * 3 * PER_ROW, 0);
    for (int sun = 0; sun < SUNS; sun++) {
        for (int c = 0; c < 3; c++) {
            series_make(&s[c], g[c]);
            double worst = 0, worst_disc = 0;
            for (int d = 0; d < SUN_DEPTHS; d++) {
                fine_kernel(&s[c], taus[d], fine);
                for (int k = 0; k < SUN_ANGLES; k++) {
                    int i = (sun * 3 + c) * PER_ROW + d * SUN_ANGLES + k;
                    double sum = got[i][0] + got[i][1];
                    double expected = over_sun(fine, theta_of(&points[i]), a[sun], false);
                    double disc = over_sun(fine, theta_of(&points[i]), a[sun], true);
                    worst = maximum(worst, fabs(sum - expected) / expected);
                    worst_disc = maximum(worst_disc, fabs(sum - disc) / disc);
                    assert_true(got[i][0] >= 0 && got[i][1] >= 0);
                }
            }
            printf("sun of mean cosine %.4f, g %4.1f: within %.2f %%; of an even disc %.1f %%\n",
                   a[sun], g[c], 100 * worst, 100 * worst_disc);
            assert_true(
                within(worst, 1.9e-3, NULL, "sun of mean cosine %g, g %g", a[sun], (double)g[c]));
        }
    }
}

// The parts of a sun of finite size hold what those of a point hold.
static void sums_with_a_sun(void **state)
{
    gpu_test *t = *state;
    enum { DEPTHS = 4, ANGLES = 4000 };
    static point points[DEPTHS * ANGLES];
    const double g = 0.8, f = g * g, taus[DEPTHS] = {0, 0.5, 3, 30};
    static const double most[DEPTHS] = {1.6e-4, 3.5e-4, 6e-5, 2e-5};
    for (int i = 0; i < DEPTHS * ANGLES; i++) {
        points[i] = (point){.tau = (float)taus[i / ANGLES],
                            .one_minus_mu = away_by(PI * (i % ANGLES + 0.5) / ANGLES),
                            .sun = 1};
    }
    tyn_scatter_lut_params params = {.mode = TYN_MEDIUM_DENSITY,
                                     .phase = {{.g = 0.8f}, {.g = 0.8f}, {.g = 0.8f}},
                                     .num_suns = 2,
                                     .mean_cosine = {1, 0.95f}};
    const float(*got)[2] = evaluate(t, &params, points, DEPTHS * ANGLES, 0);
    for (int d = 0; d < DEPTHS; d++) {
        double sum[2] = {0, 0};
        for (int i = d * ANGLES; i < (d + 1) * ANGLES; i++) {
            for (int part = 0; part < 2; part++) {
                sum[part] += 2 * PI * got[i][part] * sin(theta_of(&points[i])) * PI / ANGLES;
            }
        }
        double beam = exp(-taus[d] * (1 - f));
        assert_true(
            within(fabs(sum[1] / beam - f), most[d], NULL, "lobe of a sun at tau %g", taus[d]));
        assert_true(fabs(sum[0] / beam - (1 - f)) < 1e-4);
    }
}

// The same in tables for varying g, between their rows.
static void spread_rows_with_a_sun(void **state)
{
    gpu_test *t = *state;
    static const double gs[] = {-0.4, 0.5, 0.9}, most[] = {0.01, 0.03, 0.026};
    static const double taus[SUN_DEPTHS] = {0, 0.7, 3, 10};
    const double a = 0.995;
    static point points[SUN_DEPTHS * SUN_ANGLES];
    static series s;
    static double fine[FINE + 1];
    tyn_scatter_lut_params params = {
        .mode = TYN_MEDIUM_COEFFICIENTS, .g_max = 0.95f, .num_suns = 1, .mean_cosine = {(float)a}};
    for (size_t n = 0; n < sizeof gs / sizeof *gs; n++) {
        series_make(&s, gs[n]);
        for (int i = 0; i < SUN_DEPTHS * SUN_ANGLES; i++) {
            double root = (i % SUN_ANGLES + 0.3) / SUN_ANGLES, tau = taus[i / SUN_ANGLES];
            points[i] = (point){.tau = (float)tau,
                                .one_minus_mu = away_by(PI * root * root),
                                .g = (float)gs[n],
                                .tau_p = (float)(tau * (1 - s.f)),
                                .cosine = (float)a};
        }
        const float(*got)[2] = evaluate(t, &params, points, SUN_DEPTHS * SUN_ANGLES, 1);
        double worst = 0;
        for (int i = 0; i < SUN_DEPTHS * SUN_ANGLES; i++) {
            if (i % SUN_ANGLES == 0) {
                fine_kernel(&s, taus[i / SUN_ANGLES], fine);
            }
            double expected = over_sun(fine, theta_of(&points[i]), a, false);
            worst = maximum(worst, fabs(got[i][0] + got[i][1] - expected) / expected);
        }
        printf("spread, sun of mean cosine %.3f, g %4.1f: within %.2f %%\n", a, gs[n], 100 * worst);
        assert_true(within(worst, most[n], NULL, "spread row of a sun, g %g", gs[n]));
    }
}

static void refuses_bad_g(void **state)
{
    gpu_test *t = *state;
    static const float bad[] = {1, -1, 2, NAN, INFINITY};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        tyn_scatter_lut_params params = {.mode = TYN_MEDIUM_DENSITY,
                                         .phase = {{.g = 0.5f}, {.g = bad[i]}, {.g = 0.5f}}};
        tyn_ref refs[SCATTER_LUT_NUM_PORTS] = {{0}};
        t->quiet = true;
        tyn_graph_begin(t->graph);
        assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_scatter_lut, &params, refs),
                         TYN_ERR_PARAMS);
        t->quiet = false;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_of_channels),       cmocka_unit_test(single_scattering),
        cmocka_unit_test(sums_over_directions),   cmocka_unit_test(spread_rows),
        cmocka_unit_test(suns_of_finite_size),    cmocka_unit_test(sums_with_a_sun),
        cmocka_unit_test(spread_rows_with_a_sun), cmocka_unit_test(refuses_bad_g),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
