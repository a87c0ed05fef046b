// scatter_lut.c -- moments of the forward lobe on the CPU, the table on the GPU.
#include "scatter_lut.h"
#include "passes/scatter_lut_tables.h"
#include "scene/phase.h"
#include "shaders/common/counters.h"
#include <math.h>

enum { MAX_TERMS = 2464 };
enum { CONES_BYTES = 4 * TYN_TMS_CONES * TYN_TMS_MAX_TERMS };

static const float least_blur = 1e-4f; // 1 - mean cosine: smaller suns are points (0.8 degrees RMS)

// ---- rows -----------------------------------------------------------------------------------------

static uint32_t num_terms(tyn_phase phase)
{
    // The moments and those of the lobe are below 1e-5 of the first beyond this.
    double terms = 12 / (1 - tyn_phase_narrowness(phase)) + 64;
    return terms < MAX_TERMS ? (uint32_t)terms : MAX_TERMS;
}

// The phase function beside the lobe has no peak, only the window's bends, however narrow the lobe is: its moments
// fall as l^-3. Without a lobe it is the peak itself.
static uint32_t num_tms_terms(tyn_phase phase)
{
    uint32_t terms = num_terms(phase);
    uint32_t most = tyn_phase_mean_cosine(phase) > 0 && !phase.table ? 192 : TYN_TMS_MAX_TERMS;
    return terms < most ? terms : most;
}

// Moments of a row in the buffer "moments".
static uint32_t row_terms(const struct lut_block *block, uint32_t r)
{
    return block->terms[r] > block->tms_terms[r] ? block->terms[r] : block->tms_terms[r];
}

// Index of a phase function in the rows or of a size of suns in the sets, put at the end if it is not there.
static uint32_t row_of(struct lut_block *block, tyn_phase phase)
{
    uint32_t r = 0;
    while (r < block->num_rows && !tyn_phase_equal(block->phase[r], phase)) {
        r++;
    }
    block->phase[r] = phase;
    block->num_rows += r == block->num_rows;
    return r;
}

static uint32_t set_of(struct lut_block *block, float blur)
{
    uint32_t s = 0;
    while (s < block->num_sets && block->blur[s] != blur) {
        s++;
    }
    block->blur[s] = blur;
    block->num_sets += s == block->num_sets;
    return s;
}

// Which phase functions the rows and which suns the sets have; the rest of the block is zero. Returns the number of
// moments.
static uint32_t make_rows(const tyn_scatter_lut_params *p, struct lut_block *block)
{
    *block = (struct lut_block){.num_sets = 1};
    if (p->mode == TYN_MEDIUM_COEFFICIENTS) {
        double top = fmin(fmax(p->g_max, 0.1), TYN_PHASE_NARROWEST), first = log(0.02 / 0.98);
        double step = (log(top / (1 - top)) - first) / (TYN_LUT_MAX_ROWS - 1);
        block->num_rows = TYN_LUT_MAX_ROWS;
        block->spread = 1;
        block->log_first = (float)first;
        block->log_step = (float)step;
        for (uint32_t r = 0; r < TYN_LUT_MAX_ROWS; r++) {
            double g = fmin(1 / (1 + exp(-(first + r * step))), TYN_PHASE_NARROWEST);
            block->phase[r] = tyn_phase_of_mean_cosine((float)g);
        }
    } else {
        for (uint32_t c = 0; c < 3; c++) {
            block->channel_row[c] = row_of(block, tyn_phase_resolved(p->phase[c]));
        }
    }
    for (uint32_t i = 0; i < p->num_suns; i++) {
        float blur = 1 - p->mean_cosine[i];
        block->sun_set[i] = set_of(block, blur > least_blur ? blur : 0);
    }
    uint32_t moments = 0;
    for (uint32_t r = 0; r < block->num_rows; r++) {
        bool summed = tyn_phase_has_lobe(block->phase[r]) || block->num_sets > 1;
        block->terms[r] = summed ? num_terms(block->phase[r]) : 0;
        block->tms_terms[r] = p->tms ? num_tms_terms(block->phase[r]) : 0;
        block->first_term[r] = moments;
        moments += row_terms(block, r);
    }
    return moments;
}

// ---- moments --------------------------------------------------------------------------------------

// Completes a row and writes its moments outside and inside the lobe.
static void make_moments(struct lut_block *block, const tyn_phase_table *tables, uint32_t r,
                         float (*out)[2])
{
    double all[MAX_TERMS], lobe[MAX_TERMS] = {0};
    uint32_t terms = row_terms(block, r);
    if (tyn_phase_has_lobe(block->phase[r])) {
        block->theta_1[r] = (float)tyn_phase_lobe_moments(tables, block->phase[r], 1, lobe, terms);
    }
    tyn_phase_moments(tables, block->phase[r], all, terms);
    for (uint32_t l = 0; l < terms; l++) {
        out[l][0] = (float)(all[l] - lobe[l]);
        out[l][1] = (float)lobe[l];
    }
}

// c_l of the cones of the table "tms", for scatter_lut_map.glsl's tms_level: averages of P_l over a cone
// of half angle gamma, c = cos gamma. With d_l = P_l(c) - P_{l-1}(c), which keeps the digits of small
// cones, c_l = -(d_l + d_{l+1}) / ((2l + 1) (1 - c)).
static void make_cones(float (*out)[TYN_TMS_MAX_TERMS])
{
    for (uint32_t cone = 0; cone < TYN_TMS_CONES; cone++) {
        double s = cone / (TYN_TMS_CONES - 1.0), y = 2 * s * s, p = 1 - y, d = -y;
        out[cone][0] = 1;
        for (uint32_t l = 1; l < TYN_TMS_MAX_TERMS; l++) {
            double next = (l * d - (2 * l + 1) * y * p) / (l + 1);
            out[cone][l] = cone == 0 ? 1 : (float)(-(d + next) / ((2 * l + 1) * y));
            d = next;
            p += d;
        }
    }
}

