// halve_depth.c -- see halve_depth.h.
#include "halve_depth.h"
#include "passes/halve_depth_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)params;
    const tyn_extent full = tyn_build_extent(b, HALVE_DEPTH_PORT_FULL_DEPTH);
    tyn_build_image(b, HALVE_DEPTH_PORT_HALF_DEPTH, (tyn_extent){full.x / 2, full.y / 2, 1}, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    (void)params;
    TYN_DISPATCH(r, .cells = tyn_rec_extent(r, HALVE_DEPTH_PORT_HALF_DEPTH));
}

const tyn_pass_desc tyn_pass_halve_depth = {
    .name = "halve_depth",
    .summary = "a host's depth for a view of half its size",
    .serves = "a host's picture twice as large as the view, with depth",
    TYN_PASS_TABLES(tyn_halve_depth_params),
    .of_pixels = true,
    .debug_port = HALVE_DEPTH_PORT_HALF_DEPTH,
    .debug_meaning = "depth of each 2 x 2 texels",
};
