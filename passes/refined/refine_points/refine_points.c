// refine_points.c -- see refine_points.h.
#include "refine_points.h"
#include "passes/refine_points_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_refine_points_params *p = params;
    tyn_build_buffer(b, REFINE_POINTS_PORT_POINTS,
                     sizeof(float[3]) * (uint64_t)p->size[0] * p->size[1] * p->size[2]);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_refine_points_params *p = params;
    TYN_DISPATCH(r, .kernel = KERNEL_GRID, .cells = {p->size[0], p->size[1], p->size[2]},
                 .args = p);
}

const tyn_pass_desc tyn_pass_refine_points = {
    .name = "refine_points",
    .summary = "places of the field in which paths end",
    .serves = "paths that end in pop's field (refine.depth)",
    TYN_PASS_TABLES(tyn_refine_points_params),
    .debug_port = REFINE_POINTS_PORT_POINTS,
    .debug_meaning = "positions in M, m",
};
