// path_probe.c -- tables and dispatches of the path tracer: the light field at points.
#include "path_probe.h"
#include "shaders/common/counters.h"
#include "passes/path_probe_tables.h"

enum { PROBE_STATE_BYTES = 3 * TYN_PATH_PROBE_VALUES * 4 };

uint64_t tyn_path_probe_state_size(uint32_t num_points)
{
    return (uint64_t)num_points * PROBE_STATE_BYTES;
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    uint32_t points = tyn_build_extent(b, PATH_PROBE_PORT_STATE).x / PROBE_STATE_BYTES;
    path_split s = path_split_work(params, points);
    tyn_build_buffer(b, PATH_PROBE_PORT_RESULTS,
                     (uint64_t)points * sizeof(struct path_probe_result));
    tyn_build_buffer(b, PATH_PROBE_PORT_PARTIALS,
                     (uint64_t)s.tile * s.slots * sizeof(struct path_probe_partial));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_path_params *p = params;
    uint32_t points = tyn_rec_extent(r, PATH_PROBE_PORT_STATE).x / PROBE_STATE_BYTES;
    uint32_t spec[TYN_PATH_NUM_SPEC];
    path_split s = path_split_work(p, points);
    path_specialise(spec, p);
    for (uint32_t first = 0; first < points; first += s.tile) {
        uint32_t num = points - first < s.tile ? points - first : s.tile;
        const struct path_args args = path_trace_args(p, first, num, s.slots);
        TYN_DISPATCH(r, .kernel = KERNEL_PATH_PROBE, .cells = {num * s.slots, 1, 1}, .args = &args,
                     .spec = spec);
        struct path_resolve_args resolve = {
            .first = first, .num = num, .slots = s.slots, .samples_before = p->first_sample};
        TYN_DISPATCH(r, .kernel = KERNEL_RESOLVE, .cells = {num * TYN_PATH_PROBE_VALUES, 1, 1},
                     .args = &resolve);
    }
    tyn_rec_work(r, "paths", (double)points * p->num_samples);
}

const tyn_pass_desc tyn_pass_path_probe = {
    .name = "path_probe",
    .summary = "unbiased fluence and net flux at points, progressive",
    TYN_PASS_TABLES(tyn_path_params),
    TYN_SETTINGS(path_split_params_table),
    .debug_port = PATH_PROBE_PORT_RESULTS,
    .debug_meaning = "fluence and net flux",
    TYN_COUNTS(PATH_PROBE_PORT_COUNTERS, struct counters_block, TYN_COUNTERS),
};
