// merge_grids.c -- see merge_grids.h.
#include "merge_grids.h"
#include "merge_grids_args.h"
#include "passes/merge_grids_tables.h"
#include "shaders/common/scene_args.h"
#include <math.h>

#define PORT(name) MERGE_GRIDS_PORT_##name

static const tyn_param params[] = {
    {"finer", TYN_PARAM_INT, offsetof(tyn_merge_grids_params, finer), 2, 1, 8, "",
     "cells of the merged grid per cell of the finest aligned one, along an axis"},
};

static tyn_extent dims_of(const tyn_merge_grids_params *p)
{
    float longest = fmaxf(p->extent[0], fmaxf(p->extent[1], p->extent[2]));
    uint32_t finest = p->grid_along > p->grid_cells ? p->grid_along : p->grid_cells;
    finest = p->num_lamps && p->lamp_cells > finest ? p->lamp_cells : finest;
    finest = p->num_vpls && p->vpl_cells > finest ? p->vpl_cells : finest;
    float dx = longest / (float)(finest * (uint32_t)p->finer);
    uint32_t dims[3];
    for (int i = 0; i < 3; i++) {
        dims[i] = (uint32_t)fmaxf(1.0f, ceilf(p->extent[i] / dx - 1e-3f));
    }
    return (tyn_extent){dims[0], dims[1], dims[2]};
}

static tyn_result declare(tyn_builder *b, const void *data)
{
    tyn_build_image(b, PORT(MERGED), dims_of(data), 1);
    return TYN_OK;
}

static struct merge_grids_radial radial(const tyn_recorder *r, uint8_t seen, uint32_t count,
                                        uint32_t cells)
{
    return (struct merge_grids_radial){count, cells,
                                       count ? tyn_rec_extent(r, seen).x / (cells + 2) : 1};
}

static void record(tyn_recorder *r, const void *data)
{
    const tyn_merge_grids_params *p = data;
    tyn_extent dims = dims_of(p);
    struct merge_grids_args args = {
        .dims = {dims.x, dims.y, dims.z},
        .num_grids = p->num_grids,
        .grid_cells = p->grid_cells,
        .channels = p->channels,
        .tiles = p->num_grids ? tyn_rec_extent(r, PORT(SEEN)).x / p->grid_cells : 1,
        .residuum = tyn_rec_has(r, PORT(RESIDUUM)),
        .lamps = radial(r, PORT(LAMP_SEEN), p->num_lamps, p->lamp_cells),
        .vpls = radial(r, PORT(VPL_SEEN), p->num_vpls, p->vpl_cells),
    };
    TYN_DISPATCH(r, .cells = dims, .args = &args, .spec = &p->mode);
    tyn_rec_work(r, "cells",
                 (double)dims.x * dims.y * dims.z * (p->num_grids + p->num_lamps + p->num_vpls));
}

const tyn_pass_desc tyn_pass_merge_grids = {
    .name = "merge_grids",
    .summary = "light to the eye of all aligned grids, summed on the medium's axes",
    TYN_PASS_TABLES(tyn_merge_grids_params),
    TYN_SETTINGS(params),
    .debug_port = PORT(MERGED),
    .debug_meaning = "light towards the eye, middle slice of the medium's box",
};
