// light_cells.c -- which lights see all, or nothing, of a piece of the medium's box.
#include "light_cells.h"
#include "passes/light_cells_tables.h"
#include <math.h>

static const tyn_param params_table[] = {
    {"cells", TYN_PARAM_INT, offsetof(tyn_light_cells_params, cells), 32, 4, 256, "cells",
     "along the longest side of the box", NULL},
};

static struct light_cells_args args_of(const tyn_light_cells_params *p)
{
    struct light_cells_args args;
    const float *extent = p->extent;
    args.edge = fmaxf(fmaxf(extent[0], extent[1]), extent[2]) / (float)p->cells;
    for (int a = 0; a < 3; a++) {
        const float count = fminf(ceilf(extent[a] / args.edge), (float)p->cells);
        args.dims[a] = count >= 1 ? (uint32_t)count : 1;
    }
    return args;
}

// Whole blocks of the largest size cover the atlas.
static tyn_extent blocks_of(tyn_extent atlas)
{
    const uint32_t side = LIGHT_CELLS_BLOCK << (LIGHT_CELLS_LEVELS - 1);
    const uint32_t finest = 1u << (LIGHT_CELLS_LEVELS - 1);
    return (tyn_extent){(atlas.x + side - 1) / side * finest, (atlas.y + side - 1) / side * finest,
                        1};
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const struct light_cells_args args = args_of(params);
    tyn_build_image(b, LIGHT_CELLS_PORT_BLOCKS,
                    blocks_of(tyn_build_extent(b, LIGHT_CELLS_PORT_SHADOW_ATLAS)),
                    LIGHT_CELLS_LEVELS);
    tyn_build_image(b, LIGHT_CELLS_PORT_LIGHT_CELLS,
                    (tyn_extent){args.dims[0], args.dims[1], args.dims[2]}, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_light_cells_params *p = params;
    const struct light_cells_args args = args_of(p);
    const uint32_t most_lamps = TYN_LIGHT_CELLS - TYN_SHADOW_SUNS;
    const uint32_t spec[] = {p->num_suns, p->num_lamps < most_lamps ? p->num_lamps : most_lamps};
    const uint8_t mips[1 + LIGHT_CELLS_LEVELS] = {0, 0, 1, 2, 3};
    TYN_DISPATCH(r, .kernel = KERNEL_BLOCKS, .cells = tyn_rec_extent(r, LIGHT_CELLS_PORT_BLOCKS),
                 .mips = mips);
    TYN_DISPATCH(r, .kernel = KERNEL_SEE, .cells = {args.dims[0], args.dims[1], args.dims[2]},
                 .args = &args, .spec = spec);
    tyn_rec_work(r, "cells", (double)args.dims[0] * args.dims[1] * args.dims[2]);
}

const tyn_pass_desc tyn_pass_light_cells = {
    .name = "light_cells",
    .summary = "where lights see all of the medium, or nothing",
    .serves = "surfaces before the lights of a medium",
    TYN_PASS_TABLES(tyn_light_cells_params),
    TYN_SETTINGS(params_table),
    .debug_port = LIGHT_CELLS_PORT_LIGHT_CELLS,
    .debug_meaning = "two bits a light: 1 dark, 2 lit, 0 neither",
};
