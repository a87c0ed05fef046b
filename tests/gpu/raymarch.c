// raymarch.c -- the ray march against closed forms and a CPU twin.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "passes/raymarch/raymarch.h"
#include "shaders/common/counters.h"
#include <tyndall/extend/view.h>
#include "shaders/beams/beam_args.h"
#include "shaders/phase/scatter_lut_args.h"
#include "random_unit.h"
#include "vector.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { MAX_TEXELS = 16 * 16 * 16 };

// A three-dimensional texture of 1 or 4 channels.
typedef struct texture {
    uint32_t size[3];
    int channels;
    float texels[MAX_TEXELS * 4];
} texture;

// Everything a march reads. One medium of constant coefficients times density, at most one sun.
typedef struct march_scene {
    struct medium_block medium;
    struct shape_block shape;
    struct light_block light;
    struct beam_block beam;
    struct lut_block lut;
    struct camera_block camera;
    struct env_block env;
    texture density, distance, column, inscatter;
    float sums[2]; // the scattering table, constant
    float *host_depth, *surface;
    tyn_raymarch_params params;
} march_scene;

static void make_cube(march_scene *s, float sigma_s, float sigma_a, float g)
{
    memset(s, 0, sizeof *s);
    struct medium_block *m = &s->medium;
    for (int i = 0; i < 3; i++) {
        m->extent[i] = m->voxel[i] = 1.0f;
        m->brick_size[i] = TYN_BRICK;
        m->size[i] = m->bricks[i] = 1;
        m->sigma_s[i] = sigma_s;
        m->sigma_a[i] = sigma_a;
        m->phase[i].g = g;
        s->density.size[i] = s->distance.size[i] = s->column.size[i] = 1;
        s->inscatter.size[i] = 3;
        s->light.color[i] = 1.0f;
        s->light.mean_cosine = 1.0f;
        s->shape.rows[i][i] = 1.0f;
        s->shape.rows[i][3] = -0.5f;
    }
    m->num_shapes = 1;
    m->max_density = 1;
    m->sigma_t_max = sigma_s + sigma_a;
    s->density.channels = s->distance.channels = s->column.channels = 1;
    s->inscatter.channels = 4;
    s->density.texels[0] = s->column.texels[0] = 1.0f;
    s->lut.num_rows = s->lut.num_sets = 1;
    s->lut.phase[0].g = g;
    s->lut.theta_1[0] = 0.4f;
    s->sums[0] = -1.5f;
    s->sums[1] = -2.0f;
    s->camera.size[0] = s->camera.size[1] = 16;
    s->camera.half_width = s->camera.half_height = 0.5f;
    s->camera.orthographic = 1;
    tyn_pass_defaults(&tyn_pass_raymarch, &s->params);
    s->params.grey = 1;
    s->params.sparse = 0; // its twin marches every pixel
    s->params.num_suns = 1;
    s->params.width = s->params.height = 16;
    s->params.num_shapes = 1;
    memcpy(s->params.extent, m->extent, sizeof m->extent);
    const tyn_frame_scene frame = {.medium = *m, .majorant = sigma_s + sigma_a};
    s->params.longest_step = tyn_longest_step(&frame, 0);
}

static void set_sun(march_scene *s, float x, float y, float z)
{
    float d[3] = {x, y, z};
    vector_normalisef(d);
    for (int i = 0; i < 3; i++) {
        s->light.direction[i] = s->beam.direction[i] = d[i];
        s->beam.even = 1; // `column` holds the mean since the entry
        s->beam.rows[i][i] = 1.0f / s->medium.extent[i];
        s->beam.clip_scale[i] = d[i] != 0 ? 1.0f / d[i] : 0;
        s->beam.clip_offset[i] = d[i] == 0 ? 1e30f : d[i] > 0 ? 0 : -s->medium.extent[i] / d[i];
    }
}

