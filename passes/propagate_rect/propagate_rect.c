// propagate_rect.c -- see propagate_rect.h.
#include "propagate_rect.h"
#include "propagate_rect_args.h"
#include "propagate_rect_cells.comp.h"
#include "propagate_rect_collect.comp.h"
#include "propagate_rect_light.comp.h"
#include "propagate_rect_lit_maps.comp.h"
#include "propagate_rect_lit_traced.comp.h"
#include "propagate_rect_setup.comp.h"
#include "propagate_rect_shrink_coefficients.comp.h"
#include "propagate_rect_shrink_density.comp.h"
#include "propagate_rect_start.comp.h"
#include "propagate_rect_step.comp.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/common/scene_args.h"
#include <math.h>

#define PORT(name) PROPAGATE_RECT_PORT_##name

static const tyn_port ports[] = {PROPAGATE_RECT_PORTS(TYN_PORT_ROW)};

enum {
    SETUP,
    SHRINK_DENSITY,
    SHRINK_COEFFICIENTS,
    CELLS,
    LIT_MAPS,
    LIT_TRACED,
    START,
    STEP,
    COLLECT,
    LIGHT,
    NUM_KERNELS
};

#define EDGE PROPAGATE_RECT_GROUP
#define ARGS sizeof(struct propagate_rect_args)
static const tyn_kernel kernels[NUM_KERNELS] = {
    [SETUP] = TYN_KERNEL(propagate_rect_setup),
    [SHRINK_DENSITY] = TYN_KERNEL(propagate_rect_shrink_density),
    [SHRINK_COEFFICIENTS] = TYN_KERNEL(propagate_rect_shrink_coefficients),
    [CELLS] = TYN_KERNEL(propagate_rect_cells),
    [LIT_MAPS] = TYN_KERNEL(propagate_rect_lit_maps),
    [LIT_TRACED] = TYN_KERNEL(propagate_rect_lit_traced),
    [START] = TYN_KERNEL(propagate_rect_start),
    [STEP] = TYN_KERNEL(propagate_rect_step),
    [COLLECT] = TYN_KERNEL(propagate_rect_collect),
    [LIGHT] = TYN_KERNEL(propagate_rect_light),
};

#define FIELD(name) offsetof(tyn_propagate_rect_params, name)
static const tyn_param params[] = {
    {"cells", TYN_PARAM_INT, FIELD(cells), 20, 2, 64, "cells",
     "cubic cells along the longest side of the box aligned with the light"},
    {"iterations", TYN_PARAM_INT, FIELD(iterations), 20, 1, 256, "",
     "hops from cell to cell; the paper takes about as many as cells"},
    {"init", TYN_PARAM_ENUM, FIELD(init), TYN_PROPAGATE_INIT_ENTRY, 0, 3, "",
     "light before the first hop: entry is the only one that has the right power without "
     "scattering",
     (const char *const[]){"entry", "all_transmittance", "all_absorption", "first_collision"}},
    {"last_event", TYN_PARAM_BOOL, FIELD(last_event), 1, 0, 1, "",
     "scatter once more towards the eye: hg(mu, g a) instead of the incident hg(mu, a)"},
    {"rate", TYN_PARAM_ENUM, FIELD(rate), TYN_PROPAGATE_RATE_PAPER, 0, 1, "",
     "how a hop lowers the mean cosine: paper is g^(sigma_s t), exact is exp(-(1 - g) sigma_s t)",
     (const char *const[]){"paper", "exact"}},
    {"source", TYN_PARAM_ENUM, FIELD(source), TYN_PROPAGATE_SOURCE_SCATTERED, 0, 1, "",
     "what a point of the medium sends to the eye: sigma_s L_acc, or L_acc where there is any "
     "medium",
     (const char *const[]){"scattered", "accumulated"}},
    {"prefilter", TYN_PARAM_ENUM, FIELD(prefilter), TYN_PROPAGATE_PREFILTER_EXACT, 0, 2, "",
     "mean cosine of an ordinate's light as it enters: 1, (1 - w / N)^beta, or 1 - its part of the "
     "sphere",
     (const char *const[]){"off", "heuristic", "exact"}},
    {"beta", TYN_PARAM_FLOAT, FIELD(beta), 1, 0.01, 1000, "",
     "exponent of the heuristic prefilter; 1 is exact for regions of equal size"},
};

// ---- sizes ------------------------------------------------------------------------------------

static uint32_t cells_of_grid(const tyn_propagate_rect_params *p)
{
    return (uint32_t)(p->cells * p->cells * p->cells) * p->channels;
}

