// raymarch_lumps.c -- the ray march of a lumpy medium against a CPU twin, and what it skips, moves and refuses there.
#include "raymarch_stage.h"
#include "bound.h"
#include "numbers.h"
#include "random_unit.h"
#include "shaders/common/counters.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static double sample(const texture *x, const double uvw[3], int channel)
{
    int i[3];
    double f[3];
    for (int a = 0; a < 3; a++) {
        double p = uvw[a] * x->size[a] - 0.5;
        p = fmin(fmax(p, 0), x->size[a] - 1.0);
        i[a] = (int)fmin(floor(p), x->size[a] > 1 ? x->size[a] - 2.0 : 0);
        f[a] = p - i[a];
    }
    double sum = 0;
    for (int c = 0; c < 8; c++) {
        double w = 1;
        size_t at[3];
        for (int a = 0; a < 3; a++) {
            int up = c >> a & 1;
            w *= up ? f[a] : 1 - f[a];
            at[a] = (size_t)(i[a] + up) < x->size[a] ? (size_t)(i[a] + up) : x->size[a] - 1;
        }
        sum += w *
               x->texels[((at[2] * x->size[1] + at[1]) * x->size[0] + at[0]) * (size_t)x->channels +
                         (size_t)channel];
    }
    return sum;
}

// By how much a read is off at most of which the coordinate is off by `shift` texels along each axis.
static double sample_error(const texture *x, const double uvw[3], int channel, double shift)
{
    const double exact = sample(x, uvw, channel);
    double most = 0;
    for (int k = 0; k < 8; k++) {
        double off[3];
        for (int a = 0; a < 3; a++) {
            off[a] = uvw[a] + (k >> a & 1 ? shift : -shift) / x->size[a];
        }
        most = maximum(most, fabs(sample(x, off, channel) - exact));
    }
    return most;
}

typedef struct twin_result {
    double radiance, single, transmittance, scaled, half;
    double off_radiance, off_transmittance; // if each read is off by itself
} twin_result;

// Light of the sun, per density of the medium, that goes to the eye behind `column`, through e^-tau' and e^-tau.
static double sunlight(const march_scene *s, int c, double column, double p, double h,
                       double scaled, double whole)
{
    double g = s->medium.phase[c].g, f = g > 0 ? g * g : 0;
    double tau_s = column * s->medium.sigma_s[c], tau_a = column * s->medium.sigma_a[c];
    double light = s->light.color[c] * s->medium.sigma_s[c] * exp(-tau_a);
    double forward = f * (1 - exp(-tau_s)) * exp(-tau_s * (1 - f));
    double k_tms = p * (1 - h) * exp(-tau_s) + forward * exp(s->sums[0]);
    double k_lobe = p * h * exp(-tau_s) + forward * exp(s->sums[1]);
    return light * (k_tms * scaled + k_lobe * whole);
}

