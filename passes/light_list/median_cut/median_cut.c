// median_cut.c -- an environment as a constellation of distant lights of equal power.
#include "median_cut.h"
#include "passes/median_cut_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_median_cut_params *p = params;
    if (p->map && !tyn_build_has(b, MEDIAN_CUT_PORT_SUMS)) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "median_cut: 'sums' must be connected where there is a map");
    }
    tyn_build_buffer(b, MEDIAN_CUT_PORT_CONSTELLATION, sizeof(struct constellation_block));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_median_cut_params *p = params;
    const struct median_cut_args args = {.lights = p->lights, .map = p->map};
    TYN_DISPATCH(r, .kernel = KERNEL_REGIONS, .cells = {64, 1, 1}, .args = &args);
}

static const tyn_counter counters[] = {
    {"lights", offsetof(struct constellation_block, count)},
    {NULL},
};

const tyn_pass_desc tyn_pass_median_cut = {
    .name = "median_cut",
    .summary = "an environment as a constellation of distant lights of equal power",
    .serves = "an environment",
    .debug_port = MEDIAN_CUT_PORT_CONSTELLATION,
    .debug_meaning = "struct constellation_block: regions and lights",
    TYN_PASS_TABLES(tyn_median_cut_params),
    .counters = counters,
    .counter_port = MEDIAN_CUT_PORT_CONSTELLATION,
};
