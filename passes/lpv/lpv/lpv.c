// lpv.c -- power moves on to 26 neighbours, iteration by iteration.
#include "lpv.h"
#include "lpv_args.h"
#include "shaders/common/counters.h"
#include "passes/lpv_tables.h"
#include <math.h>

_Static_assert((int)TYN_LPV_BLOCKERS_EXACT == LPV_BLOCKERS_EXACT &&
                   (int)TYN_LPV_BLOCKERS_FUZZY == LPV_BLOCKERS_FUZZY,
               "the method and the kernels have the same numbers");

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_lpv_params *p = params;
    const uint32_t channels = p->shape.channels;
    const tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    const tyn_extent texels = {dims.x, dims.y, dims.z * channels};
    const tyn_extent cells = tyn_build_extent(b, LPV_PORT_CELLS);
    if (cells.x != texels.x || cells.y != texels.y || cells.z != texels.z) {
        return TYN_FAULT(
            tyn_build_log(b), TYN_ERR_PARAMS,
            "pass 'lpv': 'cells' has %u x %u x %u texels; its own shape has %u x %u x %u", cells.x,
            cells.y, cells.z, texels.x, texels.y, texels.z);
    }
    const uint64_t n = (uint64_t)texels.x * texels.y * texels.z;
    const uint32_t shells = p->extinction == LPV_EXTINCTION_PAPER ? 1 : LPV_SHELLS;
    tyn_build_image(b, LPV_PORT_MOMENTS, texels, 1);
    tyn_build_buffer(b, LPV_PORT_LEAKS, sizeof(float) * (p->balance ? n : channels));
    tyn_build_buffer(b, LPV_PORT_WALL_POWER, 2 * sizeof(float) * (p->balance ? n : 1));
    tyn_build_buffer(b, LPV_PORT_SENT_0, 4 * sizeof(float) * shells * n);
    tyn_build_buffer(b, LPV_PORT_SENT_1, 4 * sizeof(float) * shells * n);
    tyn_build_buffer(b, LPV_PORT_SUM, 4 * sizeof(float) * n);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_lpv_params *p = params;
    const float *extent = p->shape.extent;
    const tyn_extent dims = tyn_lattice_dims(extent, p->shape.cells);
    const tyn_extent texels = {dims.x, dims.y, dims.z * p->shape.channels};
    const struct lpv_args args = {
        .dims = {dims.x, dims.y, dims.z},
        .channels = p->shape.channels,
        .tint = {p->shape.tint[0], p->shape.tint[1], p->shape.tint[2]},
        .dx = fmaxf(extent[0], fmaxf(extent[1], extent[2])) / (float)p->shape.cells,
        .own = p->own,
    };
    const uint32_t extinction = (uint32_t)p->extinction;
    const uint32_t start[3] = {extinction, tyn_rec_has(r, LPV_PORT_REFLECTED),
                               tyn_rec_has(r, LPV_PORT_SCATTERED)};
    const uint32_t blockers = tyn_rec_has(r, LPV_PORT_WALL_LINKS) ? LPV_BLOCKERS_EXACT
                              : tyn_rec_has(r, LPV_PORT_BLOCKING) ? LPV_BLOCKERS_FUZZY
                                                                  : LPV_BLOCKERS_NONE;
    static const uint8_t other_way[][2] = {{LPV_PORT_SENT_0, LPV_PORT_SENT_1},
                                           {LPV_PORT_SENT_1, LPV_PORT_SENT_0}};
    uint8_t exchanged[TYN_MAX_BINDINGS];
    tyn_rec_fill(r, LPV_PORT_LEAKS, 0);
    tyn_rec_fill(r, LPV_PORT_WALL_POWER, 0);
    TYN_DISPATCH(r, .kernel = KERNEL_START, .cells = texels, .args = &args, .spec = start);
    for (int32_t i = 0; i < p->iterations; i++) {
        const uint32_t spec[6] = {extinction,
                                  blockers,
                                  p->balance ? 1 + (blockers != LPV_BLOCKERS_NONE) : 0,
                                  i == 0 && tyn_rec_has(r, LPV_PORT_ENVIRONMENT),
                                  i + 1 == p->iterations,
                                  p->bounces == TYN_LPV_BOUNCES_ALL};
        TYN_DISPATCH(r, .kernel = KERNEL_STEP, .cells = texels, .args = &args, .spec = spec,
                     .ports =
                         i % 2 ? tyn_ports_exchanged(&kernels[KERNEL_STEP], other_way, 2, exchanged)
                               : NULL);
    }
    const double cells = (double)texels.x * texels.y * texels.z * p->iterations;
    tyn_rec_work(r, "cells", cells);
    // A link: 5 products to extract, 5 to deposit; the medium: 30.
    tyn_rec_work(r, "flops", cells * (LPV_LINKS * 18 + 30));
    tyn_rec_work(r, "bytes", cells * (16.0 * LPV_LINKS + 64));
}

