// validity_mask.c -- which pixels show any medium, and where on their rays it begins, seen from behind.
#include "validity_mask.h"
#include "shaders/common/scene_args.h"
#include "passes/validity_mask_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_validity_mask_params *p = params;
    tyn_build_image(b, VALIDITY_MASK_PORT_MASK, (tyn_extent){p->width, p->height, 1}, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_validity_mask_params *p = params;
    const struct validity_mask_args args = {.slices = p->slices};
    const uint32_t spec[] = {p->distance, tyn_rec_has(r, VALIDITY_MASK_PORT_EMISSION)};
    TYN_DISPATCH(r, .kernel = p->mode == TYN_MEDIUM_DENSITY ? KERNEL_DENSITY : KERNEL_COEFFICIENTS,
                 .cells = {p->width, p->height, 1}, .args = &args, .spec = spec);
}

const tyn_pass_desc tyn_pass_validity_mask = {
    .name = "validity_mask",
    .summary = "which pixels show any medium, and where on their rays it begins",
    .serves = "media",
    TYN_PASS_TABLES(tyn_validity_mask_params),
    .of_pixels = true,
    .debug_port = VALIDITY_MASK_PORT_MASK,
    .debug_meaning = "direction of the ray; where it shows no medium, -1 in the fourth channel",
};