// ---- the pass -------------------------------------------------------------------------------------

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_scatter_lut_params *p = params;
    if (tyn_phase_check(p->phase, "scatter_lut", tyn_build_log(b))) {
        return TYN_ERR_PARAMS;
    }
    for (uint32_t i = 0; i < p->num_suns; i++) {
        if (i >= TYN_LUT_MAX_SUNS || !(p->mean_cosine[i] > 0 && p->mean_cosine[i] <= 1)) {
            return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                             "scatter_lut: %u suns, at most %d with mean cosines in (0, 1]",
                             p->num_suns, TYN_LUT_MAX_SUNS);
        }
    }
    struct lut_block block;
    uint64_t bytes = make_rows(p, &block) * 2ull * sizeof(float);
    tyn_build_image(
        b, SCATTER_LUT_PORT_LUT,
        (tyn_extent){TYN_LUT_DEPTHS * block.num_sets, TYN_LUT_ANGLES * block.num_rows, 1}, 1);
    tyn_build_buffer(b, SCATTER_LUT_PORT_LUT_BLOCK, sizeof(block));
    tyn_build_buffer(b, SCATTER_LUT_PORT_MOMENTS, bytes > 0 ? bytes : 8);
    if (p->tms) {
        tyn_build_buffer(b, SCATTER_LUT_PORT_COUNTERS, sizeof(struct counters_block));
        tyn_build_image(
            b, SCATTER_LUT_PORT_TMS,
            (tyn_extent){TYN_TMS_DEPTHS, TYN_TMS_ANGLES, TYN_TMS_CONES * block.num_rows}, 1);
        tyn_build_buffer(b, SCATTER_LUT_PORT_CONES, CONES_BYTES);
    }
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_scatter_lut_params *p = params;
    struct lut_block block;
    make_rows(p, &block);
    double terms_of_lut = 0;
    for (uint32_t row = 0; row < block.num_rows; row++) {
        uint32_t terms = row_terms(&block, row);
        terms_of_lut += block.terms[row] * block.num_sets;
        if (terms > 0) {
            float moments[MAX_TERMS][2];
            if (tyn_rec_live(r)) {
                make_moments(&block, p->tables, row, moments);
            }
            tyn_rec_update(r, SCATTER_LUT_PORT_MOMENTS, block.first_term[row] * sizeof(moments[0]),
                           moments, terms * sizeof(moments[0]));
        }
    }
    tyn_rec_update(r, SCATTER_LUT_PORT_LUT_BLOCK, 0, &block, sizeof(block));
    TYN_DISPATCH(r, .kernel = KERNEL_SUM,
                 .cells = {TYN_LUT_ANGLES / 4, TYN_LUT_DEPTHS * block.num_sets, block.num_rows});
    // Per term and texel: the recurrence (5), the sums (4).
    double texel_terms = terms_of_lut * TYN_LUT_ANGLES * TYN_LUT_DEPTHS;
    double flops = 9 * texel_terms,
           bytes = 8.0 * TYN_LUT_ANGLES * TYN_LUT_DEPTHS * block.num_rows * block.num_sets;
    if (p->tms) {
        float cones[TYN_TMS_CONES][TYN_TMS_MAX_TERMS];
        if (tyn_rec_live(r)) {
            make_cones(cones);
        }
        tyn_rec_update(r, SCATTER_LUT_PORT_CONES, 0, cones, CONES_BYTES);
        tyn_rec_fill(r, SCATTER_LUT_PORT_COUNTERS, 0);
        uint32_t layers = TYN_TMS_CONES * block.num_rows;
        TYN_DISPATCH(r, .kernel = KERNEL_TMS,
                     .cells = {TYN_TMS_ANGLES / 4, TYN_TMS_DEPTHS / 4, layers});
        for (uint32_t row = 0; row < block.num_rows; row++) {
            // Four depths share the recurrence.
            flops += 3.25 * block.tms_terms[row] * TYN_TMS_ANGLES * TYN_TMS_DEPTHS * TYN_TMS_CONES;
        }
        bytes += 4.0 * TYN_TMS_ANGLES * TYN_TMS_DEPTHS * layers;
    }
    tyn_rec_work(r, "flops", flops);
    tyn_rec_work(r, "bytes", bytes);
}

static const tyn_counter counters[] = {
    {"clamped", offsetof(struct counters_block, clamped)},
    TYN_COUNTER_HIDDEN("of what the table scatters",
                       "accuracy: kernels of the ordinates' light would be negative and are set to "
                       "0: %g %% of what they scatter"),
    {NULL},
};

const tyn_pass_desc tyn_pass_scatter_lut = {
    .name = "scatter_lut",
    .summary =
        "light scattered forward any number of times around a beam, as a table per phase function",
    .serves = "suns, lamps and ordinates in media",
    TYN_PASS_TABLES(tyn_scatter_lut_params),
    .media_only = true, // and on the sizes of suns, which change as seldom
    .debug_port = SCATTER_LUT_PORT_LUT,
    .debug_meaning = "ln of the scattering kernels: depth to the right, angle down",
    .counters = counters,
    .counter_port = SCATTER_LUT_PORT_COUNTERS,
};
