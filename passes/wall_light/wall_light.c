// wall_light.c -- light of suns and virtual point lights on the walls of the lattice.
#include "wall_light.h"
#include "wall_light_args.h"
#include "shaders/beams/radial_args.h"
#include "passes/wall_light_tables.h"
_Static_assert(WALL_LIGHT_VPLS == TYN_RADIAL_VPLS_MAX, "of a workgroup each");

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_wall_light_params *p = params;
    const bool sky = tyn_build_has(b, WALL_LIGHT_PORT_SKY_SEEN);
    if (p->num_suns == 0 && !sky && !tyn_build_has(b, WALL_LIGHT_PORT_RADIALS)) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "pass 'wall_light': no suns, no 'sky_seen', no 'radials': nothing shines");
    }
    if (p->num_suns > 0 && sky) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "pass 'wall_light': suns and 'sky_seen': it takes one of them");
    }
    const uint64_t cells = (uint64_t)p->dims[0] * p->dims[1] * p->dims[2];
    tyn_build_buffer(b, WALL_LIGHT_PORT_WALL_LIGHT, 12 * cells);
    const bool listed = tyn_build_has(b, WALL_LIGHT_PORT_RADIALS);
    tyn_build_buffer(b, WALL_LIGHT_PORT_LIST,
                     sizeof(struct wall_light_list) + (listed ? 8 * cells : 0));
    tyn_build_buffer(b, WALL_LIGHT_PORT_ARRIVED, 12 * (listed ? cells : 1));
    tyn_build_buffer(b, WALL_LIGHT_PORT_FIRST, 4 * (listed ? 1 + cells : 1));
    tyn_build_buffer(b, WALL_LIGHT_PORT_PARTS,
                     12 * (listed ? WALL_LIGHT_VPLS * WALL_LIGHT_PARTS : 1));
    return TYN_OK;
}

// Parts of the lattice that are summed by workgroups of their own.
static uint32_t num_parts(const tyn_wall_light_params *p)
{
    const uint32_t cells = p->dims[0] * p->dims[1] * p->dims[2];
    const uint32_t parts = (cells + WALL_LIGHT_PART - 1) / WALL_LIGHT_PART;
    return parts < WALL_LIGHT_PARTS ? parts : WALL_LIGHT_PARTS;
}

static void record_vpls(tyn_recorder *r, const tyn_wall_light_params *p,
                        const struct wall_light_args *args)
{
    // Without maps (vpl.visibility=0) nothing tells what should arrive.
    const uint32_t scaled = tyn_rec_extent(r, WALL_LIGHT_PORT_VPL_DISTANCES).x > 1;
    const uint32_t added = p->num_suns > 0 || tyn_rec_has(r, WALL_LIGHT_PORT_SKY_SEEN);
    const uint32_t rooms = tyn_rec_has(r, WALL_LIGHT_PORT_ROOMS);
    const uint32_t of_vpls[2] = {p->mode, rooms}, of_cells[3] = {added, scaled, rooms};
    const tyn_extent all = {p->dims[0] * p->dims[1] * p->dims[2], 1, 1};
    const tyn_extent vpls = {WALL_LIGHT_VPLS * WALL_LIGHT_GROUP, 1, 1};
    tyn_rec_fill(r, WALL_LIGHT_PORT_LIST, 0);
    tyn_rec_fill(r, WALL_LIGHT_PORT_FIRST, WALL_LIGHT_DARK);
    TYN_DISPATCH(r, .kernel = KERNEL_EXPECTED, .cells = vpls, .args = args, .spec = of_vpls);
    TYN_DISPATCH(r, .kernel = KERNEL_CELLS, .cells = all, .args = args, .spec = of_cells);
    tyn_rec_dispatch_indirect(r,
                              &(tyn_dispatch){.kernel = KERNEL_VPLS, .args = args, .spec = of_vpls},
                              WALL_LIGHT_PORT_LIST, 0);
    if (scaled) {
        const tyn_extent parts = {args->num_parts * WALL_LIGHT_SUM_GROUP, 1, 1};
        const tyn_extent one = {WALL_LIGHT_VPLS, 1, 1};
        tyn_rec_fill(r, WALL_LIGHT_PORT_PARTS, 0);
        TYN_DISPATCH(r, .kernel = KERNEL_SUM, .cells = parts, .args = args, .spec = &rooms);
        TYN_DISPATCH(r, .kernel = KERNEL_SCALE, .cells = one, .args = args);
    }
    tyn_rec_dispatch_indirect(
        r, &(tyn_dispatch){.kernel = KERNEL_REFLECT, .args = args, .spec = of_cells},
        WALL_LIGHT_PORT_LIST, 0);
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_wall_light_params *p = params;
    struct wall_light_args args = {
        .extent = {p->extent[0], p->extent[1], p->extent[2]},
        .dims = {p->dims[0], p->dims[1], p->dims[2]},
        .num_suns = p->num_suns,
        .num_parts = num_parts(p),
    };
    const tyn_extent cells = {p->dims[0], p->dims[1], p->dims[2]};
    if (p->num_suns > 0) {
        TYN_DISPATCH(r, .kernel = KERNEL_SUNS, .cells = cells, .args = &args, .spec = &p->mode);
    }
    if (tyn_rec_has(r, WALL_LIGHT_PORT_SKY_SEEN)) {
        const uint32_t of_sky[] = {p->mode, p->sky_whole};
        TYN_DISPATCH(r, .kernel = KERNEL_SKY, .cells = cells, .args = &args, .spec = of_sky);
    }
    if (tyn_rec_has(r, WALL_LIGHT_PORT_RADIALS)) {
        record_vpls(r, p, &args);
    }
    tyn_rec_work(r, "cells", (double)p->dims[0] * p->dims[1] * p->dims[2]);
}

#define COUNTS(field) offsetof(struct wall_light_power, field)

const tyn_pass_desc tyn_pass_wall_light = {
    .name = "wall_light",
    .summary =
        "light of suns, the sky and virtual point lights on the walls of the lattice's cells",
    .serves = "walls in media under an environment, that suns shine on periodically, or virtual "
              "point lights without further reflections",
    TYN_PASS_TABLES(tyn_wall_light_params),
    .debug_port = WALL_LIGHT_PORT_WALL_LIGHT,
    .debug_meaning = "radiance of the walls per cell, W/(m^2 sr)",
    TYN_COUNTS(
        WALL_LIGHT_PORT_POWER, struct wall_light_power, {"rooms", COUNTS(rooms)},
        {"least", COUNTS(least), true}, {"most", COUNTS(most), true},
        {.name = "astray",
         .offset = COUNTS(astray),
         .real = true,
         .unit = "of what virtual lights send to walls",
         .limit = 0.05,
         .warning =
             "accuracy: of the light that virtual lights send to surfaces about %g %% goes to "
             "rooms of too few cells to have lattice walls that it meets (-D lattice.cells)"}),
};
