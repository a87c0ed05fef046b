// scatter_lut.c -- moments of the forward lobe on the CPU, the table on the GPU.
#include "scatter_lut.h"
#include "scatter_lut_sum.comp.h"
#include <math.h>

#define PI 3.14159265358979323846

enum { POINTS = 8, MAX_TERMS = 2464 };

static const double g_max = 0.995; // narrower lobes are replaced by this one (similarity_clamp)
static const double g_min = 1e-3;  // below it there is no lobe worth splitting off

static const tyn_port ports[SCATTER_LUT_NUM_PORTS] = {
    [SCATTER_LUT_PORT_LUT] =
        {"lut", TYN_OUT, TYN_IMAGE_2D, VK_FORMAT_R32G32_SFLOAT, false,
         "ln of the multiple forward scattering of K_tms and K_lobe over depth (x) "
         "and angle (y), a table for each g above the other"},
    [SCATTER_LUT_PORT_LUT_BLOCK] = {"lut_block", TYN_OUT, TYN_BUFFER, 0, false,
                                    "rows of the table: g, half width of the lobe"},
    [SCATTER_LUT_PORT_MOMENTS] =
        {"moments", TYN_SCRATCH, TYN_BUFFER, 0, false,
         "Legendre moments of the phase function outside and inside the lobe"},
};

enum { KERNEL_SUM, NUM_KERNELS };

static const tyn_binding sum_bindings[] = {
    {SCATTER_LUT_PORT_LUT_BLOCK, TYN_USE_STORAGE_READ},
    {SCATTER_LUT_PORT_MOMENTS, TYN_USE_STORAGE_READ},
    {SCATTER_LUT_PORT_LUT, TYN_USE_STORAGE_WRITE},
};

static const tyn_kernel kernels[NUM_KERNELS] = {
    [KERNEL_SUM] = {"sum",
                    scatter_lut_sum_spirv,
                    sizeof(scatter_lut_sum_spirv),
                    0,
                    {TYN_LUT_ANGLES / 4, 1, 1},
                    sum_bindings,
                    3,
                    0},
};

// ---- rows -----------------------------------------------------------------------------------------

static uint32_t num_terms(double g)
{
    // g^l and the moments of the lobe are below 1e-5 of the first beyond this.
    double terms = 12 / (1 - fmax(g, 0)) + 64;
    return terms < MAX_TERMS ? (uint32_t)terms : MAX_TERMS;
}

// Which g the rows have; the rest of the block is zero.
static void make_rows(const tyn_scatter_lut_params *p, struct lut_block *block)
{
    *block = (struct lut_block){0};
    if (p->mode == TYN_MEDIUM_COEFFICIENTS) {
        double top = fmin(fmax(p->g_max, 0.1), g_max), first = log(0.02 / 0.98);
        double step = (log(top / (1 - top)) - first) / (TYN_LUT_MAX_ROWS - 1);
        block->num_rows = TYN_LUT_MAX_ROWS;
        block->spread = 1;
        block->log_first = (float)first;
        block->log_step = (float)step;
        for (uint32_t r = 0; r < TYN_LUT_MAX_ROWS; r++) {
            block->g[r] = (float)fmin(1 / (1 + exp(-(first + r * step))), g_max);
        }
    } else {
        for (uint32_t c = 0; c < 3; c++) {
            float g = fminf(p->g[c], (float)g_max);
            uint32_t r = 0;
            while (r < block->num_rows && block->g[r] != g) {
                r++;
            }
            if (r == block->num_rows) {
                block->g[block->num_rows++] = g;
            }
            block->channel_row[c] = r;
        }
    }
    uint32_t first_term = 0;
    for (uint32_t r = 0; r < block->num_rows; r++) {
        block->terms[r] = block->g[r] > g_min ? num_terms(block->g[r]) : 0;
        block->first_term[r] = first_term;
        first_term += block->terms[r];
    }
    block->num_terms = first_term;
}

// ---- moments --------------------------------------------------------------------------------------

// Gauss-Legendre points and weights on [-1, 1] by Newton's method.
static void gauss_legendre(double x[POINTS], double w[POINTS])
{
    for (int i = 0; i < POINTS; i++) {
        double z = cos(PI * (i + 0.75) / (POINTS + 0.5)), slope = 1;
        for (int newton = 0; newton < 8; newton++) {
            double p = 1, before = 0;
            for (int l = 0; l < POINTS; l++) {
                double next = ((2 * l + 1) * z * p - l * before) / (l + 1);
                before = p;
                p = next;
            }
            slope = POINTS * (before - z * p) / (1 - z * z);
            z -= p / slope;
        }
        x[i] = z;
        w[i] = 2 / ((1 - z * z) * slope * slope);
    }
}

// Fraction of the phase function within theta of the forward direction.
static double fraction_within(double g, double theta)
{
    double s1 = sin(0.5 * theta), one_minus_mu = 2 * s1 * s1;
    double s = sqrt((1 - g) * (1 - g) + 2 * g * one_minus_mu);
    return (1 + g) * one_minus_mu / (s * (s + 1 - g));
}

// theta_1 such that the lobe p h holds the fraction g^2. By parts, int p h = int -h' fraction_within,
// with -h' = 6 x (1 - x), x = theta / theta_1 - 1/2; bisection, as it grows with theta_1.
static double find_theta_1(double g, const double x[POINTS], const double w[POINTS])
{
    double lo = 0, hi = PI / 1.5;
    for (int i = 0; i < 50; i++) {
        double theta_1 = 0.5 * (lo + hi), sum = 0;
        for (int panel = 0; panel < 4; panel++) {
            for (int q = 0; q < POINTS; q++) {
                double t = (panel + 0.5 + 0.5 * x[q]) / 4;
                sum += w[q] / 8 * 6 * t * (1 - t) * fraction_within(g, (t + 0.5) * theta_1);
            }
        }
        if (sum < g * g) {
            lo = theta_1;
        } else {
            hi = theta_1;
        }
    }
    return 0.5 * (lo + hi);
}

