// sky_seen.c -- the maps of every direction looked up from every cell of the lattice.
#include "sky_seen.h"
#include "passes/sky_seen_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_sky_seen_params *p = params;
    const uint64_t row = (p->dims[0] + 1) / 2, words = row * p->dims[1] * p->dims[2];
    tyn_build_buffer(b, SKY_SEEN_PORT_SKY_SEEN, 4 * words * (1 + p->count));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_sky_seen_params *p = params;
    const uint32_t walls = tyn_rec_has(r, SKY_SEEN_PORT_WALL_LINKS);
    TYN_DISPATCH(r, .cells = {(p->dims[0] + 1) / 2, p->dims[1], p->dims[2]}, .args = p,
                 .spec = &walls);
    const double cells = (double)p->dims[0] * p->dims[1] * p->dims[2];
    tyn_rec_work(r, "cells", cells * p->count);
    tyn_rec_work(r, "fetches", cells * p->count * p->fan);
}

const tyn_pass_desc tyn_pass_sky_seen = {
    .name = "sky_seen",
    .summary = "what surfaces leave of the principal ordinates in the lattice's cells",
    .serves = "surfaces around a medium under an environment",
    TYN_PASS_TABLES(tyn_sky_seen_params),
    .debug_port = SKY_SEEN_PORT_SKY_SEEN,
    .debug_meaning = "shares of the ordinates that each cell sees, two 16-bit numbers a word",
};
