// light_list.c -- tables of the list of lights.
#include "light_list.h"
#include "passes/light_list_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_buffer(b, LIGHT_LIST_PORT_LIGHT_LIST, sizeof(struct light_list_block));
    const bool shaded = tyn_build_has(b, LIGHT_LIST_PORT_DIRECTIONS);
    tyn_build_buffer(b, LIGHT_LIST_PORT_LIGHT_SHADES,
                     shaded ? sizeof(struct light_shades_block) : 16);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_light_list_params *p = params;
    TYN_DISPATCH(r, .kernel = KERNEL_LIGHT_LIST, .cells = {64, 1, 1}, .args = &p->listed);
    if (tyn_rec_has(r, LIGHT_LIST_PORT_DIRECTIONS)) {
        TYN_DISPATCH(r, .kernel = KERNEL_SHADES, .cells = {TYN_ORDINATES_MAX, 1, 1},
                     .args = &p->listed);
    }
}

const tyn_pass_desc tyn_pass_light_list = {
    .name = "light_list",
    .summary = "all lights as they shine on the medium, those in an environment's place among them",
    TYN_PASS_TABLES(tyn_light_list_params),
    .debug_port = LIGHT_LIST_PORT_LIGHT_LIST,
    .debug_meaning = "number, mean and fields of the lights",
};
