// propagate_rect.c -- see propagate_rect.h.
#include "propagate_rect.h"
#include "propagate_rect_args.h"
#include "passes/propagate_rect_tables.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/common/scene_args.h"
#include <math.h>

#define PORT(name) PROPAGATE_RECT_PORT_##name

#define EDGE PROPAGATE_RECT_GROUP
#define ARGS sizeof(struct propagate_rect_args)

#define FIELD(name) offsetof(tyn_propagate_rect_params, name)
static const tyn_param params[] = {
    {"cells", TYN_PARAM_INT, FIELD(cells), 20, 2, 128, "cells",
     "cubic cells along the longest side of the box aligned with the light, or cells across it"},
    {"cells_along", TYN_PARAM_INT, FIELD(cells_along), 0, 0, 128, "cells",
     "cells along the light; 0 = cubes"},
    {"cones", TYN_PARAM_ENUM, FIELD(cones), TYN_PROPAGATE_CONES_PAPER, 0, 1, "",
     "of cells that are not cubes: what goes ahead is within 45 degrees, or what meets the cell's "
     "end",
     (const char *const[]){"paper", "cell"}},
    {"iterations", TYN_PARAM_INT, FIELD(iterations), 20, 1, 256, "",
     "hops from cell to cell; the paper takes about as many as cells"},
    {"threshold", TYN_PARAM_FLOAT, FIELD(threshold), 0, 0, 1, "of the largest irradiance",
     "hops end where no cell has more light than that (the paper's epsilon_L); 0 = never"},
    {"init", TYN_PARAM_ENUM, FIELD(init), TYN_PROPAGATE_INIT_ENTRY, 0, 3, "",
     "light before the first hop: entry is the only one that has the right power without "
     "scattering",
     (const char *const[]){"entry", "all_transmittance", "all_absorption", "first_collision"}},
    {"last_event", TYN_PARAM_BOOL, FIELD(last_event), 1, 0, 1, "",
     "scatter once more towards the eye: hg(mu, g a) instead of the incident hg(mu, a)"},
    {"rate", TYN_PARAM_ENUM, FIELD(rate), TYN_PROPAGATE_RATE_PAPER, 0, 1, "",
     "how a hop lowers the mean cosine: paper is g^(sigma_s t), exact is exp(-(1 - g) sigma_s t)",
     (const char *const[]){"paper", "exact"}},
    {"prefilter", TYN_PARAM_ENUM, FIELD(prefilter), TYN_PROPAGATE_PREFILTER_EXACT, 0, 2, "",
     "mean cosine of an ordinate's light as it enters: 1, (1 - w / N)^beta, or 1 - its part of the "
     "sphere",
     (const char *const[]){"off", "heuristic", "exact"}},
    {"beta", TYN_PARAM_FLOAT, FIELD(beta), 1, 0.01, 1000, "",
     "exponent of the heuristic prefilter; 1 is exact for regions of equal size"},
};

// ---- sizes ------------------------------------------------------------------------------------

// Cells of a grid along the light.
static uint32_t along(const tyn_propagate_rect_params *p)
{
    return (uint32_t)(p->cells_along ? p->cells_along : p->cells);
}

static uint32_t cells_of_grid(const tyn_propagate_rect_params *p)
{
    return (uint32_t)(p->cells * p->cells) * along(p) * p->channels;
}

// Grids of a batch: as many as storage buffers hold.
static uint32_t batch(const tyn_propagate_rect_params *p)
{
    const uint32_t bytes = p->buffer_bytes ? p->buffer_bytes : 128u << 20;
    uint32_t fit = bytes / (cells_of_grid(p) * (uint32_t)(4 * sizeof(float)));
    fit = fit > 0 ? fit : 1;
    return fit < p->num_ordinates ? fit : p->num_ordinates;
}

