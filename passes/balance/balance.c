// balance.c -- where the energy goes.
#include "balance.h"
#include "balance_args.h"
#include "shaders/beams/radial_args.h"
#include "shaders/common/balance_result.h"
#include "passes/balance_tables.h"
#include <string.h>

// Parts of suns and of the sky, and as many lamps and VPLs as there may be.
static uint32_t num_followed(const tyn_balance_params *p, bool sky)
{
    return p->num_suns * BALANCE_SUN_PARTS + (sky ? BALANCE_SKY_PARTS : 0) + TYN_RADIAL_LAMPS_MAX +
           TYN_RADIAL_VPLS_MAX;
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    tyn_build_buffer(b, BALANCE_PORT_FOUND,
                     num_followed(params, true) * sizeof(struct balance_light));
    tyn_build_buffer(b, BALANCE_PORT_BALANCE, TYN_BALANCE_BYTES);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_balance_params *p = params;
    struct balance_args args = {
        .tint = {p->tint[0], p->tint[1], p->tint[2]},
        .channels = p->channels,
        .num_suns = p->num_suns,
        .num_groups = p->num_groups,
        .vpls = p->vpls,
        .num_leaks =
            tyn_rec_extent(r, BALANCE_PORT_LEAKS).x / (uint32_t)sizeof(float) / p->channels,
        .emitters = tyn_rec_has(r, BALANCE_PORT_EMITTERS),
    };
    if (tyn_rec_has(r, BALANCE_PORT_SURFACES)) {
        args.sky = tyn_rec_has(r, BALANCE_PORT_DIRECTIONS);
        args.num_followed = num_followed(p, args.sky);
        struct balance_lights_args lights = {
            .num_suns = p->num_suns,
            .locals = tyn_rec_has(r, BALANCE_PORT_RADIALS),
            .sky_parts = args.sky ? BALANCE_SKY_PARTS : 0,
            .channels = p->channels,
        };
        memcpy(&lights.lo, p->box[0], sizeof lights.lo);
        memcpy(&lights.hi, p->box[1], sizeof lights.hi);
        TYN_DISPATCH(r, .kernel = KERNEL_LIGHTS, .cells = {BALANCE_GROUP * args.num_followed, 1, 1},
                     .args = &lights, .spec = &p->mode);
    }
    const uint32_t walls = tyn_rec_has(r, BALANCE_PORT_WALL_POWER);
    TYN_DISPATCH(r, .cells = {BALANCE_GROUP * p->channels, 1, 1}, .args = &args, .spec = &walls);
}

const tyn_pass_desc tyn_pass_balance = {
    .name = "balance",
    .summary = "power that enters, is emitted, is absorbed and escapes",
    .serves = "a balance",
    TYN_PASS_TABLES(tyn_balance_params),
    .debug_port = BALANCE_PORT_BALANCE,
    .debug_meaning = "tyn_balance, W",
};
