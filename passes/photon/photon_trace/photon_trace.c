// photon_trace.c -- tables and dispatches of the photons.
#include "photon_trace.h"
#include "photon_trace_args.h"
#include "shaders/common/counters.h"
#include "../common/photon_args.h"
#include "passes/photon_trace_tables.h"
#include <math.h>
#include <string.h>

_Static_assert((int)TYN_PHOTON_SIMILARITY_PRINTED == PHOTON_SIMILARITY_PRINTED &&
                   (int)TYN_PHOTON_SIMILARITY_OFF == PHOTON_SIMILARITY_OFF,
               "the method and the kernels have the same numbers");

static uint64_t count_cells(const tyn_photon_trace_params *p)
{
    const tyn_extent n = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    return (uint64_t)n.x * n.y * n.z;
}

static uint32_t renewed(const tyn_photon_trace_params *p)
{
    return (uint32_t)(p->renewed < p->generations ? p->renewed : p->generations);
}

static uint32_t count_slots(const tyn_photon_trace_params *p)
{
    return (uint32_t)p->generations + renewed(p);
}

enum { QUAD = 16 }; // bytes

uint64_t tyn_photon_flux_size(const tyn_photon_trace_params *p)
{
    return QUAD * (uint64_t)p->lobes * count_cells(p) * count_slots(p);
}

uint64_t tyn_photon_ring_size(const tyn_photon_trace_params *p)
{
    return sizeof(struct photon_ring) + tyn_photon_flux_size(p);
}

uint32_t tyn_photon_most_lobes(const tyn_photon_trace_params *p)
{
    return (uint32_t)((PHOTON_MOST_BYTES - sizeof(struct photon_ring)) /
                      (QUAD * count_cells(p) * count_slots(p)));
}

uint64_t tyn_photon_sum_size(const tyn_photon_trace_params *p)
{
    return sizeof(struct photon_sum) + 2 * QUAD * (uint64_t)p->lobes * count_cells(p);
}

// A cell may get what all photons would leave that cross it a few times; in thick cells they stay for longer.
float tyn_photon_units(const tyn_photon_trace_params *p)
{
    const float side = fmaxf(p->shape.extent[0], fmaxf(p->shape.extent[1], p->shape.extent[2])) /
                       (float)p->shape.cells;
    const float most = 4 * p->power * side * (float)p->generations;
    return most > 0 ? (float)PHOTON_WHOLE / most : 1;
}

static uint32_t count_dispatches(const tyn_photon_trace_params *p)
{
    const uint64_t all = (uint64_t)p->photons * (uint64_t)p->generations;
    return (uint32_t)((all + p->batch - 1) / p->batch);
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_photon_trace_params *p = params;
    if (p->batch == 0 || count_dispatches(p) > TYN_PHOTON_DISPATCHES) {
        return TYN_FAULT(
            tyn_build_log(b), TYN_ERR_PARAMS,
            "pass 'photon_trace': %d generations of %d photons in batches of %u are more "
            "than %d dispatches",
            (int)p->generations, (int)p->photons, p->batch, TYN_PHOTON_DISPATCHES);
    }
    if (tyn_photon_most_lobes(p) < (uint32_t)p->lobes) {
        return TYN_FAULT(
            tyn_build_log(b), TYN_ERR_PARAMS,
            "pass 'photon_trace': %d generations of %u cells are more than %d MiB; fewer "
            "of \"photon_trace.cells\" or \"photon_trace.generations\" fit",
            (int)p->generations, (unsigned)count_cells(p), PHOTON_MOST_BYTES >> 20);
    }
    tyn_build_buffer(b, PHOTON_TRACE_PORT_PLAN, sizeof(struct photon_trace_plan));
    tyn_build_buffer(b, PHOTON_TRACE_PORT_GROUPS, 12 * TYN_PHOTON_DISPATCHES);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_photon_trace_params *p = params;
    const tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    const float side = fmaxf(p->shape.extent[0], fmaxf(p->shape.extent[1], p->shape.extent[2])) /
                       (float)p->shape.cells;
    const struct photon_turn_args turn = {
        .all = (uint32_t)p->generations,
        .each = renewed(p),
        .photons = (uint32_t)p->photons,
        .dispatches = count_dispatches(p),
        .batch = p->batch,
        .quads = (uint32_t)((uint64_t)p->lobes * count_cells(p)),
        .slots = count_slots(p),
    };
    struct photon_trace_plan plan = {
        .sun = {p->sun[0], p->sun[1], p->sun[2]},
        .sun_cosine = p->sun_cosine,
        .dims = {dims.x, dims.y, dims.z},
        .photons = turn.photons,
        .slots = turn.slots,
        .lobes = (uint32_t)p->lobes,
        .sky_first = p->sky_first,
        .per_unit = tyn_photon_units(p),
        .least = p->points / side,
        .stop = p->stop,
        .roulette = p->roulette,
        .similarity = (uint32_t)p->similarity,
        .threshold = p->threshold,
        .reduced = p->reduced,
        .per_extinction = p->mean == TYN_PHOTON_MEAN_MEDIUM ? 1 / p->majorant : 0,
        .scaled = p->scaled,
        .beams = p->first == TYN_PHOTON_FIRST_BEAMS,
        .marched = {p->marched[0], p->marched[1], p->marched[2]},
        .num_map_suns = p->num_map_suns,
    };
    memcpy(plan.map_suns, p->map_suns, sizeof plan.map_suns);
    uint32_t spec[TYN_PATH_NUM_SPEC];
    path_specialise(spec, &p->path);
    spec[TYN_PATH_SPEC_HOMOGENEOUS] = 0; // light is left at points that tracking examines
    spec[TYN_PATH_SPEC_FLAGS] &=
        ~(uint32_t)(TYN_PATH_THIN | TYN_PATH_EQUIANGULAR | TYN_PATH_GUIDED | TYN_PATH_EMISSIVE);
    tyn_rec_update(r, PHOTON_TRACE_PORT_PLAN, 0, &plan, sizeof plan);
    TYN_DISPATCH(r, .kernel = KERNEL_TURN, .cells = {1, 1, 1}, .args = &turn);
    TYN_DISPATCH(r, .kernel = KERNEL_CLEAR, .cells = {turn.quads, 1, 1}, .args = &turn);
    for (uint32_t i = 0; i < turn.dispatches; i++) {
        const struct path_args args = path_trace_args(&p->path, i * p->batch, p->batch, 0);
        tyn_rec_dispatch_indirect(
            r, &(tyn_dispatch){.kernel = KERNEL_PHOTON_TRACE, .args = &args, .spec = spec},
            PHOTON_TRACE_PORT_GROUPS, 12ull * i);
    }
    tyn_rec_work(r, "paths", (double)turn.photons * turn.each);
}

