// composite.c -- lays the medium over the host's picture: color = color x transmittance + radiance.
#include "composite.h"
#include "composite_args.h"
#include "passes/composite_tables.h"
#include <string.h>

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_composite_params *p = params;
    tyn_extent radiance = tyn_build_extent(b, COMPOSITE_PORT_RADIANCE);
    tyn_extent color = tyn_build_extent(b, COMPOSITE_PORT_COLOR);
    const uint32_t times = p->joint ? 2 : 1;
    if (times * radiance.x != color.x || times * radiance.y != color.y) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "composite: the host's colour image is %ux%u, the view %ux%u: make it %u "
                         "times the view",
                         color.x, color.y, radiance.x, radiance.y, times);
    }
    if (p->half_color) {
        tyn_build_format(b, COMPOSITE_PORT_COLOR, VK_FORMAT_R16G16B16A16_SFLOAT);
    }
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_composite_params *p = params;
    const tyn_extent size = tyn_rec_extent(r, COMPOSITE_PORT_COLOR);
    if (!p->joint) {
        TYN_DISPATCH(r, .kernel = p->half_color ? KERNEL_HALF : KERNEL_FLOAT, .cells = size);
        return;
    }
    struct composite_args args = {.depth = {0}};
    if (tyn_rec_has(r, COMPOSITE_PORT_FULL_DEPTH)) {
        memcpy(args.depth, p->depth, sizeof args.depth);
    }
    TYN_DISPATCH(r, .kernel = p->half_color ? KERNEL_JOINT_HALF : KERNEL_JOINT_FLOAT, .cells = size,
                 .args = &args);
}

const tyn_pass_desc tyn_pass_composite = {
    .name = "composite",
    .summary = "lays the medium over the host's picture",
    .serves = "a host's picture",
    TYN_PASS_TABLES(tyn_composite_params),
    .of_pixels = true,
    .debug_port = COMPOSITE_PORT_COLOR,
    .debug_meaning = "the composited picture",
};
