// walls_beyond.c -- see walls_beyond.h.
#include "walls_beyond.h"
#include "passes/walls_beyond_tables.h"
#include "walls_beyond_args.h"
#include "shaders/walls/walls_args.h"
#include <stddef.h>

static const tyn_param params_table[] = {
    {"reach", TYN_PARAM_FLOAT, offsetof(tyn_walls_beyond_params, reach), 0.15, 0, 1, "",
     "surfaces that stand so many times the longest side of the media's box beyond it reflect what "
     "the media send out back into them; 0: none do",
     NULL},
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_walls_beyond_params *p = params;
    const uint64_t n = (uint64_t)p->dims[0] * p->dims[1] * p->dims[2];
    tyn_build_buffer(b, WALLS_BEYOND_PORT_WALL_LINKS, 4 * n);
    tyn_build_buffer(b, WALLS_BEYOND_PORT_WALL_CELLS, sizeof(struct wall_cell) * n);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_walls_beyond_params *p = params;
    float longest = 0;
    for (int a = 0; a < 3; a++) {
        longest = p->extent[a] > longest ? p->extent[a] : longest;
    }
    const struct walls_beyond_args args = {
        .extent = {p->extent[0], p->extent[1], p->extent[2]},
        .reach = p->reach * longest,
        .dims = {p->dims[0], p->dims[1], p->dims[2]},
        .shining = p->shining,
    };
    const uint32_t inner = tyn_rec_has(r, WALLS_BEYOND_PORT_INNER_LINKS);
    TYN_DISPATCH(r, .cells = {p->dims[0], p->dims[1], p->dims[2]}, .args = &args, .spec = &inner);
    tyn_rec_work(r, "cells", (double)p->dims[0] * p->dims[1] * p->dims[2]);
}

const tyn_pass_desc tyn_pass_walls_beyond = {
    .name = "walls_beyond",
    .summary = "surfaces around the lattice, as walls of its outermost cells",
    .serves = "surfaces that stand close to media, but outside",
    TYN_PASS_TABLES(tyn_walls_beyond_params),
    TYN_SETTINGS(params_table),
    .debug_port = WALLS_BEYOND_PORT_WALL_CELLS,
    .debug_meaning = "albedo of the walls per cell",
};
