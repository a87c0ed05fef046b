// wall_light.c -- light of suns on the walls of a periodic lattice.
#include "wall_light.h"
#include "wall_light_args.h"
#include "passes/wall_light_tables.h"
#include <string.h>

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_wall_light_params *p = params;
    const uint64_t cells = (uint64_t)p->dims[0] * p->dims[1] * p->dims[2];
    tyn_build_buffer(b, WALL_LIGHT_PORT_WALL_LIGHT, 12 * cells);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_wall_light_params *p = params;
    struct wall_light_args args = {.num_suns = p->num_suns};
    memcpy(&args.extent, p->extent, sizeof args.extent);
    memcpy(&args.dims, p->dims, sizeof args.dims);
    const tyn_extent cells = {p->dims[0], p->dims[1], p->dims[2]};
    TYN_DISPATCH(r, .cells = cells, .args = &args, .spec = &p->mode);
    tyn_rec_work(r, "cells", (double)p->dims[0] * p->dims[1] * p->dims[2]);
}

const tyn_pass_desc tyn_pass_wall_light = {
    .name = "wall_light",
    .summary = "light of suns on the walls of a periodic lattice's cells",
    .serves = "walls in periodic media that suns shine on",
    TYN_PASS_TABLES(tyn_wall_light_params),
    .debug_port = WALL_LIGHT_PORT_WALL_LIGHT,
    .debug_meaning = "radiance of the walls per cell, W/(m^2 sr)",
};
