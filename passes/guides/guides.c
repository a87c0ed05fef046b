// guides.c -- tables and dispatch of the albedo and normal of first surfaces.
#include "guides.h"
#include "passes/guides_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_guides_params *p = params;
    tyn_build_image(b, GUIDES_PORT_ALBEDO, (tyn_extent){p->size[0], p->size[1], 1}, 1);
    tyn_build_image(b, GUIDES_PORT_NORMAL, (tyn_extent){p->size[0], p->size[1], 1}, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_guides_params *p = params;
    const uint32_t spec[1] = {p->textured};
    if (tyn_rec_has(r, GUIDES_PORT_SEEN)) {
        TYN_DISPATCH(r, .cells = {p->size[0], p->size[1], 1}, .spec = spec);
    } else {
        tyn_rec_clear(r, GUIDES_PORT_ALBEDO);
        tyn_rec_clear(r, GUIDES_PORT_NORMAL);
    }
}

const tyn_pass_desc tyn_pass_guides = {
    .name = "guides",
    .summary = "albedo and normal of what the camera sees first",
    .serves = "the layers albedo and normal",
    TYN_PASS_TABLES(tyn_guides_params),
    .of_pixels = true,
    .debug_port = GUIDES_PORT_NORMAL,
    .debug_meaning = "normal of the first surface",
};
