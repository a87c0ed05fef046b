// probe.c -- the light field at points.
#include "probe.h"
#include "probe_args.h"
#include "passes/probe_tables.h"
#include "shaders/common/counters.h"
#include <string.h>

static uint32_t num_points(tyn_extent bytes)
{
    return bytes.x / (3 * sizeof(float));
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_buffer(b, PROBE_PORT_RESULTS,
                     (uint64_t)num_points(tyn_build_extent(b, PROBE_PORT_POINTS)) *
                         sizeof(struct probe_result));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_probe_params *p = params;
    struct probe_args args = {
        .tint = {p->tint[0], p->tint[1], p->tint[2]},
        .channels = p->channels,
        .num_suns = p->num_suns,
        .num_ordinates = p->num_ordinates,
        .num_points = num_points(tyn_rec_extent(r, PROBE_PORT_POINTS)),
        .scattered_only = p->scattered_only,
        .local_lights = p->local_lights,
        .cells = tyn_rec_has(r, PROBE_PORT_CELLS),
        .parts = p->parts,
    };
    memcpy(args.world, p->world, sizeof args.world);
    const uint32_t spec[5] = {
        p->mode, tyn_rec_has(r, PROBE_PORT_WALL_LINKS), tyn_rec_has(r, PROBE_PORT_SHADOW_ATLAS),
        tyn_rec_has(r, PROBE_PORT_VPL_DISTANCES), tyn_rec_has(r, PROBE_PORT_ROOMS)};
    TYN_DISPATCH(r, .cells = {args.num_points, 1, 1}, .args = &args, .spec = spec);
    tyn_rec_work(r, "points", args.num_points);
}

const tyn_pass_desc tyn_pass_probe = {
    .name = "probe",
    .summary = "fluence and net flux at points",
    .serves = "probes",
    TYN_PASS_TABLES(tyn_probe_params),
    .debug_port = PROBE_PORT_RESULTS,
    .debug_meaning = "fluence and flux per point, W/m^2",
    TYN_COUNTS(PROBE_PORT_COUNTERS, struct counters_block, TYN_COUNTER_NON_FINITE,
               {"clamped", offsetof(struct counters_block, clamped)}),
};