static uint32_t batches(const tyn_propagate_rect_params *p)
{
    return (p->num_ordinates + batch(p) - 1) / batch(p);
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

// The smallest edge that a cell of any grid may have, m. Cubes are the smallest if the grid's box is no longer than that of
// the medium. Others: a box is no shorter along the light than the medium's shortest side, and across no narrower than
// the middle one (of oblique boxes 0.7 of it).
static double smallest_edge(const tyn_propagate_rect_params *p)
{
    const float *e = p->extent;
    double longest = fmax(e[0], fmax(e[1], e[2])), shortest = fmin(e[0], fmin(e[1], e[2]));
    double middle = fmax(fmin(e[0], e[1]), fmin(fmax(e[0], e[1]), e[2]));
    return p->cells_along ? fmin(middle / p->cells, shortest / p->cells_along) : longest / p->cells;
}

// Texels of the shrunk medium, no larger than half a cell of any grid; {0} if the medium's own will do.
static tyn_extent small_of(const tyn_propagate_rect_params *p)
{
    const double edge = smallest_edge(p);
    uint32_t size[3];
    bool shrinks = false;
    for (int i = 0; i < 3; i++) {
        double voxels = p->size[i] * edge / p->extent[i]; // along a cell
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
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "propagate_rect: %u ordinates, must be 1 to %d", p->num_ordinates,
                         TYN_ORDINATES_MAX);
    }
    uint32_t cells = (uint32_t)p->cells, tiles = tiles_of(p),
             stacks = p->num_ordinates * p->channels;
    uint64_t numbers = (uint64_t)batch(p) * cells_of_grid(p);
    tyn_extent tiled = {cells * tiles, cells * ((stacks + tiles - 1) / tiles), along(p)};
    tyn_extent small = small_of(p);
    tyn_build_buffer(b, PORT(GRIDS), p->num_ordinates * sizeof(struct propagate_grid));
    tyn_build_buffer(b, PORT(PLACES), TYN_ORDINATES_MAX * sizeof(struct propagate_place));
    tyn_build_buffer(b, PORT(CELLS), numbers * 4 * sizeof(float));
    tyn_build_buffer(b, PORT(LIT),
                     shadowed(p) ? numbers / p->channels * sizeof(float) : sizeof(float));
    tyn_build_buffer(b, PORT(STATE), numbers * 4 * sizeof(float));
    tyn_build_buffer(b, PORT(STATE_OTHER), numbers * 4 * sizeof(float));
    tyn_build_buffer(b, PORT(SUM), numbers * sizeof(float));
    if (p->threshold > 0) {
        const uint64_t words = PROPAGATE_FLIGHT_FIRST + (uint64_t)(batches(p) * p->iterations);
        tyn_build_buffer(b, PORT(FLIGHT), words * sizeof(uint32_t));
    }
    tyn_build_buffer(b, PORT(LAUNCHES), sizeof(struct propagate_launches));
    tyn_build_buffer(b, PORT(BESIDE), (p->cells_along ? numbers : 1) * sizeof(float));
    tyn_build_buffer(b, PORT(BESIDE_OTHER), (p->cells_along ? numbers : 1) * sizeof(float));
    tyn_build_image(b, PORT(SEEN), tiled, 1);
    if (p->keep_light) {
        tyn_build_image(b, PORT(LIGHT), tiled, 1);
    }
    if (small.x && p->mode != TYN_MEDIUM_DENSITY) {
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
    TYN_DISPATCH(r, .kernel = density ? KERNEL_SHRINK_DENSITY : KERNEL_SHRINK_COEFFICIENTS,
                 .cells = small_of(p), .spec = &p->mode);
}

// All iterations of args->count grids from args->first.
static void record_batch(tyn_recorder *r, const tyn_propagate_rect_params *p,
                         struct propagate_rect_args *args)
{
    static const uint8_t small[][2] = {{PORT(DENSITY), PORT(SMALL)},
                                       {PORT(SIGMA_A), PORT(SMALL_SIGMA_A)},
                                       {PORT(G), PORT(SMALL_G)}};
    static const uint8_t swap[][2] = {{PORT(STATE), PORT(STATE_OTHER)},
                                      {PORT(STATE_OTHER), PORT(STATE)},
                                      {PORT(BESIDE), PORT(BESIDE_OTHER)},
                                      {PORT(BESIDE_OTHER), PORT(BESIDE)}};
    uint8_t table[TYN_MAX_BINDINGS];
    uint32_t layers = (args->along + EDGE - 1) / EDGE * EDGE; // no workgroup has cells of two grids
    uint32_t stacks = args->count * args->channels;
    const uint32_t stretched = p->cells_along != 0;
    const uint32_t start[] = {(uint32_t)p->init, shadowed(p), stretched};
    const uint32_t step[] = {shadowed(p), stretched, p->threshold > 0};
    tyn_extent all = {args->cells, args->cells, layers * stacks};
    uint32_t shrunk = !small_of(p).x ? 0 : p->mode != TYN_MEDIUM_DENSITY ? 3 : 1;

    TYN_DISPATCH(r, .kernel = KERNEL_CELLS,
                 .cells = {args->cells, args->cells, layers * args->count}, .args = args,
                 .ports = tyn_ports_exchanged(&kernels[KERNEL_CELLS], small, shrunk, table),
                 .spec = &p->mode);
    tyn_extent columns = {args->cells, args->cells, args->count};
    if (args->first < p->num_mapped) {
        TYN_DISPATCH(r, .kernel = KERNEL_LIT_MAPS, .cells = columns, .args = args);
    }
    if (p->num_triangles && args->first + args->count > p->num_mapped) {
        TYN_DISPATCH(r, .kernel = KERNEL_LIT_TRACED, .cells = columns, .args = args);
    }
    // The states are written alternately, so that the last one lands in the output.
    bool other = p->iterations % 2 != 0;
    TYN_DISPATCH(r, .kernel = KERNEL_START, .cells = {args->cells, args->cells, stacks},
                 .args = args,
                 .ports = tyn_ports_exchanged(&kernels[KERNEL_START], swap,
                                              other ? TYN_COUNT(swap) : 0, table),
                 .spec = start);
    for (int32_t m = 0; m < p->iterations; m++) {
        other = !other;
        args->iteration = (uint32_t)m + 1;
        const tyn_dispatch d = {
            .kernel = KERNEL_STEP,
            .cells = all,
            .args = args,
            .ports = tyn_ports_exchanged(&kernels[KERNEL_STEP], swap, other ? TYN_COUNT(swap) : 0,
                                         table),
            .spec = step,
        };
        if (p->threshold > 0) {
            TYN_DISPATCH(r, .kernel = KERNEL_NEXT, .cells = {1, 1, 1}, .args = args);
            tyn_rec_dispatch_indirect(r, &d, PORT(LAUNCHES),
                                      offsetof(struct propagate_launches, step));
        } else {
            tyn_rec_dispatch(r, &d);
        }
    }
    if (p->threshold > 0) {
        tyn_rec_dispatch_indirect(r, &(tyn_dispatch){.kernel = KERNEL_COPY, .args = args},
                                  PORT(LAUNCHES), offsetof(struct propagate_launches, copy));
    }
    TYN_DISPATCH(r, .kernel = KERNEL_COLLECT, .cells = all, .args = args);
    if (p->keep_light) {
        TYN_DISPATCH(r, .kernel = KERNEL_LIGHT, .cells = all, .args = args, .spec = &stretched);
    }
}

static void record(tyn_recorder *r, const void *data)
{
    const tyn_propagate_rect_params *p = data;
    struct propagate_rect_args args = {
        .cells = (uint32_t)p->cells,
        .along = along(p),
        .cells_along = (uint32_t)p->cells_along,
        .channels = p->channels,
        .num_ordinates = p->num_ordinates,
        .last_event = p->last_event,
        .rate = (uint32_t)p->rate,
        .prefilter = (uint32_t)p->prefilter,
        .beta = p->beta,
        .voxel = voxel_of(p),
        .tiles = tiles_of(p),
        .num_mapped = p->num_mapped,
        .cones = (uint32_t)p->cones,
        .iterations = (uint32_t)p->iterations,
        .threshold = p->threshold,
    };
    tyn_rec_fill(r, PORT(FLIGHT), 0);
    TYN_DISPATCH(r, .kernel = KERNEL_SETUP, .cells = {p->num_ordinates, 1, 1}, .args = &args);
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
        args.flight += args.iterations;
    }
    double hops = (double)cells_of_grid(p) * p->num_ordinates * p->iterations;
    tyn_rec_work(r, "cells", hops);
    // Else the device knows how many iterations there were, and counts them.
    if (p->threshold <= 0) {
        tyn_rec_work(r, "flops", hops * 150); // counted by hand
        tyn_rec_work(r, "bytes", hops * 56);
        tyn_rec_work(r, "iterations", p->iterations);
    }
}

static const tyn_counter counters[] = {
    {"iterations", PROPAGATE_FLIGHT_RUN * sizeof(uint32_t)},
    {NULL},
};

const tyn_pass_desc tyn_pass_propagate_rect = {
    .name = "propagate_rect",
    .summary = "light of each ordinate moved cell by cell in its aligned grid (Elek 2014)",
    TYN_PASS_TABLES(tyn_propagate_rect_params),
    TYN_SETTINGS(params),
    .debug_port = PORT(SEEN),
    .debug_meaning = "radiance sent to the eye, middle of the aligned grids",
    .counters = counters,
    .counter_port = PORT(FLIGHT),
};