// Grids of a batch: as many as storage buffers hold.
static uint32_t batch(const tyn_propagate_rect_params *p)
{
    const uint32_t bytes = p->buffer_bytes ? p->buffer_bytes : 128u << 20;
    uint32_t fit = bytes / (cells_of_grid(p) * (uint32_t)(4 * sizeof(float)));
    fit = fit > 0 ? fit : 1;
    return fit < p->num_ordinates ? fit : p->num_ordinates;
}

// Do surfaces stop any of the light?
static bool shadowed(const tyn_propagate_rect_params *p)
{
    return p->num_mapped || p->num_triangles;
}

static uint32_t tiles_of(const tyn_propagate_rect_params *p)
{
    return (uint32_t)ceil(sqrt((double)(p->num_ordinates * p->channels)));
}

// Texels of the shrunk medium, no larger than half a cell of any grid; {0} if the medium's own will do.
// A grid's cells are the smallest if its box is no longer than that of the medium.
static tyn_extent small_of(const tyn_propagate_rect_params *p)
{
    double longest = fmax(p->extent[0], fmax(p->extent[1], p->extent[2]));
    uint32_t size[3];
    bool shrinks = false;
    for (int i = 0; i < 3; i++) {
        double voxels = p->size[i] * (longest / p->cells) / p->extent[i]; // along a cell
        uint32_t step = (uint32_t)fmax(floor(0.5 * voxels), 1);
        size[i] = (p->size[i] + step - 1) / step;
        shrinks = shrinks || step > 1;
    }
    return shrinks ? (tyn_extent){size[0], size[1], size[2]} : (tyn_extent){0, 0, 0};
}

static float voxel_of(const tyn_propagate_rect_params *p)
{
    tyn_extent small = small_of(p);
    const uint32_t shrunk[3] = {small.x, small.y, small.z};
    float finest = INFINITY;
    for (int i = 0; i < 3; i++) {
        finest = fminf(finest, p->extent[i] / (float)(small.x ? shrunk[i] : p->size[i]));
    }
    return finest;
}

// ---- the pass ---------------------------------------------------------------------------------

static tyn_result declare(tyn_builder *b, const void *data)
{
    const tyn_propagate_rect_params *p = data;
    if (p->num_ordinates == 0 || p->num_ordinates > TYN_ORDINATES_MAX) {
        tyn_log_print(tyn_build_log(b), TYN_LOG_ERROR,
                      "propagate_rect: %u ordinates, must be 1 to %d", p->num_ordinates,
                      TYN_ORDINATES_MAX);
        return TYN_ERR_PARAMS;
    }
    uint32_t cells = (uint32_t)p->cells, tiles = tiles_of(p),
             stacks = p->num_ordinates * p->channels;
    uint64_t numbers = (uint64_t)batch(p) * cells_of_grid(p);
    tyn_extent tiled = {cells * tiles, cells * ((stacks + tiles - 1) / tiles), cells};
    tyn_extent small = small_of(p);
    tyn_build_buffer(b, PORT(GRIDS), p->num_ordinates * sizeof(struct propagate_grid));
    tyn_build_buffer(b, PORT(PLACES), TYN_ORDINATES_MAX * sizeof(struct propagate_place));
    tyn_build_buffer(b, PORT(CELLS), numbers * 4 * sizeof(float));
    tyn_build_buffer(b, PORT(LIT),
                     shadowed(p) ? numbers / p->channels * sizeof(float) : sizeof(float));
    tyn_build_buffer(b, PORT(STATE), numbers * 4 * sizeof(float));
    tyn_build_buffer(b, PORT(STATE_OTHER), numbers * 4 * sizeof(float));
    tyn_build_buffer(b, PORT(SUM), numbers * sizeof(float));
    tyn_build_image(b, PORT(SEEN), tiled, 1);
    if (p->keep_light) {
        tyn_build_image(b, PORT(LIGHT), tiled, 1);
    }
    if (small.x && p->mode == TYN_MEDIUM_COEFFICIENTS) {
        tyn_build_format(b, PORT(SMALL), VK_FORMAT_R32G32B32A32_SFLOAT); // before the image is made
        tyn_build_image(b, PORT(SMALL_SIGMA_A), small, 1);
        tyn_build_image(b, PORT(SMALL_G), small, 1);
    }
    if (small.x) {
        tyn_build_image(b, PORT(SMALL), small, 1);
    }
    return TYN_OK;
}

static void record_shrink(tyn_recorder *r, const tyn_propagate_rect_params *p)
{
    bool density = p->mode == TYN_MEDIUM_DENSITY;
    TYN_DISPATCH(r, .kernel = density ? SHRINK_DENSITY : SHRINK_COEFFICIENTS, .cells = small_of(p),
                 .spec = &p->mode);
}

