// path_balance.c -- tables and dispatches of the path tracer's energy balance.
#include "shaders/common/balance_result.h"
#include "shaders/common/counters.h"
#include "path_balance.h"
#include "shaders/path/path_args.h"
#include "passes/path_balance_tables.h"
#include <string.h>

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_path_params *p = params;
    tyn_build_buffer(b, PATH_BALANCE_PORT_BALANCE, TYN_BALANCE_BYTES);
    tyn_build_buffer(b, PATH_BALANCE_PORT_RESULT, sizeof(struct path_balance_result));
    tyn_build_buffer(b, PATH_BALANCE_PORT_PARTIALS,
                     (uint64_t)p->threads * sizeof(struct path_balance_partial));
    return TYN_OK;
}

// `groups` samples of each kind of points in one dispatch, after `before` of them.
static void add_dispatch(tyn_recorder *r, const tyn_path_params *p, const uint32_t *spec,
                         uint32_t kinds, uint64_t before, uint32_t groups)
{
    const uint64_t path = before * kinds;
    const uint32_t threads = groups < p->threads ? groups : p->threads;
    struct path_args args =
        path_trace_args(p, (uint32_t)(path / TYN_PATH_BALANCE_BLOCK), 1, threads);
    args.num_samples = groups * kinds;
    args.first_sample = (uint32_t)(path % TYN_PATH_BALANCE_BLOCK);
    TYN_DISPATCH(r, .kernel = KERNEL_PATH_BALANCE, .cells = {threads, 1, 1}, .args = &args,
                 .spec = spec);
    struct path_resolve_args sum = {
        .num = 1,
        .slots = threads,
        .lamps = {p->lamp_power[0], p->lamp_power[1], p->lamp_power[2]},
    };
    const float groups_before = (float)before;
    memcpy(&sum.samples_before, &groups_before, sizeof groups_before);
    TYN_DISPATCH(r, .kernel = KERNEL_SUM, .cells = {TYN_PATH_BALANCE_VALUES, 1, 1}, .args = &sum);
}

// `paths` of each of `num_samples` samples in each of `chunks` dispatches. Paths are numbered sample by sample, so that a record of
// several samples follows those of as many records.
static void record(tyn_recorder *r, const void *params)
{
    const tyn_path_params *p = params;
    uint32_t spec[TYN_PATH_NUM_SPEC];
    path_specialise(spec, p);
    spec[TYN_PATH_SPEC_FLAGS] &= ~TYN_PATH_THIN;
    if (p->triangles && p->num_lights && !p->repeat) {
        spec[TYN_PATH_SPEC_FLAGS] |= TYN_PATH_FROM_LIGHTS;
    }
    // A sample of the balance is one of each kind of points.
    const uint32_t kinds = !p->triangles                                      ? 2
                           : spec[TYN_PATH_SPEC_FLAGS] & TYN_PATH_FROM_LIGHTS ? 4
                                                                              : 3;
    const uint32_t each = p->paths > kinds ? p->paths / kinds : 1; // groups of a sample
    const uint64_t groups = (uint64_t)each * p->num_samples;
    // Numbers of a dispatch's paths begin within a block: they are whole numbers of 32 bits to the last one.
    const uint32_t most = (UINT32_MAX - TYN_PATH_BALANCE_BLOCK) / kinds;
    const uint64_t before = (uint64_t)each * p->first_sample * p->chunks;
    for (uint64_t done = 0, chunk = 0; done < groups * p->chunks;) {
        const uint64_t left = (chunk + 1) * groups - done;
        const uint32_t part = left < most ? (uint32_t)left : most;
        add_dispatch(r, p, spec, kinds, before + done, part);
        done += part;
        chunk += part == left;
    }
    tyn_rec_work(r, "paths", (double)p->chunks * (double)groups * kinds);
}

const tyn_pass_desc tyn_pass_path_balance = {
    .name = "path_balance",
    .summary = "where the energy goes, unbiased",
    TYN_PASS_TABLES(tyn_path_params),
    TYN_SETTINGS(path_params_table),
    .debug_port = PATH_BALANCE_PORT_RESULT,
    .debug_meaning = "power entering, emitted, absorbed, escaped",
    TYN_COUNTS(PATH_BALANCE_PORT_COUNTERS, struct counters_block, TYN_COUNTERS),
};