static const char *const means[] = {"volume", "medium"};
static const char *const firsts[] = {"cache", "beams"};
static const char *const similarities[] = {"off", "usual", "printed"};

static const tyn_param param_table[] = {
    {"cells", TYN_PARAM_INT, offsetof(tyn_photon_trace_params, shape.cells), 16, 4, 64, "cells",
     "of the cache along the longest side of the medium", NULL},
    {"photons", TYN_PARAM_INT, offsetof(tyn_photon_trace_params, photons), 4096, 64, 1048576, "",
     "of a generation", NULL},
    {"generations", TYN_PARAM_INT, offsetof(tyn_photon_trace_params, generations), 100, 1, 1000, "",
     "that count: the caches of as many frames", NULL},
    {"renewed", TYN_PARAM_INT, offsetof(tyn_photon_trace_params, renewed), 1, 1, 1000, "",
     "generations traced in a frame; the first frame and the next after a cut trace all", NULL},
    {"stop", TYN_PARAM_FLOAT, offsetof(tyn_photon_trace_params, stop), 0.05, 0, 1, "",
     "transmittance at which a beam is ended; 1: where its photon collides", NULL},
    {"roulette", TYN_PARAM_BOOL, offsetof(tyn_photon_trace_params, roulette), 1, 0, 1, "",
     "end beams by chance, so that nothing is lost on average; 0: always, as published", NULL},
    {"similarity", TYN_PARAM_ENUM, offsetof(tyn_photon_trace_params, similarity),
     TYN_PHOTON_SIMILARITY_USUAL, 0, 2, "",
     "where directions are forgotten scatter in all of them alike with: off = no change; usual = "
     "sigma_s (1 - g); printed = sigma_s sqrt(1 - g)",
     similarities},
    {"threshold", TYN_PARAM_FLOAT, offsetof(tyn_photon_trace_params, threshold), 0.05, 0, 0.5, "",
     "mean cosine to its first direction below which a photon has forgotten it", NULL},
    {"points", TYN_PARAM_FLOAT, offsetof(tyn_photon_trace_params, points), 1, 0.1, 16,
     "per cell's edge", "where light is left along a beam, at least", NULL},
    {"lobes", TYN_PARAM_INT, offsetof(tyn_photon_trace_params, lobes), 2, 1, PHOTON_MOST_LOBES, "",
     "of a cell, at most: the strongest suns, regions of the map by principal ordinates, all "
     "other; "
     "2 = the strongest sun and all other, as published",
     NULL},
    {"mean", TYN_PARAM_ENUM, offsetof(tyn_photon_trace_params, mean), TYN_PHOTON_MEAN_MEDIUM, 0, 1,
     "",
     "of light in a cell: volume = over all of it, as published; medium = over what is dense "
     "there, "
     "which is what is seen (probes: volume)",
     means},
    {"first", TYN_PARAM_ENUM, offsetof(tyn_photon_trace_params, first), TYN_PHOTON_FIRST_BEAMS, 0,
     1, "",
     "where suns' and lamps' light scatters first: cache = in the cells, as published; beams = "
     "along "
     "the camera's rays, exactly, with all that has only scattered forward",
     firsts},
};

const tyn_pass_desc tyn_pass_photon_trace = {
    .name = "photon_trace",
    .summary = "photons of all lights, a few in each frame, and the cells that they pass",
    TYN_PASS_TABLES(tyn_photon_trace_params),
    TYN_SETTINGS(param_table),
    .debug_port = PHOTON_TRACE_PORT_COUNTERS,
    .debug_meaning = "points examined, photons cut",
    TYN_COUNTS(PHOTON_TRACE_PORT_COUNTERS, struct counters_block,
               {"steps", offsetof(struct counters_block, steps)}, TYN_COUNTER_NON_FINITE,
               {"cut", offsetof(struct counters_block, cut)}),
    .settles = offsetof(tyn_photon_trace_params, settles),
};