// One ray in small steps, channel c; if coordinates of reads are off by `shift` texels, in steps of the march.
static twin_result twin(const march_scene *s, const double o[3], const double d[3], int c,
                        double shift)
{
    twin_result r = {.transmittance = 1, .scaled = 1, .half = INFINITY};
    double off_sources = 0, off_tau = 0; // sums of squares
    double begin = 0, end = 1e30;
    for (int a = 0; a < 3; a++) {
        double t0 = (0 - o[a]) / d[a], t1 = (s->medium.extent[a] - o[a]) / d[a];
        begin = fmax(begin, fmin(t0, t1));
        end = fmin(end, fmax(t0, t1));
    }
    double g = s->medium.phase[c].g, f = g > 0 ? g * g : 0, turn = 0;
    for (int a = 0; a < 3; a++) {
        turn += pow(-d[a] - s->light.direction[a], 2);
    }
    double theta = 2 * asin(fmin(sqrt(turn) / 2, 1)), p = march_hg(g, 1 - turn / 2);
    double x = fmin(fmax(theta / s->lut.theta_1[0] - 0.5, 0), 1), h = 1 - x * x * (3 - 2 * x);
    const double step = (double)(s->params.step * s->medium.voxel[0]);
    const int steps = shift > 0 && begin < end ? (int)ceil((end - begin) / step) : 4000;
    double ds = (end - begin) / steps;
    for (int i = 0; i < steps && begin < end; i++) {
        double q[3], uvw[3], field[3], path = 1e30, at = begin + (i + 0.5) * ds;
        double longest = fmax(s->medium.extent[0], fmax(s->medium.extent[1], s->medium.extent[2]));
        int most = (int)s->inscatter.size[0] - 2;
        for (int a = 1; a < 3; a++) {
            most = (int)s->inscatter.size[a] - 2 > most ? (int)s->inscatter.size[a] - 2 : most;
        }
        for (int a = 0; a < 3; a++) {
            q[a] = o[a] + at * d[a];
            uvw[a] = q[a] / s->medium.extent[a];
            double dx = longest / most, cells = s->inscatter.size[a] - 2.0;
            double origin = 0.5 * (s->medium.extent[a] - cells * dx);
            field[a] = ((q[a] - origin) / dx + 1) / s->inscatter.size[a];
            double l = s->light.direction[a] > 0 ? q[a] / s->light.direction[a]
                       : s->light.direction[a] < 0
                           ? (q[a] - s->medium.extent[a]) / s->light.direction[a]
                           : 1e30;
            path = fmin(path, l);
        }
        double rho = sample(&s->density, uvw, 0);
        double sigma_s = s->medium.sigma_s[c] * rho, sigma_a = s->medium.sigma_a[c] * rho;
        double column = path * sample(&s->column, uvw, 0);
        double tau_s = column * s->medium.sigma_s[c], tau_a = column * s->medium.sigma_a[c];
        double w = r.transmittance * exp(-(sigma_s + sigma_a) * ds / 2) * ds;
        double w_scaled = r.scaled * exp(-(sigma_s * (1 - f) + sigma_a) * ds / 2) * ds;
        double light = s->light.color[c] * sigma_s * exp(-tau_a), once = light * p * exp(-tau_s);
        double source = 0; // per density
        r.single += once * w;
        if (s->params.kernels) {
            source = sunlight(s, c, column, p, h, w_scaled, w);
        } else {
            r.radiance += once * w;
        }
        if (s->inscatter.texels[0] > 0) {
            source += s->medium.sigma_s[c] * (1 - f) * sample(&s->inscatter, field, c) * w_scaled;
        }
        if (s->params.emissive) {
            source += s->medium.emission[c] * w_scaled;
        }
        r.radiance += source * rho;
        if (shift > 0) { // of the density here and before, of the sun's depth, of the field
            const double off = sample_error(&s->density, uvw, 0, shift);
            const double off_column = path * sample_error(&s->column, uvw, 0, shift);
            const double ends[2] = {sunlight(s, c, column - off_column, p, h, w_scaled, w),
                                    sunlight(s, c, column + off_column, p, h, w_scaled, w)};
            const double sun = sunlight(s, c, column, p, h, w_scaled, w);
            const double off_field = s->medium.sigma_s[c] * (1 - f) *
                                     sample_error(&s->inscatter, field, c, shift) * w_scaled;
            const double off_sun = maximum(fabs(ends[0] - sun), fabs(ends[1] - sun));
            off_sources += pow(source * off + (rho + off) * (off_sun + off_field), 2);
            off_tau += pow((double)(s->medium.sigma_s[c] + s->medium.sigma_a[c]) * off * ds, 2);
        }
        r.transmittance *= exp(-(sigma_s + sigma_a) * ds);
        r.scaled *= exp(-(sigma_s * (1 - f) + sigma_a) * ds);
        if (r.transmittance <= 0.5 && r.half == INFINITY) {
            r.half = at;
        }
    }
    // Roundings are even between their ends: three standard deviations are sqrt(3) of what all ends come to.
    r.off_radiance = sqrt(3 * off_sources) + r.radiance * sqrt(3 * off_tau);
    r.off_transmittance = r.transmittance * sqrt(3 * off_tau);
    return r;
}

// A lumpy box with a corner that is empty, an oblique sun, everything on.
static void make_lumps(march_scene *s)
{
    march_cube(s, 3, 0.5f, 0.6f);
    const float extent[3] = {1.5f, 1.0f, 2.0f};
    const uint32_t size[3] = {12, 8, 16}, bricks[3] = {2, 1, 2};
    uint32_t seed = 1;
    for (int i = 0; i < 3; i++) {
        s->medium.extent[i] = s->params.extent[i] = extent[i];
        s->medium.size[i] = s->density.size[i] = s->column.size[i] = size[i];
        s->medium.bricks[i] = s->distance.size[i] = bricks[i];
        s->medium.voxel[i] = extent[i] / (float)size[i];
        s->medium.brick_size[i] = s->medium.voxel[i] * TYN_BRICK;
        s->shape.rows[i][i] = 1.0f / extent[i];
    }
    s->inscatter.size[0] = 5; // 3 x 2 x 4 cells of 0.5 m
    s->inscatter.size[1] = 4;
    s->inscatter.size[2] = 6;
    for (uint32_t i = 0; i < 12 * 8 * 16; i++) {
        uint32_t x = i % 12, z = i / 96;
        // Bricks of z >= 8, x >= 8 are empty, with a voxel to spare for the interpolation.
        s->density.texels[i] = x >= 7 && z >= 7 ? 0 : (float)(0.5 + random_unit(&seed));
        s->column.texels[i] = (float)(0.3 + 0.7 * random_unit(&seed));
    }
    s->distance.texels[3] = 1;
    for (uint32_t i = 0; i < 5 * 4 * 6 * 4; i++) {
        s->inscatter.texels[i] = (float)(0.1 + 0.2 * random_unit(&seed));
    }
    const float color[3] = {1.0f, 0.7f, 0.3f}, emission[3] = {0.02f, 0.05f, 0.01f};
    memcpy(s->light.color, color, sizeof color);
    memcpy(s->medium.emission, emission, sizeof emission);
    march_sun(s, 0.4f, -0.5f, 0.8f);
    march_camera(s, -0.7f, 0.5f, -0.3f, 4);
    s->camera.half_width = s->camera.half_height = 0.8f;
    s->params.kernels = s->params.emissive = 1;
    s->params.step = 0.1f;
    s->params.antialias = 0;
    s->params.layers = RAYMARCH_LAYER_TRANSMITTANCE | RAYMARCH_LAYER_DEPTH | RAYMARCH_LAYER_SINGLE |
                       RAYMARCH_LAYER_MULTIPLE;
}

