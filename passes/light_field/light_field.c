// light_field.c -- see light_field.h.
#include "light_field.h"
#include "passes/light_field_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_light_field_params *p = params;
    for (uint8_t port = LIGHT_FIELD_PORT_RED; p->half && port <= LIGHT_FIELD_PORT_BLUE; port++) {
        tyn_build_format(b, port, VK_FORMAT_R16G16B16A16_SFLOAT);
    }
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_light_field_params *p = params;
    TYN_DISPATCH(r, .kernel = p->half ? KERNEL_HALF : KERNEL_FLOAT,
                 .cells = tyn_rec_extent(r, LIGHT_FIELD_PORT_RED), .args = &p->args);
}

const tyn_pass_desc tyn_pass_light_field = {
    .name = "light_field",
    .summary = "fluence and net flux over the media's box, as images",
    .serves = "a host's images of the light field, and paths that end in it",
    TYN_PASS_TABLES(tyn_light_field_params),
    .debug_port = LIGHT_FIELD_PORT_RED,
    .debug_meaning = "fluence of red light, W/m^2, middle slice of the media's box",
};
