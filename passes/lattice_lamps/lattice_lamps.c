// lattice_lamps.c -- unscattered light of lamps and VPLs on the lattice.
#include "lattice_lamps.h"
#include "shaders/beams/radial_args.h"
#include "shaders/lattice/lattice_args.h"
#include "passes/lattice_lamps_tables.h"
#include <math.h>

_Static_assert(TYN_RADIAL_VPLS_MAX <= 32 * LATTICE_VPL_SLICES,
               "lattice_lamps_vpls.comp has a bit for each light of a slice");

static uint32_t num_groups(const tyn_lattice_lamps_params *p)
{
    return p->num_fine + (p->num_lamps > p->num_fine) + p->vpls;
}

// As many as there may be.
static uint32_t num_lights(const tyn_lattice_lamps_params *p)
{
    return p->num_lamps + (p->vpls ? TYN_RADIAL_VPLS_MAX : 0);
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_lattice_lamps_params *p = params;
    tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    uint32_t groups = num_groups(p);
    if (groups < 1 || groups > LATTICE_LAMPS_MAX_GROUPS || p->num_fine > p->num_lamps) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "pass 'lattice_lamps': %u groups of lights; must be 1 to %d", groups,
                         LATTICE_LAMPS_MAX_GROUPS);
    }
    uint32_t layers = dims.z * p->shape.channels;
    tyn_build_image(b, LATTICE_LAMPS_PORT_SOURCE, (tyn_extent){dims.x, dims.y, layers}, 1);
    if (p->vpls) {
        tyn_build_image(b, LATTICE_LAMPS_PORT_VPL_LIGHT, (tyn_extent){dims.x, dims.y, layers}, 1);
    }
    tyn_build_image(b, LATTICE_LAMPS_PORT_LIT, (tyn_extent){dims.x, dims.y, layers * groups}, 1);
    tyn_build_image(b, LATTICE_LAMPS_PORT_UNSHADOWED, (tyn_extent){dims.x, dims.y, layers * groups},
                    1);
    tyn_build_buffer(b, LATTICE_LAMPS_PORT_POWER,
                     sizeof(struct lattice_lamp_power) * groups * p->shape.channels);
    tyn_build_buffer(b, LATTICE_LAMPS_PORT_LOSSES,
                     sizeof(float) * 4 * num_lights(p) * p->shape.channels);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_lattice_lamps_params *p = params;
    tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    tyn_extent texels = tyn_rec_extent(r, LATTICE_LAMPS_PORT_DENSITY);
    const float *extent = p->shape.extent;
    const uint32_t size[3] = {texels.x, texels.y, texels.z};
    float dx = fmaxf(extent[0], fmaxf(extent[1], extent[2])) / (float)p->shape.cells, voxels = 0;
    struct lattice_lamps_args args = {
        .dims = {dims.x, dims.y, dims.z},
        .channels = p->shape.channels,
        .num_fine = p->num_fine,
        .num_lamps = p->num_lamps,
        .num_groups = num_groups(p),
    };
    for (int a = 0; a < 3; a++) {
        args.tint[a] = p->shape.tint[a];
        voxels = fmaxf(voxels, dx * (float)size[a] / extent[a]);
    }
    args.samples = (uint32_t)fminf(fmaxf(ceilf(0.5f * voxels - 1e-3f), 2), 4);
    const uint32_t walls = tyn_rec_has(r, LATTICE_LAMPS_PORT_WALL_LINKS);
    if (args.num_groups > p->vpls) {
        const uint32_t spec[4] = {p->mode, p->shape.channels, walls,
                                  tyn_rec_has(r, LATTICE_LAMPS_PORT_SHADOW_ATLAS)};
        const tyn_extent cells = {dims.x, dims.y, dims.z * (args.num_groups - p->vpls)};
        TYN_DISPATCH(r, .kernel = KERNEL_CELLS, .cells = cells, .args = &args, .spec = spec);
    }
    if (p->vpls) {
        const uint32_t spec[5] = {p->mode, p->shape.channels,
                                  tyn_rec_has(r, LATTICE_LAMPS_PORT_VPL_DISTANCES), walls,
                                  tyn_rec_has(r, LATTICE_LAMPS_PORT_ROOMS)};
        // Workgroups are cubes of 4^3 cells.
        const tyn_extent blocks = {(dims.x + 3) / 4 * 8, (dims.y + 3) / 4 * LATTICE_VPL_SLICES,
                                   (dims.z + 3) / 4};
        TYN_DISPATCH(r, .kernel = KERNEL_VPLS, .cells = blocks, .args = &args, .spec = spec);
        TYN_DISPATCH(r, .kernel = KERNEL_NEAR, .cells = dims, .args = &args, .spec = spec);
    }
    TYN_DISPATCH(r, .kernel = KERNEL_LOST,
                 .cells = {num_lights(p) * LATTICE_SUN_GROUP, p->shape.channels, 1}, .args = &args,
                 .spec = &p->mode);
    TYN_DISPATCH(r, .kernel = KERNEL_SUM,
                 .cells = {args.num_groups * LATTICE_SUN_GROUP, p->shape.channels, 1},
                 .args = &args, .spec = &p->mode);
    // Without VPLs nothing is written to their image, so any will do.
    const uint8_t source_ports[] = {
        LATTICE_LAMPS_PORT_POWER,
        LATTICE_LAMPS_PORT_LIT,
        LATTICE_LAMPS_PORT_OTHERS,
        LATTICE_LAMPS_PORT_CELLS,
        LATTICE_LAMPS_PORT_SOURCE,
        p->vpls ? LATTICE_LAMPS_PORT_VPL_LIGHT : LATTICE_LAMPS_PORT_SOURCE,
    };
    TYN_DISPATCH(r, .kernel = KERNEL_LATTICE_LAMPS,
                 .cells = {dims.x, dims.y, dims.z * p->shape.channels}, .args = &args,
                 .ports = source_ports, .spec = &p->vpls);
    tyn_rec_work(r, "cells", (double)dims.x * dims.y * dims.z * p->num_lamps);
}

const tyn_pass_desc tyn_pass_lattice_lamps = {
    .name = "lattice_lamps",
    .summary = "unscattered light of lamps and surfaces in the cells of the lattice",
    .serves = "lamps and virtual point lights in media",
    TYN_PASS_TABLES(tyn_lattice_lamps_params),
    .debug_port = LATTICE_LAMPS_PORT_SOURCE,
    .debug_meaning = "unscattered light in a slice, W/m^2",
};