// Adds 2 pi int p h P_l dmu over [from, to] to moments[l]. Panels are half a lobe's width: the last P_l
// turns about once in one.
static void add_moments(double g, double theta_1, double from, double to, const double x[POINTS],
                        const double w[POINTS], double *moments, uint32_t terms)
{
    uint32_t panels = (uint32_t)ceil((to - from) / fmin(0.5 * (1 - g), 0.25 * (to - from)));
    double half = 0.5 * (to - from) / panels;
    for (uint32_t panel = 0; panel < panels; panel++) {
        double y[POINTS], p[POINTS], d[POINTS] = {0}; // 1 - mu, weight P_l, weight (P_l - P_{l-1})
        for (int q = 0; q < POINTS; q++) {
            double theta = from + half * (2 * panel + 1 + x[q]), s1 = sin(0.5 * theta);
            y[q] = 2 * s1 * s1;
            double s2 = (1 - g) * (1 - g) + 2 * g * y[q];
            double t = fmin(fmax(theta / theta_1 - 0.5, 0), 1), h = 1 - t * t * (3 - 2 * t);
            p[q] = w[q] * half * h * sin(theta) * 0.5 * (1 - g * g) / (s2 * sqrt(s2));
        }
        for (uint32_t l = 0; l < terms; l++) {
            double a = l / (l + 1.0), b = (2 * l + 1) / (l + 1.0), sum = 0;
            for (int q = 0; q < POINTS; q++) {
                sum += p[q];
                d[q] = a * d[q] - b * y[q] * p[q];
                p[q] += d[q];
            }
            moments[l] += sum;
        }
    }
}

// Completes the rows and writes the moments (g^l - F_l, F_l) of one of them.
static void make_moments(struct lut_block *block, uint32_t r, float (*out)[2])
{
    double x[POINTS], w[POINTS], lobe[MAX_TERMS] = {0}, g = block->g[r];
    gauss_legendre(x, w);
    double theta_1 = find_theta_1(g, x, w), power = 1;
    add_moments(g, theta_1, 0, 0.5 * theta_1, x, w, lobe, block->terms[r]);
    add_moments(g, theta_1, 0.5 * theta_1, 1.5 * theta_1, x, w, lobe, block->terms[r]);
    for (uint32_t l = 0; l < block->terms[r]; l++, power *= g) {
        out[l][0] = (float)(power - lobe[l]);
        out[l][1] = (float)lobe[l];
    }
    block->theta_1[r] = (float)theta_1;
}

// ---- the pass -------------------------------------------------------------------------------------

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_scatter_lut_params *p = params;
    for (uint32_t c = 0; c < 4; c++) {
        float g = c < 3 ? p->g[c] : p->g_max;
        if (!(g > -1 && g < 1)) {
            tyn_log_print(tyn_build_log(b), TYN_LOG_ERROR,
                          "scatter_lut: g is %g, must be above -1 and below 1", g);
            return TYN_ERR_PARAMS;
        }
    }
    struct lut_block block;
    make_rows(p, &block);
    uint64_t bytes = block.num_terms * 2ull * sizeof(float);
    tyn_build_image(b, SCATTER_LUT_PORT_LUT,
                    (tyn_extent){TYN_LUT_DEPTHS, TYN_LUT_ANGLES * block.num_rows, 1}, 1);
    tyn_build_buffer(b, SCATTER_LUT_PORT_LUT_BLOCK, sizeof(block));
    tyn_build_buffer(b, SCATTER_LUT_PORT_MOMENTS, bytes > 0 ? bytes : 8);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    struct lut_block block;
    make_rows(params, &block);
    for (uint32_t row = 0; row < block.num_rows; row++) {
        if (block.terms[row] > 0) {
            float moments[MAX_TERMS][2];
            make_moments(&block, row, moments);
            tyn_rec_update(r, SCATTER_LUT_PORT_MOMENTS, block.first_term[row] * sizeof(moments[0]),
                           moments, block.terms[row] * sizeof(moments[0]));
        }
    }
    tyn_rec_update(r, SCATTER_LUT_PORT_LUT_BLOCK, 0, &block, sizeof(block));
    tyn_rec_dispatch(r, &(tyn_dispatch){
                            .kernel = KERNEL_SUM,
                            .cells = {TYN_LUT_ANGLES / 4, TYN_LUT_DEPTHS, block.num_rows},
                        });
    // Per term and texel: the recurrence (5), the sums (4).
    double texel_terms = (double)block.num_terms * TYN_LUT_ANGLES * TYN_LUT_DEPTHS;
    tyn_rec_work(r, "flops", 9 * texel_terms);
    tyn_rec_work(r, "bytes", 8.0 * TYN_LUT_ANGLES * TYN_LUT_DEPTHS * block.num_rows);
}

const tyn_pass_desc tyn_pass_scatter_lut = {
    .name = "scatter_lut",
    .summary = "light scattered forward any number of times around a beam, as a table per g",
    .ports = ports,
    .num_ports = SCATTER_LUT_NUM_PORTS,
    .kernels = kernels,
    .num_kernels = NUM_KERNELS,
    .media_only = true,
    .params_size = sizeof(tyn_scatter_lut_params),
    .declare = declare,
    .record = record,
    .debug_port = SCATTER_LUT_PORT_LUT,
    .debug_meaning = "ln of the scattering kernels: depth to the right, angle down",
};
