// propagate_radial.c -- see propagate_radial.h.
#include "propagate_radial.h"
#include "propagate_radial_args.h"
#include "passes/propagate_radial_tables.h"
#include "shaders/common/scene_args.h"
#include <math.h>

#define PORT(name) PROPAGATE_RADIAL_PORT_##name

#define EDGE PROPAGATE_RADIAL_GROUP

#define FIELD(name) offsetof(tyn_propagate_radial_params, name)
static const tyn_param params[] = {
    {"cells", TYN_PARAM_INT, FIELD(cells), 20, 2, 64, "cells",
     "along a side of the octahedral map of directions; odd numbers count as the next even one"},
    {"shells", TYN_PARAM_INT, FIELD(shells), 20, 1, 64, "cells",
     "along a direction, the ball around the light aside"},
    {"iterations", TYN_PARAM_INT, FIELD(iterations), 20, 1, 256, "",
     "hops from cell to cell; light needs one a shell to get to the outermost"},
    {"init", TYN_PARAM_ENUM, FIELD(init), PROPAGATE_RADIAL_INIT_ENTRY, 0, 1, "",
     "light before the first hop: all of it in the ball around the light, or what scatters for the "
     "first time in every cell",
     (const char *const[]){"entry", "first_collision"}},
    {"scale", TYN_PARAM_ENUM, FIELD(scale), TYN_PROPAGATE_SCALE_POWER, 0, 2, "",
     "from shell to shell: power is kept, or is kept and exchanged at the rate of the smaller "
     "cell, "
     "or radiance falls with the spacing of the shells, as the paper says",
     (const char *const[]){"power", "reciprocal", "spacing"}},
    {"narrowing", TYN_PARAM_BOOL, FIELD(narrowing), 0, 0, 1, "",
     "lobes narrow about the radius on their way outwards, as in vacuum; not in the paper"},
    {"last_event", TYN_PARAM_BOOL, FIELD(last_event), 1, 0, 1, "",
     "scatter once more towards the eye: hg(mu, g a) instead of the incident hg(mu, a)"},
    {"rate", TYN_PARAM_ENUM, FIELD(rate), TYN_PROPAGATE_RATE_PAPER, 0, 1, "",
     "how a hop lowers the mean cosine: paper is g^(sigma_s t), exact is exp(-(1 - g) sigma_s t)",
     (const char *const[]){"paper", "exact"}},
    {"prefilter", TYN_PARAM_BOOL, FIELD(prefilter), 1, 0, 1, "",
     "lights that stand for a disc start with its mean cosine"},
    {"beta", TYN_PARAM_FLOAT, FIELD(beta), 1, 0.01, 1000, "", "exponent of the prefilter"},
    {"vpl_cells", TYN_PARAM_INT, FIELD(vpl_cells), 8, 2, 32, "cells",
     "along a side of the maps of lights that stand for reflections and emission of surfaces, and "
     "shells"},
};

// ---- sizes ------------------------------------------------------------------------------------

static uint32_t side_of(const tyn_propagate_radial_params *p)
{
    return ((uint32_t)p->cells + 1) & ~1u; // opposite directions are both centres of texels
}

static uint32_t layers_of(const tyn_propagate_radial_params *p)
{
    return (uint32_t)p->shells + 1;
}

static uint32_t num_grids(const tyn_propagate_radial_params *p)
{
    return p->num_lamps + p->max_vpls;
}

static uint32_t cells_of_grid(const tyn_propagate_radial_params *p)
{
    return side_of(p) * side_of(p) * layers_of(p) * p->channels;
}

// Grids of a batch: as many as storage buffers hold.
static uint32_t batch(const tyn_propagate_radial_params *p)
{
    const uint32_t bytes = p->buffer_bytes ? p->buffer_bytes : 128u << 20;
    uint32_t fit = bytes / (cells_of_grid(p) * (uint32_t)(4 * sizeof(float)));
    fit = fit > 0 ? fit : 1;
    return fit < num_grids(p) ? fit : num_grids(p);
}

static uint32_t tiles_of(const tyn_propagate_radial_params *p)
{
    return (uint32_t)ceil(sqrt((double)(num_grids(p) * p->channels)));
}

// ---- the pass ---------------------------------------------------------------------------------

static tyn_result declare(tyn_builder *b, const void *data)
{
    const tyn_propagate_radial_params *p = data;
    if (num_grids(p) == 0 || p->num_lamps > TYN_RADIAL_LAMPS_MAX ||
        p->max_vpls > TYN_RADIAL_VPLS_MAX) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "propagate_radial: %u lamps and %u VPLs, must be 1 to %d and 0 to %d",
                         p->num_lamps, p->max_vpls, TYN_RADIAL_LAMPS_MAX, TYN_RADIAL_VPLS_MAX);
    }
    uint32_t side = side_of(p), tile = side + 2, tiles = tiles_of(p);
    uint32_t stacks = num_grids(p) * p->channels;
    uint64_t numbers = (uint64_t)batch(p) * cells_of_grid(p);
    tyn_build_buffer(b, PORT(GRIDS), num_grids(p) * sizeof(struct propagate_radial_grid));
    tyn_build_buffer(b, PORT(PLACES), num_grids(p) * sizeof(struct propagate_radial_place));
    tyn_build_buffer(b, PORT(MAP), (uint64_t)num_grids(p) * side * side * 2 * sizeof(float));
    tyn_build_buffer(b, PORT(CELLS), numbers * 4 * sizeof(float));
    tyn_build_buffer(b, PORT(LIT),
                     p->shadowed ? numbers / p->channels * sizeof(float) : sizeof(float));
    tyn_build_buffer(b, PORT(STATE), numbers * 4 * sizeof(float));
    tyn_build_buffer(b, PORT(STATE_OTHER), numbers * 4 * sizeof(float));
    tyn_build_buffer(b, PORT(SUM), numbers * sizeof(float));
    tyn_build_buffer(b, PORT(LAMPS), sizeof p->lamps);
    tyn_build_image(b, PORT(SEEN),
                    (tyn_extent){tile * tiles, tile * ((stacks + tiles - 1) / tiles), layers_of(p)},
                    1);
    return TYN_OK;
}

