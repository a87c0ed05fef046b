// lattice_source.c -- the suns' unscattered light on the lattice.
#include "lattice_source.h"
#include "shaders/lattice/lattice_args.h"
#include "passes/lattice_source_tables.h"
#include <math.h>

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_lattice_source_params *p = params;
    tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    if (p->num_suns < 1 || p->num_suns > TYN_LATTICE_MAX_SUNS) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "pass 'lattice_source': num_suns is %u; must be 1 to %d", p->num_suns,
                         TYN_LATTICE_MAX_SUNS);
    }
    tyn_build_image(b, LATTICE_SOURCE_PORT_SOURCE,
                    (tyn_extent){dims.x, dims.y, dims.z * p->shape.channels}, 1);
    tyn_build_image(b, LATTICE_SOURCE_PORT_SUNLIT,
                    (tyn_extent){dims.x, dims.y, dims.z * p->num_suns}, 1);
    tyn_build_buffer(b, LATTICE_SOURCE_PORT_POWER,
                     sizeof(struct lattice_power) * p->num_suns * p->shape.channels);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_lattice_source_params *p = params;
    tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    tyn_extent texels = tyn_rec_extent(r, LATTICE_SOURCE_PORT_DENSITY);
    const float *extent = p->shape.extent;
    const uint32_t size[3] = {texels.x, texels.y, texels.z};
    float dx = fmaxf(extent[0], fmaxf(extent[1], extent[2])) / (float)p->shape.cells, voxels = 0;
    struct lattice_source_args args = {
        .dims = {dims.x, dims.y, dims.z}, .channels = p->shape.channels, .num_suns = p->num_suns};
    for (int a = 0; a < 3; a++) {
        args.tint[a] = p->shape.tint[a];
        voxels = fmaxf(voxels, dx * (float)size[a] / extent[a]);
    }
    args.samples = (uint32_t)fminf(fmaxf(ceilf(0.5f * voxels - 1e-3f), 2), 4);
    double cells = (double)dims.x * dims.y * dims.z;
    const uint32_t spec[4] = {p->mode, p->shape.channels,
                              tyn_rec_has(r, LATTICE_SOURCE_PORT_WALL_LINKS),
                              tyn_rec_has(r, LATTICE_SOURCE_PORT_SHADOW_ATLAS)};
    for (; args.sun < p->num_suns; args.sun++) { // one by one: then all threads read the same of it
        TYN_DISPATCH(r, .kernel = KERNEL_BEAM, .cells = dims, .args = &args, .spec = spec);
    }
    TYN_DISPATCH(r, .kernel = KERNEL_SUM,
                 .cells = {p->num_suns * LATTICE_SUN_GROUP, p->shape.channels, 1}, .args = &args,
                 .spec = &p->mode);
    TYN_DISPATCH(r, .kernel = KERNEL_LATTICE_SOURCE,
                 .cells = {dims.x, dims.y, dims.z * p->shape.channels}, .args = &args);
    tyn_rec_work(r, "cells", cells * p->num_suns);
    tyn_rec_work(r, "fetches", 2 * cells * p->num_suns * pow(args.samples, 3));
}

const tyn_pass_desc tyn_pass_lattice_source = {
    .name = "lattice_source",
    .summary = "unscattered sunlight in the cells of the lattice",
    .serves = "suns in media that scatter more than once",
    TYN_PASS_TABLES(tyn_lattice_source_params),
    .debug_port = LATTICE_SOURCE_PORT_SOURCE,
    .debug_meaning = "unscattered sunlight in a slice, W/m^2",
};
