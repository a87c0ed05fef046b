// ordinates.c -- principal ordinates: the directions from which the surroundings light the medium.
#include "ordinates.h"
#include "ordinates_args.h"
#include "shaders/light/sky_args.h"
#include "passes/ordinates_tables.h"
#include <stddef.h>
#include <string.h>

static const tyn_param params_table[] = {
    {"count", TYN_PARAM_INT, offsetof(tyn_ordinates_params, count), 64, 1, TYN_ORDINATES_MAX, "",
     "principal ordinates of the environment"},
    {"split", TYN_PARAM_BOOL, offsetof(tyn_ordinates_params, split), 1, 0, 1, "",
     "light the lattice with the sky's mean and the ordinates with the rest"},
    {"spread", TYN_PARAM_FLOAT, offsetof(tyn_ordinates_params, spread), 2, 0.05, 100, "",
     "how evenly ordinates are placed: uniform weight, in means of the sky; a quarter if not "
     "split"},
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_buffer(b, ORDINATES_PORT_ORDINATES, sizeof(struct ordinates_block));
    tyn_build_buffer(b, ORDINATES_PORT_REGIONS, 4 * sizeof(float) * TYN_ORDINATES_MAX);
    if (tyn_build_has(b, ORDINATES_PORT_IMPORTANCE)) {
        tyn_build_buffer(b, ORDINATES_PORT_WEIGHTS,
                         sizeof(float) * (SKY_SUMS_WIDTH + 1) * (SKY_SUMS_HEIGHT + 1));
    }
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_ordinates_params *p = params;
    const uint32_t room = TYN_ORDINATES_MAX - p->num_fixed;
    const uint32_t fan = p->fan > 1 ? p->fan : 1, regions = (uint32_t)p->count * fan;
    struct ordinates_args args = {
        .mapped = tyn_rec_has(r, ORDINATES_PORT_SUMS),
        .regions = regions < room ? regions : room,
        .fan = fan,
        .num_fixed = p->num_fixed,
        .split = p->split,
        .weighted = tyn_rec_has(r, ORDINATES_PORT_IMPORTANCE),
        .spread = p->split ? p->spread : ORDINATES_SPREAD_OF_ALL * p->spread,
    };
    memcpy(args.rows, p->rows, sizeof args.rows);
    struct ordinates_block block = {.count = p->num_fixed + args.regions,
                                    .num_fixed = p->num_fixed};
    memcpy(block.list, p->fixed, p->num_fixed * sizeof block.list[0]);
    tyn_rec_update(r, ORDINATES_PORT_ORDINATES, 0, &block, sizeof block);
    if (args.weighted) {
        TYN_DISPATCH(r, .kernel = KERNEL_ROWS, .cells = {SKY_SUMS_WIDTH, SKY_SUMS_HEIGHT, 1},
                     .args = &args);
        TYN_DISPATCH(r, .kernel = KERNEL_COLUMNS, .cells = {SKY_SUMS_WIDTH + 1, 1, 1});
    }
    static const uint32_t steps[] = {KERNEL_PARTITION, KERNEL_GATHER};
    for (uint32_t i = 0; i < TYN_COUNT(steps); i++) {
        TYN_DISPATCH(r, .kernel = steps[i], .cells = {TYN_ORDINATES_MAX, 1, 1}, .args = &args);
    }
    tyn_rec_work(r, "regions", args.regions);
}

static const tyn_counter counters[] = {
    {"ordinates", offsetof(struct ordinates_block, count)},
    {NULL},
};

const tyn_pass_desc tyn_pass_ordinates = {
    .name = "ordinates",
    .summary = "directions from which the surroundings light the medium",
    .serves = "principal ordinates: an environment map",
    TYN_PASS_TABLES(tyn_ordinates_params),
    TYN_SETTINGS(params_table),
    .debug_port = ORDINATES_PORT_ORDINATES,
    .debug_meaning = "struct ordinates_block",
    .counters = counters,
    .counter_port = ORDINATES_PORT_ORDINATES,
};
