// shdom.c -- spherical harmonics and discrete ordinates, channel by channel.
#include "shdom.h"
#include "shdom_args.h"
#include "shaders/common/counters.h"
#include "shaders/light/ordinate_args.h"
#include "passes/shdom_tables.h"
#include <math.h>

#define PORT(name) SHDOM_PORT_##name

// What a storage buffer may have on any device; a batch of ordinates stays below a quarter of that.
static const uint64_t max_bytes = 128u << 20, batch_bytes = 32u << 20;

// ---- the quadrature ---------------------------------------------------------------------------

// Gauss-Legendre, by zeniths, times twice as many azimuths: products of two harmonics of `bands` bands are integrated
// exactly.
static uint32_t num_zeniths(const tyn_shdom_params *p)
{
    return p->bands < SHDOM_LEAST_ZENITHS ? SHDOM_LEAST_ZENITHS : (uint32_t)p->bands;
}

static uint32_t num_ordinates(const tyn_shdom_params *p)
{
    return 2 * num_zeniths(p) * num_zeniths(p);
}

// A root of the Legendre polynomial of degree n, and its weight; Newton's method from an estimate.
static double gauss_legendre(uint32_t n, uint32_t i, double *weight)
{
    double x = cos(M_PI * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int round = 0; round < 20; round++) {
        double before = 1, value = x;
        for (uint32_t l = 2; l <= n; l++) {
            const double next = ((2.0 * l - 1) * x * value - (l - 1.0) * before) / l;
            before = value;
            value = next;
        }
        slope = n * (x * value - before) / (x * x - 1);
        x -= value / slope;
    }
    *weight = 2 / ((1 - x * x) * slope * slope);
    return x;
}

static void directions_of(const tyn_shdom_params *p, float directions[SHDOM_MAX_ORDINATES][4])
{
    const uint32_t n = num_zeniths(p);
    for (uint32_t i = 0; i < n; i++) {
        double weight;
        const double z = gauss_legendre(n, i, &weight), r = sqrt(1 - z * z);
        for (uint32_t j = 0; j < 2 * n; j++) {
            const double a = M_PI * (j + 0.5) / n;
            float *d = directions[2 * n * i + j];
            d[0] = (float)(r * cos(a));
            d[1] = (float)(r * sin(a));
            d[2] = (float)z;
            d[3] = (float)(weight * M_PI / n);
        }
    }
}

// ---- sizes ------------------------------------------------------------------------------------

static uint32_t whole_groups(uint32_t n)
{
    return (n + SHDOM_GROUP - 1) / SHDOM_GROUP * SHDOM_GROUP;
}

static uint32_t batch_size(uint64_t cells, uint32_t all)
{
    const uint32_t most = (uint32_t)(batch_bytes / (4 * cells)) / SHDOM_GROUP * SHDOM_GROUP;
    const uint32_t wanted = whole_groups(all);
    return most < SHDOM_GROUP ? SHDOM_GROUP : most < wanted ? most : wanted;
}

static tyn_result declare(tyn_builder *b, const void *data)
{
    const tyn_shdom_params *p = data;
    const tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    const tyn_extent texels = {dims.x, dims.y, dims.z * p->shape.channels};
    const tyn_extent cells = tyn_build_extent(b, PORT(CELLS));
    if (cells.x != texels.x || cells.y != texels.y || cells.z != texels.z) {
        return TYN_FAULT(
            tyn_build_log(b), TYN_ERR_PARAMS,
            "pass 'shdom': 'cells' has %u x %u x %u texels; its own shape has %u x %u x %u",
            cells.x, cells.y, cells.z, texels.x, texels.y, texels.z);
    }
    const uint64_t n = (uint64_t)dims.x * dims.y * dims.z;
    const uint32_t bands = (uint32_t)p->bands, coefficients = whole_groups(bands * bands);
    if (4 * n * coefficients > max_bytes) {
        return TYN_FAULT(
            tyn_build_log(b), TYN_ERR_PARAMS,
            "shdom: %u bands on %u x %u x %u cells need %.0f MiB for a channel; at most "
            "128 MiB: lower shdom.bands or shdom.cells",
            bands, dims.x, dims.y, dims.z, 4.0 * (double)n * coefficients / 0x1p20);
    }
    const uint32_t ordinates = num_ordinates(p);
    const uint32_t batch = batch_size(n, ordinates > p->count ? ordinates : p->count);
    for (uint32_t ch = 0; ch < p->shape.channels; ch++) {
        tyn_build_buffer(b, (uint8_t)(PORT(SENT_0) + ch), 4 * n * coefficients);
    }
    tyn_build_image(b, PORT(MOMENTS), texels, 1);
    tyn_build_buffer(b, PORT(DIRECTIONS), sizeof(float[4]) * ordinates);
    tyn_build_buffer(b, PORT(BASIS), sizeof(float) * coefficients * whole_groups(ordinates));
    tyn_build_buffer(b, PORT(WEIGHTED), sizeof(float) * coefficients * ordinates);
    tyn_build_buffer(b, PORT(SKY), sizeof(float) * coefficients * (p->count ? p->count : 1));
    tyn_build_buffer(b, PORT(UNSCATTERED), p->count || p->lamps ? 4 * n * coefficients : 4);
    tyn_build_buffer(b, PORT(RADIANCE), 4 * n * coefficients);
    tyn_build_buffer(b, PORT(EXTINCTION), 4 * n);
    tyn_build_buffer(b, PORT(EMITTED), 4 * n * batch);
    tyn_build_buffer(b, PORT(LINES), 4 * n * batch);
    return TYN_OK;
}

