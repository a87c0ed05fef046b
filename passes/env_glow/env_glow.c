// env_glow.c -- the environment as it looks through a medium that scatters forward.
//
// The smearing is a convolution on the sphere: every spherical harmonic of degree l is multiplied with
// the kernel's Legendre moment. The moments come from the CPU, the transforms there and back run on the
// GPU: Fourier sums along the rows, Legendre functions across them.
#include "env_glow.h"
#include "env_glow_args.h"
#include "passes/env_glow_tables.h"
#include "shaders/common/counters.h"
#include <math.h>

#define PI 3.14159265358979323846

enum { DEGREES = TYN_GLOW_HEIGHT };

// ---- the series -----------------------------------------------------------------------------------

// Levels up to the depth at which e^-tau' = e^-20 in a medium that does not absorb.
static uint32_t num_levels(const tyn_env_glow_params *p)
{
    double f = 0;
    for (int c = 0; c < 3; c++) {
        f = fmax(f, tyn_phase_delta_fraction(tyn_phase_resolved(p->phase[c])));
    }
    double deepest = 20 * f / (1 - f);
    double last = ceil(log1p(deepest / TYN_GLOW_DEPTH) / TYN_GLOW_STEP);
    return (uint32_t)fmin(fmax(last + 1, 2), TYN_GLOW_LEVELS);
}

// Legendre moments of the lobes of all orders from the first on at forward depth t, from those of one
// order: (e^(t phi) - 1) / (e^t - 1).
static void lobe_series(double t, const double phi[DEGREES], double k[DEGREES])
{
    for (int l = 0; l < DEGREES; l++) {
        k[l] = t > 0 ? exp(-t * (1 - phi[l])) * expm1(-t * phi[l]) / expm1(-t) : phi[l];
    }
    // A series that is cut off rings around bright windows: a lobe too narrow for it is widened just so
    // much that its last moment has fallen to 3 %.
    const double sharpness = 1.5; // between a Gaussian, which blurs more, and a cut, which rings
    double last = fabs(k[DEGREES - 1]) / 0.03;
    double widen = last > 1 ? log(last) / pow((DEGREES - 1.0) * DEGREES, sharpness) : 0;
    for (int l = 1; l < DEGREES; l++) {
        k[l] *= exp(-widen * pow(l * (l + 1), sharpness));
    }
}

// Fejer's first rule in x = cos(theta): exact for polynomials of degree below the number of rows.
static void row_weights(struct glow_series *s)
{
    const int n = TYN_GLOW_HEIGHT;
    for (int i = 0; i < n; i++) {
        double theta = PI * (i + 0.5) / n, sum = 0;
        for (int k = 1; k <= n / 2; k++) {
            sum += cos(2 * k * theta) / (4.0 * k * k - 1);
        }
        s->weights[i] = (float)(2.0 / n * (1 - 2 * sum));
        s->solid_angles[i] = (float)(2 * sin(0.5 * PI / n) * sin(theta));
    }
}

static void make_series(const tyn_env_glow_params *p, struct glow_series *s)
{
    *s = (struct glow_series){0};
    row_weights(s);
    double phi[3][DEGREES] = {
        {1}, {1}, {1}}; // no lobe: the mean alone, which nothing is weighted with
    for (int c = 0; c < 3; c++) {
        if (tyn_phase_has_lobe(p->phase[c])) {
            tyn_phase_lobe_moments(p->tables, p->phase[c], TYN_PHASE_NARROWEST, phi[c], DEGREES);
            for (int l = DEGREES - 1; l >= 0; l--) {
                phi[c][l] /= phi[c][0];
            }
        }
    }
    for (uint32_t level = 0; level < num_levels(p); level++) {
        double t = TYN_GLOW_DEPTH * expm1(TYN_GLOW_STEP * level), k[DEGREES];
        for (int c = 0; c < 3; c++) {
            lobe_series(t, phi[c], k);
            for (uint32_t l = 0; l < DEGREES; l++) {
                s->kernel[level * DEGREES + l][c] = (float)k[l];
                if (fabs(k[l]) > 1e-4 && l >= s->terms[level]) {
                    s->terms[level] = (l + 2) / 2 * 2; // even
                }
            }
        }
    }
}