static void ray_of(const march_scene *s, uint32_t x, uint32_t y, double o[3], double d[3])
{
    const uint32_t w = s->params.width;
    double length = 0, su = 2 * (x + 0.5) / w - 1, sv = 1 - 2 * (y + 0.5) / w;
    for (int a = 0; a < 3; a++) {
        double across = su * s->camera.half_width * s->camera.right[a] +
                        sv * s->camera.half_height * s->camera.up[a];
        o[a] = s->camera.origin[a] + (s->camera.orthographic ? across : 0);
        d[a] = s->camera.forward[a] + (s->camera.orthographic ? 0 : across);
        length += d[a] * d[a];
    }
    for (int a = 0; a < 3; a++) {
        d[a] /= sqrt(length);
    }
}

// What texture units may change of a channel of a pixel's radiance and cover.
static double pixel_error(const gpu_test *t, const march_scene *s, int pixel, int channel)
{
    const double shift = gpu_filter_shift(t);
    double o[3], d[3];
    ray_of(s, (uint32_t)pixel % s->params.width, (uint32_t)pixel / s->params.width, o, d);
    const twin_result r = twin(s, o, d, channel % 3, shift);
    return channel == 3 ? r.off_transmittance : r.off_radiance;
}

static void compare_with_twin(gpu_test *t, const march_scene *s, double tolerance)
{
    uint32_t w = s->params.width;
    uint32_t hits = 0;
    for (uint32_t y = 1; y < w; y += 3) {
        for (uint32_t x = 1; x < w; x += 3) {
            double o[3], d[3];
            ray_of(s, x, y, o, d);
            for (int c = 0; c < 3; c++) {
                twin_result r = twin(s, o, d, c, 0);
                hits += r.radiance > 0;
                march_close(march_pixel(t, s, "radiance", x, y)[c], r.radiance, tolerance,
                            "radiance");
                march_close(march_pixel(t, s, "single", x, y)[c], r.single, tolerance, "single");
                march_close(march_pixel(t, s, "multiple", x, y)[c], r.radiance - r.single,
                            2 * tolerance, "multiple");
                march_close(march_pixel(t, s, "transmittance", x, y)[c], r.transmittance, tolerance,
                            "transmittance");
                float half = march_pixel(t, s, "depth", x, y)[1];
                if (s->params.grey) {
                    assert_true(r.half == INFINITY ? isinf(half)
                                                   : within(fabs(half - r.half), 1e-2, BOUND_FILTER,
                                                            "half distance"));
                }
                assert_true(isinf(march_pixel(t, s, "depth", x, y)[0]));
            }
        }
    }
    assert_true(hits > 20);
    const struct counters_block *counters = gpu_map(t, "counters");
    assert_int_equal(counters->non_finite, 0);
    assert_true(counters->pixels > 50 && counters->steps > 20 * counters->pixels);
}

static void lumps_grey(void **state)
{
    march_scene *s = malloc(sizeof *s);
    make_lumps(s);
    march_run(*state, s);
    compare_with_twin(*state, s, 2e-3);
    // Perspective, from inside.
    s->camera.orthographic = 0;
    march_camera(s, -0.7f, 0.5f, -0.3f, 0.1f);
    march_run(*state, s);
    compare_with_twin(*state, s, 2e-3);
    free(s);
}