// ---- record -----------------------------------------------------------------------------------

typedef struct solve {
    struct shdom_args args;
    uint32_t cells, lines; // lines: of a slice, at most
    uint32_t mode, batch;
} solve;

// What has come to the cells, in spherical harmonics.
static void project(tyn_recorder *r, const solve *s, bool unscattered)
{
    static const uint8_t of_sky[][2] = {{PORT(WEIGHTED), PORT(SKY)},
                                        {PORT(RADIANCE), PORT(UNSCATTERED)}};
    uint8_t exchanged[TYN_MAX_BINDINGS];
    TYN_DISPATCH(r, .kernel = KERNEL_PROJECT,
                 .cells = {s->cells, s->args.coefficients / SHDOM_GROUP, 1}, .args = &s->args,
                 .ports = unscattered
                              ? tyn_ports_exchanged(&kernels[KERNEL_PROJECT], of_sky, 2, exchanged)
                              : NULL);
}

static void add_unscattered(tyn_recorder *r, solve *s)
{
    struct shdom_args *a = &s->args;
    for (a->first = 0; a->first < a->sky; a->first += s->batch) {
        a->count = a->sky - a->first < s->batch ? a->sky - a->first : s->batch;
        TYN_DISPATCH(r, .kernel = KERNEL_DIRECT, .cells = {s->cells, a->count, 1}, .args = a,
                     .spec = &s->mode);
        project(r, s, true);
    }
    if (a->lamps) {
        if (!a->sky) {
            tyn_rec_fill(r, PORT(UNSCATTERED), 0);
        }
        TYN_DISPATCH(r, .kernel = KERNEL_LAMPS, .cells = {s->cells, 1, 1}, .args = a,
                     .spec = &s->mode);
    }
}

static bool is_lit(const struct shdom_args *a)
{
    return a->sky || a->lamps;
}

// The source function of the channel, of all light that there is so far.
static void next(tyn_recorder *r, const solve *s, bool scattered)
{
    const uint8_t to[][2] = {{PORT(SENT_0), (uint8_t)(PORT(SENT_0) + s->args.ch)}};
    uint8_t exchanged[TYN_MAX_BINDINGS];
    const uint32_t spec[2] = {is_lit(&s->args), scattered};
    TYN_DISPATCH(r, .kernel = KERNEL_NEXT, .cells = {s->cells, s->args.coefficients, 1},
                 .args = &s->args, .spec = spec,
                 .ports = tyn_ports_exchanged(&kernels[KERNEL_NEXT], to, 1, exchanged));
}

static void iterate(tyn_recorder *r, solve *s)
{
    struct shdom_args *a = &s->args;
    const uint8_t from[][2] = {{PORT(SENT_0), (uint8_t)(PORT(SENT_0) + a->ch)}};
    uint8_t exchanged[TYN_MAX_BINDINGS];
    for (a->first = 0; a->first < a->num_ordinates; a->first += s->batch) {
        const uint32_t left = a->num_ordinates - a->first;
        a->count = left < s->batch ? left : s->batch;
        TYN_DISPATCH(r, .kernel = KERNEL_EMIT,
                     .cells = {s->cells, (a->count + SHDOM_GROUP - 1) / SHDOM_GROUP, 1}, .args = a,
                     .ports = tyn_ports_exchanged(&kernels[KERNEL_EMIT], from, 1, exchanged));
        TYN_DISPATCH(r, .kernel = KERNEL_LINES, .cells = {s->lines, a->count, 1}, .args = a);
        TYN_DISPATCH(r, .kernel = KERNEL_GATHER, .cells = {s->cells, a->count, 1}, .args = a);
        project(r, s, false);
    }
    next(r, s, true);
}

