// walls.c -- surfaces on the lattice.
#include "walls.h"
#include "walls_pass_args.h"
#include "shaders/surfaces/surface_args.h"
#include "shaders/walls/walls_args.h"
#include "passes/walls_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_walls_params *p = params;
    uint64_t n = (uint64_t)p->dims[0] * p->dims[1] * p->dims[2];
    uint32_t triangles =
        tyn_build_extent(b, WALLS_PORT_TRIANGLES).x / (uint32_t)sizeof(struct surface_triangle);
    if (triangles > TYN_WALLS_MAX_TRIANGLES) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "pass 'walls': %u triangles; at most %d can be told apart", triangles,
                         TYN_WALLS_MAX_TRIANGLES);
    }
    tyn_build_buffer(b, WALLS_PORT_WALL_LINKS, 4 * n);
    tyn_build_buffer(b, WALLS_PORT_WALL_CELLS, sizeof(struct wall_cell) * n);
    tyn_build_buffer(b, WALLS_PORT_HITS, 14 * 4 * n);
    tyn_build_buffer(b, WALLS_PORT_NEAREST, WALLS_SLOTS * 4 * n);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_walls_params *p = params;
    struct walls_pass_args args = {
        .extent = {p->extent[0], p->extent[1], p->extent[2]},
        .dims = {p->dims[0], p->dims[1], p->dims[2]},
        .num_triangles =
            tyn_rec_extent(r, WALLS_PORT_TRIANGLES).x / (uint32_t)sizeof(struct surface_triangle),
    };
    args.row = args.num_triangles < WALLS_ROW ? args.num_triangles : WALLS_ROW;
    args.slices = args.num_triangles < WALLS_FEW ? WALLS_SLICES : 1;
    tyn_rec_fill(r, WALLS_PORT_WALL_LINKS, 0);
    tyn_rec_fill(r, WALLS_PORT_HITS, 0xffffffffu);
    tyn_rec_fill(r, WALLS_PORT_NEAREST, 0xffffffffu);
    if (args.row > 0) {
        TYN_DISPATCH(r, .kernel = KERNEL_SCATTER,
                     .cells = {args.row * WALLS_GROUP,
                               (args.num_triangles + args.row - 1) / args.row, args.slices},
                     .args = &args);
    }
    TYN_DISPATCH(r, .kernel = KERNEL_CELLS, .cells = {p->dims[0], p->dims[1], p->dims[2]},
                 .args = &args);
    tyn_rec_work(r, "triangles", args.num_triangles);
    tyn_rec_work(r, "cells", (double)p->dims[0] * p->dims[1] * p->dims[2]);
}

const tyn_pass_desc tyn_pass_walls = {
    .name = "walls",
    .summary = "links between cells of the lattice that surfaces cut, and what they meet",
    .serves = "surfaces in media",
    TYN_PASS_TABLES(tyn_walls_params),
    .debug_port = WALLS_PORT_WALL_CELLS,
    .debug_meaning = "albedo and planes of the walls per cell",
};