// Looks along d at the centre of the box from `distance`.
static void set_camera(march_scene *s, float x, float y, float z, float distance)
{
    float d[3] = {x, y, z}, up[3] = {0, 0, 1};
    vector_normalisef(d);
    if (fabsf(d[2]) > 0.9f) {
        up[1] = 1;
        up[2] = 0;
    }
    float right[3] = {d[1] * up[2] - d[2] * up[1], d[2] * up[0] - d[0] * up[2],
                      d[0] * up[1] - d[1] * up[0]};
    vector_normalisef(right);
    float true_up[3] = {right[1] * d[2] - right[2] * d[1], right[2] * d[0] - right[0] * d[2],
                        right[0] * d[1] - right[1] * d[0]};
    for (int i = 0; i < 3; i++) {
        s->camera.forward[i] = d[i];
        s->camera.right[i] = right[i];
        s->camera.up[i] = true_up[i];
        s->camera.origin[i] = 0.5f * s->medium.extent[i] - distance * d[i];
    }
}

static tyn_ref upload(gpu_test *t, const char *name, const texture *x)
{
    return gpu_image(t, name, TYN_IMAGE_3D, (tyn_extent){x->size[0], x->size[1], x->size[2]},
                     x->channels, x->texels);
}

// As packed_colour.glsl, of whole numbers below 2^17; the words are kept in floats.
static void pack_colour(const float colour[3], float packed[2])
{
    const uint32_t c[3] = {(uint32_t)colour[0], (uint32_t)colour[1], (uint32_t)colour[2]};
    const uint32_t words[2] = {c[0] | c[2] << 18, c[1] | c[2] >> 14 << 18 | (127u + 17u) << 22};
    memcpy(packed, words, sizeof words);
}

static void run(gpu_test *t, march_scene *s)
{
    tyn_graph_begin(t->graph);
    texture *table = calloc(1, sizeof *table);
    *table = (texture){.size = {2, 2, 1}, .channels = 2};
    for (int i = 0; i < 4; i++) {
        memcpy(table->texels + 2 * i, s->sums, sizeof s->sums);
    }
    tyn_ref refs[TYN_MAX_PORTS] = {
        [RAYMARCH_PORT_MEDIUM] = gpu_buffer(t, "medium", &s->medium, sizeof s->medium),
        [RAYMARCH_PORT_DENSITY] = upload(t, "density", &s->density),
        [RAYMARCH_PORT_DISTANCE] = upload(t, "distance", &s->distance),
        [RAYMARCH_PORT_SHAPES] = gpu_buffer(t, "shapes", &s->shape, sizeof s->shape),
        [RAYMARCH_PORT_LIGHTS] = gpu_buffer(t, "lights", &s->light, sizeof s->light),
        [RAYMARCH_PORT_BEAMS] = gpu_buffer(t, "beams", &s->beam, sizeof s->beam),
        [RAYMARCH_PORT_COLUMN] = upload(t, "column", &s->column),
        [RAYMARCH_PORT_CAMERA] = gpu_buffer(t, "camera", &s->camera, sizeof s->camera),
        [RAYMARCH_PORT_ENVIRONMENT] = gpu_buffer(t, "environment", &s->env, sizeof s->env),
    };
    if (s->params.kernels) {
        refs[RAYMARCH_PORT_LUT] =
            gpu_image(t, "lut", TYN_IMAGE_2D, (tyn_extent){2, 2, 1}, 2, table->texels);
        refs[RAYMARCH_PORT_LUT_BLOCK] = gpu_buffer(t, "lut_block", &s->lut, sizeof s->lut);
    }
    if (s->inscatter.texels[0] > 0) {
        refs[RAYMARCH_PORT_INSCATTER] = upload(t, "inscatter", &s->inscatter);
    }
    if (s->host_depth) {
        refs[RAYMARCH_PORT_HOST_DEPTH] =
            gpu_image(t, "host_depth", TYN_IMAGE_2D,
                      (tyn_extent){s->params.width, s->params.height, 1}, 1, s->host_depth);
    }
    if (s->surface) {
        const tyn_extent size = {16, 16, 1};
        float distances[16 * 16], packed[16 * 16][2];
        for (int i = 0; i < 16 * 16; i++) {
            const float *of = s->surface + 4 * i;
            distances[i] = of[3] < INFINITY ? of[3] : 0;
            pack_colour(of, packed[i]);
        }
        refs[RAYMARCH_PORT_SURFACE] = gpu_image(t, "surface", TYN_IMAGE_2D, size, -2, packed[0]);
        refs[RAYMARCH_PORT_DISTANCES] = gpu_image(t, "distances", TYN_IMAGE_2D, size, 1, distances);
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_raymarch, &s->params, refs), TYN_OK);
    for (uint8_t p = RAYMARCH_PORT_RADIANCE; p < RAYMARCH_NUM_PORTS; p++) {
        if (refs[p].resource) {
            tyn_graph_output(t->graph, tyn_pass_raymarch.ports[p].name, refs[p], true);
        }
    }
    gpu_run(t);
    free(table);
}