static const char *const extinctions[] = {"paper", "exact"};
static const char *const blocker_names[] = {"none", "exact", "fuzzy"};

static const char *const bounce_names[] = {"one", "all"};
static const char *const injections[] = {"cells", "shadow_map", "none"};

static const tyn_param param_table[] = {
    {"cells", TYN_PARAM_INT, offsetof(tyn_lpv_params, shape.cells), 32, 4, TYN_LATTICE_MAX_CELLS,
     "cells", "lattice cells along the longest side of the medium; 262144 in all", NULL},
    {"iterations", TYN_PARAM_INT, offsetof(tyn_lpv_params, iterations), 8, 1, 512, "",
     "of the propagation, each to the next cells: light gets no farther", NULL},
    {"extinction", TYN_PARAM_ENUM, offsetof(tyn_lpv_params, extinction), LPV_EXTINCTION_PAPER, 0, 1,
     "",
     "along a link: paper = 1 - sigma_t d, d the mean length of links; exact = e^(-sigma_t times "
     "its own length)",
     extinctions},
    {"blockers", TYN_PARAM_ENUM, offsetof(tyn_lpv_params, blockers), LPV_BLOCKERS_EXACT, 0, 2, "",
     "what stops light at surfaces: none; exact = links that triangles cut; fuzzy = six depth maps "
     "in spherical harmonics, as published",
     blocker_names},
    {"bounces", TYN_PARAM_ENUM, offsetof(tyn_lpv_params, bounces), TYN_LPV_BOUNCES_ONE, 0, 1, "",
     "reflections at surfaces: one, as published; all = what exact blockers stop is reflected too",
     bounce_names},
    {"inject", TYN_PARAM_ENUM, offsetof(tyn_lpv_params, inject), TYN_LPV_INJECT_CELLS, 0, 2, "",
     "light that scatters first: cells = integrated over each cell; shadow_map = samples along "
     "rays "
     "of suns and lamps, as published",
     injections},
    {"own", TYN_PARAM_FLOAT, offsetof(tyn_lpv_params, own), 0, 0, 1, "",
     "share of what scatters or is emitted in a cell that counts there before it moves on; 0 as "
     "published, 0.5 the trapezoidal rule",
     NULL},
    {"reflect", TYN_PARAM_BOOL, offsetof(tyn_lpv_params, reflect), 1, 0, 1, "",
     "light that surfaces reflect of suns and lamps starts in the lattice", NULL},
};

const tyn_pass_desc tyn_pass_lpv = {
    .name = "lpv",
    .summary = "light that has scattered, moved from cell to cell of a light propagation volume",
    .serves = "media that scatter more than once",
    TYN_PASS_TABLES(tyn_lpv_params),
    TYN_SETTINGS(param_table),
    .debug_port = LPV_PORT_MOMENTS,
    .debug_meaning = "fluence and flux of the scattered light in a slice, W/m^2",
    TYN_COUNTS(LPV_PORT_COUNTERS, struct counters_block, TYN_COUNTER_NON_FINITE,
               {"bounded", offsetof(struct counters_block, clamped)}),
};