// All iterations of args->count grids from args->first.
static void record_batch(tyn_recorder *r, const tyn_propagate_rect_params *p,
                         const struct propagate_rect_args *args)
{
    static const uint8_t small[][2] = {{PORT(DENSITY), PORT(SMALL)},
                                       {PORT(SIGMA_A), PORT(SMALL_SIGMA_A)},
                                       {PORT(G), PORT(SMALL_G)}};
    static const uint8_t swap[][2] = {{PORT(STATE), PORT(STATE_OTHER)},
                                      {PORT(STATE_OTHER), PORT(STATE)}};
    uint8_t table[TYN_MAX_BINDINGS];
    uint32_t layers = (args->cells + EDGE - 1) / EDGE * EDGE; // no workgroup has cells of two grids
    uint32_t stacks = args->count * args->channels;
    const uint32_t start[] = {(uint32_t)p->init, shadowed(p)};
    tyn_extent all = {args->cells, args->cells, layers * stacks};
    uint32_t shrunk = !small_of(p).x ? 0 : p->mode == TYN_MEDIUM_COEFFICIENTS ? 3 : 1;

    TYN_DISPATCH(r, .kernel = CELLS, .cells = {args->cells, args->cells, layers * args->count},
                 .args = args, .ports = tyn_ports_exchanged(&kernels[CELLS], small, shrunk, table),
                 .spec = &p->mode);
    tyn_extent columns = {args->cells, args->cells, args->count};
    if (args->first < p->num_mapped) {
        TYN_DISPATCH(r, .kernel = LIT_MAPS, .cells = columns, .args = args);
    }
    if (p->num_triangles && args->first + args->count > p->num_mapped) {
        TYN_DISPATCH(r, .kernel = LIT_TRACED, .cells = columns, .args = args);
    }
    // The states are written alternately, so that the last one lands in the output.
    bool other = p->iterations % 2 != 0;
    TYN_DISPATCH(r, .kernel = START, .cells = {args->cells, args->cells, stacks}, .args = args,
                 .ports = tyn_ports_exchanged(&kernels[START], swap, other ? 2 : 0, table),
                 .spec = start);
    for (int32_t m = 0; m < p->iterations; m++) {
        other = !other;
        TYN_DISPATCH(r, .kernel = STEP, .cells = all, .args = args,
                     .ports = tyn_ports_exchanged(&kernels[STEP], swap, other ? 2 : 0, table),
                     .spec = &start[1]);
    }
    TYN_DISPATCH(r, .kernel = COLLECT, .cells = all, .args = args);
    if (p->keep_light) {
        TYN_DISPATCH(r, .kernel = LIGHT, .cells = all, .args = args);
    }
}

static void record(tyn_recorder *r, const void *data)
{
    const tyn_propagate_rect_params *p = data;
    struct propagate_rect_args args = {
        .cells = (uint32_t)p->cells,
        .channels = p->channels,
        .num_ordinates = p->num_ordinates,
        .last_event = p->last_event,
        .rate = (uint32_t)p->rate,
        .prefilter = (uint32_t)p->prefilter,
        .beta = p->beta,
        .voxel = voxel_of(p),
        .tiles = tiles_of(p),
        .num_mapped = p->num_mapped,
    };
    TYN_DISPATCH(r, .kernel = SETUP, .cells = {p->num_ordinates, 1, 1}, .args = &args);
    if (small_of(p).x) {
        record_shrink(r, p);
    }
    // Fetches at a tile's edge give the tile behind it a weight of 0: no grid may be there, but numbers.
    tyn_rec_clear(r, PORT(SEEN));
    if (p->keep_light) {
        tyn_rec_clear(r, PORT(LIGHT));
    }
    for (args.first = 0; args.first < p->num_ordinates; args.first += args.count) {
        uint32_t left = p->num_ordinates - args.first, fit = batch(p);
        args.count = left < fit ? left : fit;
        record_batch(r, p, &args);
    }
    double hops = (double)cells_of_grid(p) * p->num_ordinates * p->iterations;
    tyn_rec_work(r, "cells", hops);
    tyn_rec_work(r, "flops", hops * 150); // counted by hand
    tyn_rec_work(r, "bytes", hops * 56);
    tyn_rec_work(r, "iterations", p->iterations);
}

const tyn_pass_desc tyn_pass_propagate_rect = {
    .name = "propagate_rect",
    .summary = "light of each ordinate moved cell by cell in its aligned grid (Elek 2014)",
    TYN_PASS_TABLES(tyn_propagate_rect_params),
    .params = params,
    .num_params = TYN_COUNT(params),
    .debug_port = PORT(SEEN),
    .debug_meaning = "radiance sent to the eye, middle of the aligned grids",
};