static const float *pixel(gpu_test *t, const march_scene *s, const char *name, uint32_t x,
                          uint32_t y)
{
    return (const float *)gpu_map(t, name) + 4 * (y * s->params.width + x);
}

static double hg(double g, double mu)
{
    return (1 - g * g) / (4 * PI * pow(1 + g * g - 2 * g * mu, 1.5));
}

static void assert_close(double value, double expected, double relative, const char *what)
{
    const double most = relative * fabs(expected) + 1e-7;
    if (!(relative > 1e-4
              ? within(fabs(value - expected), most, BOUND_FILTER, "%s within %g", what, relative)
              : fabs(value - expected) <= most)) {
        fail_msg("%s: %.8g instead of %.8g", what, value, expected);
    }
}

// What a transmittance of 1, an exponential of 0, is off by.
static double of_nothing(const gpu_test *t)
{
    return gpu_ulps(t, GPU_EXP(0.0));
}

// Light along +x through the unit cube; views from the side, against the light and with it.
static void single_scattering(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    const float gs[] = {-0.5f, 0, 0.5f, 0.9f};
    for (int k = 0; k < 4; k++) {
        const double g = gs[k], sigma = 4;
        for (int colour = 0; colour < 2; colour++) {
            make_cube(s, 4, 0, gs[k]);
            s->params.grey = !colour;
            set_sun(s, 1, 0, 0);
            set_camera(s, 0, -1, 0, 3);
            run(t, s);
            // Pixels of the side view run along -x, as right = forward x up.
            const float *p = pixel(t, s, "radiance", 3, 7);
            double x = 1 - 3.5 / 16;
            assert_close(p[0], sigma * hg(g, 0) * exp(-sigma * x) * (1 - exp(-sigma)) / sigma, 1e-5,
                         "side");
            assert_close(p[3], 1 - exp(-sigma), 1e-5, "alpha");
            set_camera(s, -1, 0, 0, 3);
            run(t, s);
            assert_close(pixel(t, s, "radiance", 5, 5)[1], sigma * hg(g, 1) * exp(-sigma), 2e-3,
                         "against the light");
            set_camera(s, 1, 0, 0, 3);
            run(t, s);
            assert_close(pixel(t, s, "radiance", 5, 5)[2],
                         sigma * hg(g, -1) * (1 - exp(-2 * sigma)) / (2 * sigma), 2e-3,
                         "with the light");
        }
    }
    free(s);
}