static uint32_t most_lines(tyn_extent dims)
{
    const uint32_t xy = dims.x * dims.y, yz = dims.y * dims.z, zx = dims.z * dims.x;
    const uint32_t most = xy > yz ? xy : yz;
    return most > zx ? most : zx;
}

static void record(tyn_recorder *r, const void *data)
{
    const tyn_shdom_params *p = data;
    const float *extent = p->shape.extent;
    const tyn_extent dims = tyn_lattice_dims(extent, p->shape.cells);
    const uint32_t bands = (uint32_t)p->bands, ordinates = num_ordinates(p);
    solve s = {
        .args = {.dims = {dims.x, dims.y, dims.z},
                 .channels = p->shape.channels,
                 .tint = {p->shape.tint[0], p->shape.tint[1], p->shape.tint[2]},
                 .dx = fmaxf(extent[0], fmaxf(extent[1], extent[2])) / (float)p->shape.cells,
                 .bands = bands,
                 .coefficients = whole_groups(bands * bands),
                 .ordinates = whole_groups(ordinates),
                 .num_ordinates = ordinates,
                 .sky = tyn_rec_has(r, PORT(ORDINATES)) ? p->count : 0,
                 .lamps = tyn_rec_has(r, PORT(RADIALS)) ? p->lamps : 0},
        .cells = dims.x * dims.y * dims.z,
        .lines = most_lines(dims),
        .mode = p->mode,
    };
    s.batch = batch_size(s.cells, ordinates > p->count ? ordinates : p->count);
    float directions[SHDOM_MAX_ORDINATES][4];
    directions_of(p, directions);
    tyn_rec_update(r, PORT(DIRECTIONS), 0, directions, sizeof directions[0] * ordinates);
    tyn_rec_fill(r, PORT(BASIS), 0);
    tyn_rec_fill(r, PORT(WEIGHTED), 0);
    tyn_rec_fill(r, PORT(SKY), 0);
    TYN_DISPATCH(r, .kernel = KERNEL_BASIS, .cells = {ordinates + s.args.sky, 1, 1},
                 .args = &s.args);
    for (s.args.ch = 0; s.args.ch < p->shape.channels; s.args.ch++) {
        add_unscattered(r, &s);
        next(r, &s, false);
        for (int32_t i = 0; i < p->iterations; i++) {
            iterate(r, &s);
        }
        TYN_DISPATCH(r, .kernel = KERNEL_MOMENTS, .cells = {s.cells, 1, 1}, .args = &s.args,
                     .spec = &(uint32_t){is_lit(&s.args)});
    }
    const double steps = (double)s.cells * p->shape.channels * p->iterations * ordinates;
    tyn_rec_work(r, "cells", (double)s.cells * p->shape.channels * p->iterations);
    // To an ordinate and back: a product and a sum for each coefficient; a step along a line 80.
    tyn_rec_work(r, "flops", steps * (4.0 * bands * bands + 80));
    tyn_rec_work(r, "bytes", steps * 4.0 * (2.0 * bands * bands / SHDOM_GROUP + 8));
}

static const tyn_param param_table[] = {
    {"cells", TYN_PARAM_INT, offsetof(tyn_shdom_params, shape.cells), 20, 4, TYN_LATTICE_MAX_CELLS,
     "cells", "lattice cells along the longest side of the medium; 262144 in all", NULL},
    {"bands", TYN_PARAM_INT, offsetof(tyn_shdom_params, bands), 5, 1, SHDOM_MAX_BANDS, "",
     "bands of spherical harmonics: so many squared are the coefficients of a cell, and twice as "
     "many the discrete ordinates (32 at least)",
     NULL},
    {"iterations", TYN_PARAM_INT, offsetof(tyn_shdom_params, iterations), 20, 1, 512, "",
     "of the source function: scatterings beyond the first that are counted", NULL},
};

const tyn_pass_desc tyn_pass_shdom = {
    .name = "shdom",
    .summary = "light that has scattered, by spherical harmonics and discrete ordinates",
    .serves = "media that scatter more than once",
    TYN_PASS_TABLES(tyn_shdom_params),
    TYN_SETTINGS(param_table),
    .debug_port = PORT(MOMENTS),
    .debug_meaning = "fluence and flux of the scattered light in a slice, W/m^2",
    TYN_COUNTS(PORT(COUNTERS), struct counters_block, TYN_COUNTER_NON_FINITE),
};