// All iterations of args->count grids from args->first.
static void record_batch(tyn_recorder *r, const tyn_propagate_radial_params *p,
                         const struct propagate_radial_args *args)
{
    static const uint8_t swap[][2] = {{PORT(STATE), PORT(STATE_OTHER)},
                                      {PORT(STATE_OTHER), PORT(STATE)}};
    uint8_t table[TYN_MAX_BINDINGS];
    uint32_t side = args->cells, stacks = args->count * args->channels;
    uint32_t layers =
        (args->layers + EDGE - 1) / EDGE * EDGE; // no workgroup has cells of two grids
    tyn_extent all = {side, side, layers * stacks};
    TYN_DISPATCH(r, .kernel = KERNEL_CELLS, .cells = {side, side, layers * args->count},
                 .args = args, .spec = &p->mode);
    tyn_extent columns = {side, side, args->count};
    if (p->shadowed && args->first < p->num_lamps) {
        TYN_DISPATCH(r, .kernel = KERNEL_LIT_LAMPS, .cells = columns, .args = args);
    }
    if (p->shadowed && args->first + args->count > p->num_lamps) {
        TYN_DISPATCH(r, .kernel = KERNEL_LIT_VPLS, .cells = columns, .args = args);
    }
    // The states are written alternately, so that the last one lands in the output.
    bool other = p->iterations % 2 != 0;
    TYN_DISPATCH(r, .kernel = KERNEL_START, .cells = {side, side, stacks}, .args = args,
                 .ports = tyn_ports_exchanged(&kernels[KERNEL_START], swap, other ? 2 : 0, table),
                 .spec = &p->shadowed);
    for (int32_t m = 0; m < p->iterations; m++) {
        other = !other;
        TYN_DISPATCH(r, .kernel = KERNEL_STEP, .cells = all, .args = args,
                     .ports =
                         tyn_ports_exchanged(&kernels[KERNEL_STEP], swap, other ? 2 : 0, table),
                     .spec = &p->shadowed);
    }
    TYN_DISPATCH(r, .kernel = KERNEL_COLLECT, .cells = {side + 2, side + 2, layers * stacks},
                 .args = args);
}

static void record(tyn_recorder *r, const void *data)
{
    const tyn_propagate_radial_params *p = data;
    struct propagate_radial_args args = {
        .cells = side_of(p),
        .layers = layers_of(p),
        .channels = p->channels,
        .num_lamps = p->num_lamps,
        .max_vpls = p->max_vpls,
        .init = (uint32_t)p->init,
        .scale = (uint32_t)p->scale,
        .last_event = p->last_event,
        .rate = (uint32_t)p->rate,
        .narrowing = p->narrowing,
        .prefilter = p->prefilter,
        .beta = p->beta,
        .voxel = INFINITY,
        .tiles = tiles_of(p),
    };
    for (int i = 0; i < 3; i++) {
        args.voxel = fminf(args.voxel, p->extent[i] / (float)p->size[i]);
    }
    tyn_rec_update(r, PORT(LAMPS), 0, p->lamps, sizeof p->lamps);
    TYN_DISPATCH(r, .kernel = KERNEL_SETUP, .cells = {PROPAGATE_RADIAL_LANES * num_grids(p), 1, 1},
                 .args = &args);
    // Tiles without a grid must be numbers: a linear fetch at an edge gives them a weight of 0.
    tyn_rec_clear(r, PORT(SEEN));
    for (args.first = 0; args.first < num_grids(p); args.first += args.count) {
        uint32_t left = num_grids(p) - args.first, fit = batch(p);
        args.count = left < fit ? left : fit;
        record_batch(r, p, &args);
    }
    double hops = (double)cells_of_grid(p) * num_grids(p) * p->iterations;
    tyn_rec_work(r, "cells", hops);
    tyn_rec_work(r, "flops", hops * 260); // counted by hand
    tyn_rec_work(r, "bytes", hops * 200);
    tyn_rec_work(r, "iterations", p->iterations);
}

const tyn_pass_desc tyn_pass_propagate_radial = {
    .name = "propagate_radial",
    .summary = "light of each lamp moved cell by cell in its radial grid (Elek 2014)",
    TYN_PASS_TABLES(tyn_propagate_radial_params),
    TYN_SETTINGS(params),
    .debug_port = PORT(SEEN),
    .debug_meaning = "radiance sent to the eye times r^2, middle of the radial grids",
};