// ---- the twin ---------------------------------------------------------------------------------

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
    double theta = 2 * asin(fmin(sqrt(turn) / 2, 1)), p = hg(g, 1 - turn / 2);
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
    make_cube(s, 3, 0.5f, 0.6f);
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
    set_sun(s, 0.4f, -0.5f, 0.8f);
    set_camera(s, -0.7f, 0.5f, -0.3f, 4);
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
                assert_close(pixel(t, s, "radiance", x, y)[c], r.radiance, tolerance, "radiance");
                assert_close(pixel(t, s, "single", x, y)[c], r.single, tolerance, "single");
                assert_close(pixel(t, s, "multiple", x, y)[c], r.radiance - r.single, 2 * tolerance,
                             "multiple");
                assert_close(pixel(t, s, "transmittance", x, y)[c], r.transmittance, tolerance,
                             "transmittance");
                float half = pixel(t, s, "depth", x, y)[1];
                if (s->params.grey) {
                    assert_true(r.half == INFINITY ? isinf(half)
                                                   : within(fabs(half - r.half), 1e-2, BOUND_FILTER,
                                                            "half distance"));
                }
                assert_true(isinf(pixel(t, s, "depth", x, y)[0]));
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
    run(*state, s);
    compare_with_twin(*state, s, 2e-3);
    // Perspective, from inside.
    s->camera.orthographic = 0;
    set_camera(s, -0.7f, 0.5f, -0.3f, 0.1f);
    run(*state, s);
    compare_with_twin(*state, s, 2e-3);
    free(s);
}

static void lumps_colour(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    make_lumps(s);
    run(t, s);
    float grey[16 * 16 * 4];
    memcpy(grey, gpu_map(t, "radiance"), sizeof grey);
    s->params.grey = 0;
    run(t, s);
    const float *colour = gpu_map(t, "radiance");
    for (int i = 0; i < 16 * 16 * 4; i++) {
        assert_close(colour[i], grey[i], 1e-5, "both kernels");
    }
    const float sigma_s[3] = {3, 2, 5}, sigma_a[3] = {0.5f, 1, 0};
    memcpy(s->medium.sigma_s, sigma_s, sizeof sigma_s);
    memcpy(s->medium.sigma_a, sigma_a, sizeof sigma_a);
    run(t, s);
    compare_with_twin(t, s, 2e-3);
    free(s);
}

// Skipping empty bricks changes nothing; a step of one voxel is nearly as good as a tenth.
static void skipping(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    make_lumps(s);
    run(t, s);
    float fine[16 * 16 * 4];
    memcpy(fine, gpu_map(t, "radiance"), sizeof fine);
    uint32_t skipped = ((const struct counters_block *)gpu_map(t, "counters"))->steps;
    s->distance.texels[3] = 0;
    run(t, s);
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
    run(t, s);
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
    run(t, s);
    memcpy(still, gpu_map(t, "radiance"), sizeof still);
    double before = 0;
    for (int k = 0; k < 3; k++) {
        s->params.noise = 0.05f * (float)(1 << 2 * k);
        s->params.noise_size = 4;
        run(t, s);
        memcpy(moved, gpu_map(t, "radiance"), sizeof moved);
        const double off = apart(moved, still);
        print_message("noise of %.2f voxels: %.2f %%\n", (double)s->params.noise, 100 * off);
        assert_true(off > 1.5 * before && off > 1e-4);
        before = off;
    }
    s->params.noise = 7;
    run(t, s);
    memcpy(moved, gpu_map(t, "radiance"), sizeof moved);
    s->distance.texels[3] = 0;
    run(t, s);
    assert_true(apart(gpu_map(t, "radiance"), moved) < 2e-3);
    for (int i = 0; i < 12 * 8 * 16; i++) {
        s->density.texels[i] = 1;
    }
    for (int i = 0; i < 5 * 4 * 6 * 4; i++) {
        s->inscatter.texels[i] = 0.2f;
    }
    run(t, s);
    memcpy(moved, gpu_map(t, "radiance"), sizeof moved);
    s->params.noise = 0;
    run(t, s);
    assert_true(apart(gpu_map(t, "radiance"), moved) < 1e-6);
    free(s);
}

