// env_importance.c -- an environment map without its suns, as a pyramid by solid angle.
#include "env_importance.h"
#include "passes/env_importance_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_image(b, ENV_IMPORTANCE_PORT_SKY, (tyn_extent){SKY_WIDTH, SKY_HEIGHT, 1}, SKY_MIPS);
    tyn_build_buffer(b, ENV_IMPORTANCE_PORT_SUMS,
                     sizeof(struct sky_sum) * (SKY_SUMS_WIDTH + 1) * (SKY_SUMS_HEIGHT + 1));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_env_importance_params *p = params;
    TYN_DISPATCH(r, .kernel = KERNEL_BASE, .cells = {SKY_WIDTH, SKY_HEIGHT, 1}, .args = &p->suns);
    // Three levels at once.
    for (uint8_t mip = 0; mip + 3 < SKY_MIPS; mip += 3) {
        const uint8_t mips[] = {mip, (uint8_t)(mip + 1), (uint8_t)(mip + 2), (uint8_t)(mip + 3)};
        TYN_DISPATCH(r, .kernel = KERNEL_MIPS,
                     .cells = {SKY_WIDTH >> (mip + 1), SKY_HEIGHT >> (mip + 1), 1}, .mips = mips);
    }
    TYN_DISPATCH(r, .kernel = KERNEL_ROWS, .cells = {SKY_SUMS_WIDTH, SKY_SUMS_HEIGHT, 1});
    TYN_DISPATCH(r, .kernel = KERNEL_COLUMNS, .cells = {8 * (SKY_SUMS_WIDTH + 1), 1, 1});
    tyn_extent map = tyn_rec_extent(r, ENV_IMPORTANCE_PORT_ENV_MAP);
    tyn_rec_work(r, "fetches", (double)map.x * map.y);
}

const tyn_pass_desc tyn_pass_env_importance = {
    .name = "env_importance",
    .summary = "the environment map without its suns, by solid angle",
    .serves = "principal ordinates: an environment map, and no walls in the medium",
    TYN_PASS_TABLES(tyn_env_importance_params),
    .debug_port = ENV_IMPORTANCE_PORT_SKY,
    .debug_meaning = "mean radiance of the map without its suns",
};
