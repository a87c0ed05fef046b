// sky_light.c -- see sky_light.h.
#include "sky_light.h"
#include "sky_light_args.h"
#include "passes/sky_light_tables.h"
#include <stddef.h>

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_buffer(b, SKY_LIGHT_PORT_LIT, sizeof(struct ordinates_block));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_sky_light_params *p = params;
    const struct sky_light_args args = {.num_fixed = p->num_fixed, .split = p->split};
    if (p->num_fixed) {
        tyn_rec_update(r, SKY_LIGHT_PORT_LIT, offsetof(struct ordinates_block, list), p->fixed,
                       p->num_fixed * sizeof p->fixed[0]);
    }
    TYN_DISPATCH(r, .cells = {TYN_ORDINATES_MAX, 1, 1}, .args = &args);
}

const tyn_pass_desc tyn_pass_sky_light = {
    .name = "sky_light",
    .summary = "the light of the principal ordinates",
    .serves = "principal ordinates: an environment, or more suns than have beams",
    TYN_PASS_TABLES(tyn_sky_light_params),
    .debug_port = SKY_LIGHT_PORT_LIT,
    .debug_meaning = "struct ordinates_block",
};