// Uniform surroundings of radiance 1 and no absorption: every pixel is 1, at any depth and g.
static void furnace(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    const float sigmas[] = {1e-4f, 0.1f, 4, 300};
    for (int k = 0; k < 8; k++) {
        make_cube(s, sigmas[k / 2], 0, k % 2 ? 0.9f : 0.0f);
        s->params.num_suns = 0;
        s->params.mean = s->params.background = 1;
        s->params.layers = RAYMARCH_LAYER_TRANSMITTANCE | RAYMARCH_LAYER_MULTIPLE;
        for (int i = 0; i < 3; i++) {
            s->env.radiance[i] = s->env.sky[i] = 1;
        }
        for (int i = 0; i < 27 * 4; i++) {
            s->inscatter.texels[i] = 1;
        }
        set_camera(s, 0.3f, 0.5f, -0.6f, 3);
        s->camera.half_width = s->camera.half_height = 0.9f;
        run(t, s);
        for (uint32_t i = 0; i < 16 * 16; i++) {
            const float *p = pixel(t, s, "radiance", i % 16, i / 16);
            assert_close(p[0], 1, 2e-4, "furnace");
            assert_close(p[3], 1, 0, "alpha");
            double behind = pixel(t, s, "transmittance", i % 16, i / 16)[0];
            assert_close(pixel(t, s, "multiple", i % 16, i / 16)[0] + behind, 1, 2e-4,
                         "multiple + background");
        }
    }
    free(s);
}

// The tail behind transmittance 1e-3 is not lost, and what is behind the medium is attenuated to
// the end.
static void opaque(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    make_cube(s, 0, 9, 0);
    s->params.num_suns = 0;
    s->params.emissive = 1;
    s->params.stop = 0.1f;
    s->medium.emission[0] = s->medium.emission[1] = s->medium.emission[2] = 9;
    set_camera(s, 0, 1, 0, 3);
    s->params.layers = RAYMARCH_LAYER_TRANSMITTANCE;
    run(t, s);
    assert_close(pixel(t, s, "radiance", 8, 8)[0], 1, 2e-3, "emission");
    assert_close(pixel(t, s, "transmittance", 8, 8)[0], exp(-9), 1e-4, "transmittance");
    free(s);
}

// Where one channel is much denser than another, that one is still seen through.
static void opaque_in_one_colour(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    static const float dense[] = {2, 5, 20};
    for (int i = 0; i < 3; i++) {
        make_cube(s, 0, 11, 0);
        s->params.num_suns = s->params.grey = 0;
        s->medium.sigma_a[1] = s->medium.sigma_a[2] = 11 * dense[i];
        s->medium.sigma_t_max = 11 * dense[i];
        set_camera(s, 0, 1, 0, 3);
        s->params.layers = RAYMARCH_LAYER_TRANSMITTANCE;
        run(t, s);
        assert_close(pixel(t, s, "transmittance", 8, 8)[0], exp(-11), 1e-3, "transmittance");
    }
    free(s);
}

static void host_depth(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    make_cube(s, 2, 0, 0);
    set_sun(s, 0, 0, -1);
    set_camera(s, 0, 1, 0, 2); // the box is from 1.5 to 2.5
    s->camera.orthographic = 0;
    s->params.layers = RAYMARCH_LAYER_TRANSMITTANCE | RAYMARCH_LAYER_DEPTH;
    s->params.background = 1;
    s->env.radiance[0] = 100;
    // A reversed infinite projection: depth = near / distance.
    float depth[16 * 16], view_to_clip[4] = {0, 0.1f, -1, 0};
    for (int i = 0; i < 256; i++) {
        depth[i] = i % 16 < 8 ? 0.1f / 2.0f : 0;
    }
    s->host_depth = depth;
    memcpy(s->params.depth, view_to_clip, sizeof view_to_clip);
    run(t, s);
    // Pixel (7, 7) looks nearly straight ahead.
    double l = sqrt(1 + 2 * pow(0.5 / 16, 2));
    assert_close(pixel(t, s, "depth", 7, 7)[0], 2 * l, 1e-5, "surface");
    assert_close(pixel(t, s, "transmittance", 7, 7)[0], exp(-2 * 0.5 * l), 1e-4, "half the box");
    assert_true(pixel(t, s, "radiance", 7, 7)[0] < 2); // the environment is hidden
    assert_close(pixel(t, s, "transmittance", 8, 8)[0], exp(-2 * l), 1e-4, "the whole box");
    assert_true(isinf(pixel(t, s, "depth", 8, 8)[0]));
    assert_true(pixel(t, s, "radiance", 8, 8)[0] > 10);
    free(s);
}

