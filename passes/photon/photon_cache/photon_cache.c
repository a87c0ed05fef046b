// photon_cache.c -- tables and dispatches of the sum of generations.
#include "photon_cache.h"
#include "photon_cache_args.h"
#include "shaders/common/counters.h"
#include "../common/photon_args.h"
#include "passes/photon_cache_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_photon_cache_params *p = params;
    const tyn_extent n = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    tyn_build_buffer(b, PHOTON_CACHE_PORT_LIGHT,
                     sizeof(struct photon_light) * p->lobes * (uint64_t)n.x * n.y * n.z);
    tyn_build_image(b, PHOTON_CACHE_PORT_MOMENTS, (tyn_extent){n.x, n.y, n.z * p->shape.channels},
                    1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_photon_cache_params *p = params;
    const tyn_extent n = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    const struct photon_cache_args args = {
        .dims = {n.x, n.y, n.z},
        .channels = p->shape.channels,
        .tint = {p->shape.tint[0], p->shape.tint[1], p->shape.tint[2]},
        .generations = p->generations,
        .slots = p->slots,
        .lobes = p->lobes,
        .unit = p->unit,
        .majorant = p->majorant,
        .scaled = p->scaled,
        .cell_channels = p->shape.channels,
    };
    TYN_DISPATCH(r, .kernel = KERNEL_PHOTON_CACHE, .cells = {n.x * n.y * n.z, 1, 1}, .args = &args);
    TYN_DISPATCH(r, .kernel = KERNEL_TURN, .cells = {1, 1, 1});
    tyn_rec_work(r, "cells", (double)n.x * n.y * n.z);
}

const tyn_pass_desc tyn_pass_photon_cache = {
    .name = "photon_cache",
    .summary = "the sum of the generations of photons that count",
    TYN_PASS_TABLES(tyn_photon_cache_params),
    .debug_port = PHOTON_CACHE_PORT_MOMENTS,
    .debug_meaning = "fluence and net flux of cells",
    TYN_COUNTS(PHOTON_CACHE_PORT_COUNTERS, struct counters_block,
               {"bounded", offsetof(struct counters_block, clamped)}),
};
