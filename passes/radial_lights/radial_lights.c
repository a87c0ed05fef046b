// radial_lights.c -- see radial_lights.h.
#include "radial_lights.h"
#include "passes/radial_lights_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_radial_lights_params *p = params;
    const uint32_t lights = p->num_lamps + p->max_vpls;
    if (lights == 0 || p->num_lamps > TYN_RADIAL_LAMPS_MAX || p->max_vpls > TYN_RADIAL_VPLS_MAX) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "radial_lights: %u lamps and %u VPLs, must be 1 to %d and 0 to %d",
                         p->num_lamps, p->max_vpls, TYN_RADIAL_LAMPS_MAX, TYN_RADIAL_VPLS_MAX);
    }
    tyn_build_buffer(b, RADIAL_LIGHTS_PORT_RADIALS,
                     offsetof(struct radial_block, list) + lights * sizeof(struct radial_grid));
    tyn_build_buffer(b, RADIAL_LIGHTS_PORT_COLORS, sizeof p->colors);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_radial_lights_params *p = params;
    tyn_rec_update(r, RADIAL_LIGHTS_PORT_COLORS, 0, p->colors, sizeof p->colors);
    TYN_DISPATCH(r, .cells = {p->num_lamps + p->max_vpls, 1, 1});
}

const tyn_pass_desc tyn_pass_radial_lights = {
    .name = "radial_lights",
    .summary = "local lights as they shine now, beside their grids",
    .serves = "lamps and virtual point lights in media",
    TYN_PASS_TABLES(tyn_radial_lights_params),
    .debug_port = RADIAL_LIGHTS_PORT_RADIALS,
    .debug_meaning = "lamps, VPLs and where their grids are, as words",
};