// A host's depth image with a slanting floor, holes and a comb of single pixels, of which one ray for four pixels sees little: the
// march at a lower resolution ends at the same depths, and shows what is behind where nothing is.
static void host_depth_sparse(void **state)
{
    enum { SIZE = 64, N = SIZE * SIZE };
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    static float depth[N], all[N][4], parted[N][4];
    for (int i = 0; i < N; i++) {
        const int x = i % SIZE, y = i / SIZE;
        const float away = 1.6f + 0.8f * (float)y / SIZE; // from the front of the box to its back
        const bool hole = x / 16 % 2 && y / 16 % 2, comb = y > 48 && x % 5 == 0;
        depth[i] = hole || comb ? 0 : 0.1f / away;
    }
    for (int i = 0; i < 3; i++) { // every pixel; at a lower resolution by two kernels; by one
        make_cube(s, 2, 0.5f, 0.4f);
        set_sun(s, 0.3f, 0.5f, -1);
        set_camera(s, 0, 1, 0, 2); // the box is from 1.5 to 2.5
        s->camera.orthographic = 0;
        s->camera.size[0] = s->camera.size[1] = s->params.width = s->params.height = SIZE;
        s->params.background = 1;
        s->params.sparse = i > 0;
        s->params.parted = i == 1;
        s->env.radiance[0] = 3;
        s->host_depth = depth;
        memcpy(s->params.depth, (float[]){0, 0.1f, -1, 0}, sizeof s->params.depth);
        run(t, s);
        if (i < 2) {
            memcpy(i ? parted : all, pixel(t, s, "radiance", 0, 0), sizeof all);
        }
    }
    assert_memory_equal(parted, pixel(t, s, "radiance", 0, 0), sizeof parted);
    const float(*found)[4] = (const float(*)[4])pixel(t, s, "radiance", 0, 0);
    double sum = 0, apart = 0, worst = 0;
    int differ = 0;
    for (int i = 0; i < N; i++) {
        const double off = fabs((double)found[i][0] - (double)all[i][0]);
        sum += (double)all[i][0];
        apart += off;
        worst = maximum(worst, off / ((double)all[i][0] + 0.01));
        differ += off > 0;
    }
    print_message("under a host's depth %.3f %% off, a pixel at most %.2f %%; %d of %d differ\n",
                  100 * apart / sum, 100 * worst, differ, N);
    assert_within(apart / sum, 0.0009, NULL);
    // Most where rays through a hole leave by the box's rim.
    assert_within(worst, 0.2, NULL);
    assert_true(differ > N / 30); // else nothing was saved
    free(s);
}

