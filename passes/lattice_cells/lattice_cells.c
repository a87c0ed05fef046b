// lattice_cells.c -- the medium on the lattice.
#include "lattice_cells.h"
#include "shaders/lattice/lattice_args.h"
#include "passes/lattice_cells_tables.h"
#include <math.h>

enum { MAX_SAMPLES = 8 }; // along each axis of a cell

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_lattice_cells_params *p = params;
    tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    dims.z *= p->shape.channels;
    tyn_build_image(b, LATTICE_CELLS_PORT_CELLS, dims, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_lattice_cells_params *p = params;
    tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    tyn_extent texels = tyn_rec_extent(r, LATTICE_CELLS_PORT_DENSITY);
    struct lattice_cells_args args = {.dims = {dims.x, dims.y, dims.z},
                                      .channels = p->shape.channels};
    const uint32_t size[3] = {texels.x, texels.y, texels.z};
    const float *extent = p->shape.extent;
    float dx = fmaxf(extent[0], fmaxf(extent[1], extent[2])) / (float)p->shape.cells;
    double fetches = (double)dims.x * dims.y * dims.z;
    for (int a = 0; a < 3; a++) {
        args.tint[a] = p->shape.tint[a];
        // One trilinear sample for two voxels along an axis, which misses none; at least two, as
        // the medium's box may end inside a cell.
        float pairs = ceilf(0.5f * dx * (float)size[a] / extent[a] - 1e-3f);
        args.samples[a] = (uint32_t)fminf(fmaxf(pairs, 2), MAX_SAMPLES);
        fetches *= args.samples[a];
    }
    TYN_DISPATCH(r, .cells = dims, .args = &args, .spec = &p->mode);
    tyn_rec_work(r, "cells", (double)dims.x * dims.y * dims.z);
    tyn_rec_work(r, "fetches", fetches * (p->mode != TYN_MEDIUM_DENSITY ? 4 : 1));
}

const tyn_pass_desc tyn_pass_lattice_cells = {
    .name = "lattice_cells",
    .summary = "the medium averaged over the cells of the lattice",
    .serves = "media that scatter more than once",
    TYN_PASS_TABLES(tyn_lattice_cells_params),
    .media_only = true,
    .debug_port = LATTICE_CELLS_PORT_CELLS,
    .debug_meaning = "sigma_s', sigma_a, g' of a slice through the cells",
};