// ---- the pass -------------------------------------------------------------------------------------

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_env_glow_params *p = params;
    if (tyn_phase_check(p->phase, "env_glow", tyn_build_log(b))) {
        return TYN_ERR_PARAMS;
    }
    uint32_t levels = num_levels(p);
    uint64_t orders = (uint64_t)DEGREES * TYN_GLOW_HEIGHT * sizeof(struct glow_order);
    tyn_build_image(b, ENV_GLOW_PORT_GLOW, (tyn_extent){TYN_GLOW_WIDTH, TYN_GLOW_HEIGHT, levels},
                    1);
    tyn_build_buffer(b, ENV_GLOW_PORT_SERIES, sizeof(struct glow_series));
    tyn_build_buffer(b, ENV_GLOW_PORT_ROWS, orders);
    tyn_build_buffer(b, ENV_GLOW_PORT_COEFFICIENTS,
                     (uint64_t)DEGREES * DEGREES * sizeof(struct glow_coefficient));
    tyn_build_buffer(b, ENV_GLOW_PORT_LEVELS, levels * orders);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_env_glow_params *p = params;
    struct glow_series series = {0};
    if (tyn_rec_live(r)) {
        make_series(p, &series);
    }
    tyn_rec_update(r, ENV_GLOW_PORT_SERIES, 0, &series, sizeof series);
    // A map without mips that is finer than the glow is not expected.
    tyn_extent sky = tyn_rec_extent(r, ENV_GLOW_PORT_SKY);
    struct env_glow_args args = {0};
    for (uint32_t mip = 0; sky.x >> mip > TYN_GLOW_WIDTH || sky.y >> mip > TYN_GLOW_HEIGHT;) {
        args.mip = (float)++mip;
    }
    uint32_t levels = num_levels(p);
    TYN_DISPATCH(r, .kernel = KERNEL_ROWS, .cells = {TYN_GLOW_HEIGHT / 4, TYN_GLOW_HEIGHT, 1},
                 .args = &args);
    TYN_DISPATCH(r, .kernel = KERNEL_ANALYSE, .cells = {DEGREES, DEGREES, 1});
    TYN_DISPATCH(r, .kernel = KERNEL_SMEAR, .cells = {TYN_GLOW_HEIGHT / 8, DEGREES, levels});
    TYN_DISPATCH(r, .kernel = KERNEL_TEXELS,
                 .cells = {TYN_GLOW_WIDTH / 16, TYN_GLOW_HEIGHT, levels});
    double smeared = 0;
    for (uint32_t level = 0; level < levels; level++) {
        double terms = series.terms[level];
        // Per degree, order and pair of rows the recurrence and the sums; per order and four texels.
        smeared += terms * terms / 2 * TYN_GLOW_HEIGHT / 2 * 20;
        smeared += terms * TYN_GLOW_HEIGHT * TYN_GLOW_WIDTH / 4 * 18;
    }
    tyn_rec_work(r, "flops", smeared);
    tyn_rec_work(r, "bytes", 16.0 * TYN_GLOW_WIDTH * TYN_GLOW_HEIGHT * levels);
}

const tyn_pass_desc tyn_pass_env_glow = {
    .name = "env_glow",
    .summary = "the environment as it looks through a medium that scatters forward",
    .serves = "principal ordinates: an environment map, and no walls in the medium",
    TYN_PASS_TABLES(tyn_env_glow_params),
    .debug_port = ENV_GLOW_PORT_GLOW,
    .debug_meaning = "the smeared map at a middle depth",
    TYN_COUNTS(ENV_GLOW_PORT_COUNTERS, struct counters_block, TYN_COUNTER_NON_FINITE,
               {"clamped", offsetof(struct counters_block, clamped)},
               TYN_COUNTER_HIDDEN(
                   "of the smeared map's light",
                   "accuracy: the environment that shows through forward scattering would be "
                   "negative beside its bright places and is set to 0: %g %% of its light")),
};