// Light of first and of higher orders at a lower resolution, where it may be, against a ray in every pixel.
static void layers_sparse(void **state)
{
    enum { SIZE = 64, N = SIZE * SIZE };
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    static const char *const names[] = {"radiance", "single", "multiple"};
    static const double bounds[] = {0.004, 0.012, 0.003};
    static float all[3][N][4];
    for (uint32_t sparse = 0; sparse < 2; sparse++) {
        make_cube(s, 2, 0.5f, 0.4f);
        set_sun(s, 0.3f, 0.5f, -1);
        set_camera(s, 0.2f, 1, 0.1f, 2);
        s->camera.orthographic = 0;
        s->camera.size[0] = s->camera.size[1] = s->params.width = s->params.height = SIZE;
        s->params.layers = RAYMARCH_LAYER_SINGLE | RAYMARCH_LAYER_MULTIPLE;
        s->params.sparse = 1;
        s->params.sparse_layers = sparse;
        for (int i = 0; i < 4 * 27; i++) {
            s->inscatter.texels[i] = 0.25f;
        }
        run(t, s);
        for (int k = 0; k < 3 && !sparse; k++) {
            memcpy(all[k], pixel(t, s, names[k], 0, 0), sizeof all[k]);
        }
    }
    for (int k = 0; k < 3; k++) {
        const float(*found)[4] = (const float(*)[4])pixel(t, s, names[k], 0, 0);
        double sum = 0, apart = 0;
        int differ = 0;
        for (int i = 0; i < N; i++) {
            sum += (double)all[k][i][0];
            apart += fabs((double)found[i][0] - (double)all[k][i][0]);
            differ += found[i][0] != all[k][i][0];
        }
        print_message("%s at a lower resolution %.3f %% off; %d of %d differ\n", names[k],
                      100 * apart / sum, differ, N);
        assert_within(apart / sum, bounds[k], NULL);
        assert_true(differ > N / 30); // else nothing was saved
    }
    free(s);
}