static void lumps_colour(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    make_lumps(s);
    march_run(t, s);
    float grey[16 * 16 * 4];
    memcpy(grey, gpu_map(t, "radiance"), sizeof grey);
    s->params.grey = 0;
    march_run(t, s);
    const float *colour = gpu_map(t, "radiance");
    for (int i = 0; i < 16 * 16 * 4; i++) {
        march_close(colour[i], grey[i], 1e-5, "both kernels");
    }
    const float sigma_s[3] = {3, 2, 5}, sigma_a[3] = {0.5f, 1, 0};
    memcpy(s->medium.sigma_s, sigma_s, sizeof sigma_s);
    memcpy(s->medium.sigma_a, sigma_a, sizeof sigma_a);
    march_run(t, s);
    compare_with_twin(t, s, 2e-3);
    free(s);
}

// Skipping empty bricks changes nothing; a step of one voxel is nearly as good as a tenth.
static void skipping(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    make_lumps(s);
    march_run(t, s);
    float fine[16 * 16 * 4];
    memcpy(fine, gpu_map(t, "radiance"), sizeof fine);
    uint32_t skipped = ((const struct counters_block *)gpu_map(t, "counters"))->steps;
    s->distance.texels[3] = 0;
    march_run(t, s);
    uint32_t all = ((const struct counters_block *)gpu_map(t, "counters"))->steps;
    assert_true(skipped < all * 0.95);
    const float *marched = gpu_map(t, "radiance");
    for (int i = 0; i < 16 * 16 * 4; i++) {
        // Places of reads differ: both pictures are off.
        const double off = gpu_filter_shift(t) > 0 ? 2 * pixel_error(t, s, i / 4, i % 4) : 0;
        const double apart = fabs((double)marched[i] - (double)fine[i]);
        assert_true(
            within(apart, 5e-4 * (double)fabsf(fine[i]) + 1e-7 + off, NULL, "without skipping"));
    }
    s->params.step = 1;
    march_run(t, s);
    double sum = 0, off = 0;
    marched = gpu_map(t, "radiance");
    for (int i = 0; i < 16 * 16 * 4; i++) {
        sum += fine[i];
        off += fabs(marched[i] - fine[i]);
    }
    print_message("one voxel a step: %.2f %% off a tenth of it\n", 100 * off / sum);
    assert_within(off / sum, 5e-4, NULL); // white noise in the voxels is the worst case
    free(s);
}

static double apart(const float *a, const float *b)
{
    double sum = 0, off = 0;
    for (int i = 0; i < 16 * 16 * 4; i++) {
        sum += (double)fabsf(b[i]);
        off += (double)fabsf(a[i] - b[i]);
    }
    return off / sum;
}

// Noise on the places of medium and light: the more the farther off, nothing where both are even, and what it moves into
// an empty brick is not skipped.
static void noise(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    float still[16 * 16 * 4], moved[16 * 16 * 4];
    make_lumps(s);
    s->params.step = 0.25f;
    march_run(t, s);
    memcpy(still, gpu_map(t, "radiance"), sizeof still);
    double before = 0;
    for (int k = 0; k < 3; k++) {
        s->params.noise = 0.05f * (float)(1 << 2 * k);
        s->params.noise_size = 4;
        march_run(t, s);
        memcpy(moved, gpu_map(t, "radiance"), sizeof moved);
        const double off = apart(moved, still);
        print_message("noise of %.2f voxels: %.2f %%\n", (double)s->params.noise, 100 * off);
        assert_true(off > 1.5 * before && off > 1e-4);
        before = off;
    }
    s->params.noise = 7;
    march_run(t, s);
    memcpy(moved, gpu_map(t, "radiance"), sizeof moved);
    s->distance.texels[3] = 0;
    march_run(t, s);
    assert_true(apart(gpu_map(t, "radiance"), moved) < 2e-3);
    for (int i = 0; i < 12 * 8 * 16; i++) {
        s->density.texels[i] = 1;
    }
    for (int i = 0; i < 5 * 4 * 6 * 4; i++) {
        s->inscatter.texels[i] = 0.2f;
    }
    march_run(t, s);
    memcpy(moved, gpu_map(t, "radiance"), sizeof moved);
    s->params.noise = 0;
    march_run(t, s);
    assert_true(apart(gpu_map(t, "radiance"), moved) < 1e-6);
    free(s);
}

static void bad_density(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    make_lumps(s);
    s->density.texels[500] = NAN;
    s->density.texels[300] = -1e5f;
    s->inscatter.texels[40] = INFINITY;
    march_run(t, s);
    for (int k = 0; k < 4; k++) {
        const char *const names[] = {"radiance", "single", "multiple", "transmittance"};
        const float *p = gpu_map(t, names[k]);
        for (int i = 0; i < 16 * 16 * 4; i++) {
            assert_true(isfinite(p[i]) && p[i] >= 0);
        }
    }
    assert_true(((const struct counters_block *)gpu_map(t, "counters"))->non_finite > 0);
    free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lumps_grey), cmocka_unit_test(lumps_colour), cmocka_unit_test(skipping),
        cmocka_unit_test(noise),      cmocka_unit_test(bad_density),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
