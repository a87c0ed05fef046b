// refine_field.c -- see refine_field.h.
#include "refine_field.h"
#include "refine_field_args.h"
#include "passes/refine_field_tables.h"
#include <string.h>

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_refine_field_params *p = params;
    const tyn_extent size = {p->size[0], p->size[1], p->size[2]};
    for (uint8_t port = REFINE_FIELD_PORT_RED; port <= REFINE_FIELD_PORT_BLUE; port++) {
        tyn_build_image(b, port, size, 1);
    }
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_refine_field_params *p = params;
    struct refine_field_args args;
    memcpy(args.size, p->size, sizeof args.size);
    memcpy(args.world, p->world, sizeof args.world);
    TYN_DISPATCH(r, .kernel = KERNEL_IMAGES, .cells = {p->size[0], p->size[1], p->size[2]},
                 .args = &args);
}

const tyn_pass_desc tyn_pass_refine_field = {
    .name = "refine_field",
    .summary = "the field in which paths end",
    .serves = "paths that end in pop's field (refine.depth)",
    TYN_PASS_TABLES(tyn_refine_field_params),
    .debug_port = REFINE_FIELD_PORT_GREEN,
    .debug_meaning = "fluence of scattered green light, W/m^2",
};