// The left half of the image has a surface in the middle of the box: what it sends is seen through the
// medium in front of it, and with what that scatters forward; no light comes from behind it.
static void surfaces(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    const double sigma_s = 1.5, sigma_a = 0.5, g = 0.6;
    make_cube(s, (float)sigma_s, (float)sigma_a, (float)g);
    set_camera(s, 0, 1, 0, 2); // the box is from 1.5 to 2.5
    s->params.num_suns = 0;
    s->params.layers = RAYMARCH_LAYER_TRANSMITTANCE | RAYMARCH_LAYER_DEPTH;
    s->params.surfaces = 1;
    s->camera.half_width = s->camera.half_height = 0.8f; // the outermost pixels miss the box
    tyn_raymarch_window(&s->params, &s->camera);
    float surface[16 * 16][4] = {{0}};
    for (int i = 0; i < 256; i++) {
        surface[i][1] = 3;
        surface[i][3] = i % 16 < 8 ? 2.0f : INFINITY;
    }
    s->surface = surface[0];
    double forward = g * g * sigma_s, seen = 3 * exp(-0.5 * (sigma_s + sigma_a - forward));
    for (int background = 0; background < 2; background++) {
        s->params.background = (uint32_t)background;
        s->env.radiance[0] = 7;
        run(t, s);
        const float *p = pixel(t, s, "radiance", 5, 8);
        assert_true(p[0] == 0 && p[2] == 0 && fabs((double)p[3] - 1) <= of_nothing(t));
        assert_close(p[1], seen, 1e-4, "through half the box");
        assert_close(pixel(t, s, "transmittance", 5, 8)[1], exp(-0.5 * 2), 1e-4, "half the box");
        const double off_depth = 2 * gpu_ulps(t, GPU_ROOT); // a distance is a root
        assert_true(fabs((double)pixel(t, s, "depth", 5, 8)[0] - 2) <= off_depth);
        p = pixel(t, s, "radiance", 1, 1);
        assert_true(p[0] == 0 && fabs((double)p[1] - 3) <= 3 * of_nothing(t) &&
                    fabs((double)p[3] - 1) <= of_nothing(t) &&
                    fabs((double)pixel(t, s, "depth", 1, 1)[0] - 2) <= off_depth);
        p = pixel(t, s, "radiance", 9, 8);
        assert_close(p[0], background ? 7 * exp(-2) : 0, 1e-4, "environment");
        assert_close(p[3], background ? 1 : 1 - exp(-2), 1e-4, "cover");
        assert_true(isinf(pixel(t, s, "depth", 9, 8)[0]));
    }
    s->params.background = s->params.surfaces = 0;
    run(t, s);
    const float *p = pixel(t, s, "radiance", 5, 8);
    assert_close(p[1], seen - 3 * exp(-0.5 * 2), 1e-4, "scattered forward alone");
    assert_close(p[3], 1 - exp(-0.5 * 2), 1e-4, "cover of the medium");
    p = pixel(t, s, "radiance", 1, 1);
    assert_true(fabs((double)p[1]) <= 3 * of_nothing(t) && fabs((double)p[3]) <= of_nothing(t));
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
    run(t, s);
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

// A sphere in the box: pixels on its outline are averaged over four rays.
static void antialias(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    make_cube(s, 2, 0, 0);
    s->shape.kind = s->params.kind = TYN_SHAPE_KIND_SPHERE;
    set_sun(s, 1, 0, 0);
    set_camera(s, 0.1f, 1, 0.2f, 3);
    run(t, s);
    uint32_t four = ((const struct counters_block *)gpu_map(t, "counters"))->steps;
    s->params.antialias = 0;
    run(t, s);
    uint32_t one = ((const struct counters_block *)gpu_map(t, "counters"))->steps;
    print_message("steps with one ray a pixel: %u, with four at the outline: %u\n", one, four);
    // The outline of a circle of 16 pixels' diameter passes between the quarters of about 30 pixels.
    assert_true(four > one * 1.2 && four < one * 1.6);
    free(s);
}

static void nothing(void **state)
{
    gpu_test *t = *state;
    march_scene *s = calloc(1, sizeof *s);
    make_cube(s, 0, 0, 0);
    set_camera(s, 0, 1, 0, 3);
    s->env.radiance[2] = 0.5f;
    s->params.num_suns = 0;
    s->params.background = 1;
    for (int i = 0; i < 3; i++) {
        s->medium.extent[i] = 0;
    }
    tyn_graph_begin(t->graph);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [RAYMARCH_PORT_MEDIUM] = gpu_buffer(t, "medium", &s->medium, sizeof s->medium),
        [RAYMARCH_PORT_SHAPES] = gpu_buffer(t, "shapes", &s->shape, sizeof s->shape),
        [RAYMARCH_PORT_LIGHTS] = gpu_buffer(t, "lights", &s->light, sizeof s->light),
        [RAYMARCH_PORT_CAMERA] = gpu_buffer(t, "camera", &s->camera, sizeof s->camera),
        [RAYMARCH_PORT_ENVIRONMENT] = gpu_buffer(t, "environment", &s->env, sizeof s->env),
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_raymarch, &s->params, refs), TYN_OK);
    tyn_graph_output(t->graph, "radiance", refs[RAYMARCH_PORT_RADIANCE], true);
    gpu_run(t);
    for (uint32_t i = 0; i < 256; i++) {
        const float *p = pixel(t, s, "radiance", i % 16, i / 16);
        assert_true(p[0] == 0 && fabs((double)p[2] - 0.5) <= 0.5 * of_nothing(t) &&
                    fabs((double)p[3] - 1) <= of_nothing(t));
    }
    free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(single_scattering),
        cmocka_unit_test(lumps_grey),
        cmocka_unit_test(lumps_colour),
        cmocka_unit_test(skipping),
        cmocka_unit_test(noise),
        cmocka_unit_test(furnace),
        cmocka_unit_test(opaque),
        cmocka_unit_test(surfaces),
        cmocka_unit_test(host_depth),
        cmocka_unit_test(host_depth_sparse),
        cmocka_unit_test(layers_sparse),
        cmocka_unit_test(bad_density),
        cmocka_unit_test(opaque_in_one_colour),
        cmocka_unit_test(antialias),
        cmocka_unit_test(nothing),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
