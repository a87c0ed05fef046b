// path_fluxes.c -- tables and dispatches of the path tracer's fluxes: paths from the suns and the surroundings.
#include "shaders/common/counters.h"
#include "path_fluxes.h"
#include "shaders/path/path_args.h"
#include "passes/path_fluxes_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_path_params *p = params;
    tyn_build_buffer(b, PATH_FLUXES_PORT_FLUXES, sizeof(struct path_fluxes_result));
    tyn_build_buffer(b, PATH_FLUXES_PORT_PARTIALS,
                     (uint64_t)p->threads * TYN_PATH_FLUX_VALUES * sizeof(float));
    return TYN_OK;
}

// `num_samples` paths of each thread in each of `chunks` dispatches.
static void record(tyn_recorder *r, const void *params)
{
    const tyn_path_params *p = params;
    uint32_t spec[TYN_PATH_NUM_SPEC];
    path_specialise(spec, p);
    spec[TYN_PATH_SPEC_FLAGS] &= ~(TYN_PATH_THIN | TYN_PATH_EQUIANGULAR | TYN_PATH_GUIDED);
    for (uint32_t chunk = 0; chunk < p->chunks; chunk++) {
        struct path_args args = path_trace_args(p, 0, 1, p->threads);
        args.first_sample = p->first_sample + chunk * p->num_samples;
        TYN_DISPATCH(r, .kernel = KERNEL_PATH_FLUXES, .cells = {p->threads, 1, 1}, .args = &args,
                     .spec = spec);
        struct path_fluxes_sum_args sum = {
            .threads = p->threads, .paths = args.num_samples, .paths_before = args.first_sample};
        TYN_DISPATCH(r, .kernel = KERNEL_SUM,
                     .cells = {TYN_PATH_FLUX_VALUES * TYN_PATH_FLUX_LANES, 1, 1}, .args = &sum);
    }
    tyn_rec_work(r, "paths", (double)p->threads * p->chunks * p->num_samples);
}

const tyn_pass_desc tyn_pass_path_fluxes = {
    .name = "path_fluxes",
    .summary = "where light of suns and surroundings goes, unbiased",
    TYN_PASS_TABLES(tyn_path_params),
    TYN_SETTINGS(path_params_table),
    .debug_port = PATH_FLUXES_PORT_FLUXES,
    .debug_meaning = "incident, leaving and absorbed power",
    TYN_COUNTS(PATH_FLUXES_PORT_COUNTERS, struct counters_block, TYN_COUNTERS),
};
