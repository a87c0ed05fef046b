// rooms.c -- which cells of the lattice are joined by open links.
#include "rooms.h"
#include "shaders/walls/rooms.h"
#include "passes/rooms_tables.h"

static uint32_t num_cells(const tyn_rooms_params *p)
{
    return p->dims[0] * p->dims[1] * p->dims[2];
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const uint64_t cells = num_cells(params);
    tyn_build_buffer(b, ROOMS_PORT_ROOMS, 4 * TYN_ROOMS_SIZE(cells));
    tyn_build_buffer(b, ROOMS_PORT_FOREST, 4 * TYN_ROOMS_ELEMENTS(cells));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_rooms_params *p = params;
    const uint32_t cells = num_cells(p);
    const tyn_dispatch find = {
        .kernel = KERNEL_CELLS, .cells = {TYN_ROOMS_ELEMENTS(cells), 1, 1}, .args = p};
    tyn_rec_fill(r, ROOMS_PORT_FOREST, 0);
    TYN_DISPATCH(r, .kernel = KERNEL_LINKS, .cells = {cells, 1, 1}, .args = p);
    tyn_rec_dispatch(r, &find);
    const tyn_extent maps = tyn_rec_extent(r, ROOMS_PORT_VPL_DISTANCES);
    if (maps.x > 1) { // else VPLs see all
        TYN_DISPATCH(r, .kernel = KERNEL_VPLS, .cells = maps, .args = p);
        tyn_rec_dispatch(r, &find);
    }
    tyn_rec_work(r, "cells", cells);
}

const tyn_pass_desc tyn_pass_rooms = {
    .name = "rooms",
    .summary = "which cells of the lattice are joined by open links, and which virtual point "
               "lights shine in them",
    .serves = "surfaces that reflect light in media",
    TYN_PASS_TABLES(tyn_rooms_params),
    .debug_port = ROOMS_PORT_ROOMS,
    .debug_meaning = "rooms of cells and VPLs",
};
