// lpv_reflect.c -- texels of reflective shadow maps into the cells before them.
#include "lpv_reflect.h"
#include "lpv_reflect_args.h"
#include "shaders/common/counters.h"
#include "shaders/light/shadow_args.h"
#include "passes/lpv_reflect_tables.h"

static tyn_extent blocks_of(tyn_extent atlas)
{
    return (tyn_extent){(atlas.x + LPV_REFLECT_BLOCK - 1) / LPV_REFLECT_BLOCK,
                        (atlas.y + LPV_REFLECT_BLOCK - 1) / LPV_REFLECT_BLOCK, 1};
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_lpv_reflect_params *p = params;
    const tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    const tyn_extent blocks = blocks_of(tyn_build_extent(b, LPV_REFLECT_PORT_RSM_FLUX));
    tyn_build_buffer(b, LPV_REFLECT_PORT_REFLECTED,
                     16 + 16ull * dims.x * dims.y * dims.z * p->shape.channels);
    tyn_build_buffer(b, LPV_REFLECT_PORT_PARTIALS, sizeof(float) * blocks.x * blocks.y);
    tyn_build_buffer(b, LPV_REFLECT_PORT_TILES,
                     sizeof(struct rsm_tile) * (p->num_tiles ? p->num_tiles : 1));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_lpv_reflect_params *p = params;
    const tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    const tyn_extent atlas = tyn_rec_extent(r, LPV_REFLECT_PORT_RSM_FLUX);
    const tyn_extent blocks = blocks_of(atlas);
    struct lpv_reflect_args args = {
        .dims = {dims.x, dims.y, dims.z},
        .channels = p->shape.channels,
        .tint = {p->shape.tint[0], p->shape.tint[1], p->shape.tint[2]},
        .num_blocks = blocks.x * blocks.y,
    };
    tyn_rec_fill(r, LPV_REFLECT_PORT_REFLECTED, 0);
    if (p->num_tiles == 0) {
        return;
    }
    tyn_rec_update(r, LPV_REFLECT_PORT_TILES, 0, p->tiles, sizeof p->tiles[0] * p->num_tiles);
    TYN_DISPATCH(r, .kernel = KERNEL_SUM,
                 .cells = {blocks.x * LPV_REFLECT_SIDE, blocks.y * LPV_REFLECT_SIDE, 1},
                 .args = &args);
    // All maps of one size in one go: those of suns, then those of lamps.
    for (uint32_t end = 0; args.first < p->num_tiles; args.first = end) {
        const uint32_t texels = p->tiles[args.first].texels;
        while (end < p->num_tiles && p->tiles[end].texels == texels) {
            end++;
        }
        TYN_DISPATCH(
            r, .kernel = KERNEL_DEPOSIT, .cells = {texels, texels, end - args.first}, .args = &args,
            .spec = ((const uint32_t[]){p->mode, tyn_rec_has(r, LPV_REFLECT_PORT_WALL_LINKS)}));
        tyn_rec_work(r, "texels", (double)texels * texels * (end - args.first));
    }
}

const tyn_pass_desc tyn_pass_lpv_reflect = {
    .name = "lpv_reflect",
    .summary = "light that surfaces reflect first, into the cells of a light propagation volume",
    .serves = "surfaces that suns or lamps shine on, in media",
    TYN_PASS_TABLES(tyn_lpv_reflect_params),
    .debug_port = LPV_REFLECT_PORT_REFLECTED,
    .debug_meaning = "power that starts in cells, in units of a bound of the sum",
    TYN_COUNTS(LPV_REFLECT_PORT_COUNTERS, struct counters_block, TYN_COUNTER_NON_FINITE),
};
