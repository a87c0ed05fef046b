// columns.c -- two dispatches for all ordinates: march the columns of their grids, gather them to cells.
#include "columns.h"
#include "passes/columns_tables.h"
#include "shaders/common/counters.h"
#include <math.h>

// Of a storage buffer binding, which every device can do. The scratch of a batch stays below half.
static const uint64_t max_bytes = 128u << 20, batch_bytes = 64u << 20;

static uint32_t components(const tyn_columns_params *p)
{
    return p->mode != TYN_MEDIUM_DENSITY ? COLUMNS_COMPONENTS : 1;
}

// The most that an ordinate may need, whatever its direction: columns, and nodes of one component.
static void grid_size(const tyn_columns_params *p, uint32_t *columns, uint32_t *nodes)
{
    *columns = *nodes = 0;
    for (int w = 0; w < 3; w++) {
        uint32_t c = (p->dims[(w + 1) % 3] + 1) * (p->dims[(w + 2) % 3] + 1);
        *columns = c > *columns ? c : *columns;
        *nodes = c * p->dims[w] > *nodes ? c * p->dims[w] : *nodes;
    }
}

// Ordinates that are done at once: all of them, unless the lattice is a fine one.
static uint32_t batch_size(const tyn_columns_params *p, uint32_t nodes)
{
    uint64_t most = batch_bytes / ((uint64_t)nodes * components(p) * sizeof(float));
    return most < 1 ? 1 : most < p->count ? (uint32_t)most : p->count;
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_columns_params *p = params;
    const uint32_t *dims = p->dims;
    if (p->count < 1 || p->count > TYN_ORDINATES_MAX) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "columns: count is %u; must be 1 to %d ordinates", p->count,
                         TYN_ORDINATES_MAX);
    }
    uint64_t words = (uint64_t)p->count * components(p) * ((dims[0] + 1) / 2) * dims[1] * dims[2];
    if (4 * words > max_bytes) {
        return TYN_FAULT(
            tyn_build_log(b), TYN_ERR_PARAMS,
            "columns: %u ordinates on a lattice of %u x %u x %u cells need %.0f MiB; at "
            "most 128 MiB: lower ordinates.count or lattice.cells",
            p->count, dims[0], dims[1], dims[2], (double)words * 4 / 0x1p20);
    }
    uint32_t columns, nodes;
    grid_size(p, &columns, &nodes);
    tyn_build_buffer(b, COLUMNS_PORT_COLUMNS, 4 * words);
    tyn_build_buffer(b, COLUMNS_PORT_NODES,
                     (uint64_t)batch_size(p, nodes) * components(p) * nodes * sizeof(float));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_columns_params *p = params;
    const uint32_t num_components = components(p);
    uint32_t columns, nodes;
    grid_size(p, &columns, &nodes);
    uint32_t batch = batch_size(p, nodes);
    struct columns_args args = {.dims = {p->dims[0], p->dims[1], p->dims[2]},
                                .stride = num_components * nodes};
    for (args.first = 0; args.first < p->count; args.first += batch) {
        uint32_t ordinates = p->count - args.first < batch ? p->count - args.first : batch;
        TYN_DISPATCH(r, .kernel = num_components > 1 ? KERNEL_COEFFICIENTS : KERNEL_DENSITY,
                     .cells = {columns, 1, ordinates}, .args = &args, .spec = &p->mode);
        uint32_t rows = p->dims[1] > p->dims[2] ? p->dims[1] : p->dims[2];
        TYN_DISPATCH(r, .kernel = KERNEL_GATHER,
                     .cells = {(p->dims[0] + 1) / 2 * rows, 1, num_components * ordinates},
                     .args = &args, .spec = &p->mode);
    }

    tyn_extent texels = tyn_rec_extent(r, COLUMNS_PORT_DENSITY);
    const uint32_t size[3] = {texels.x, texels.y, texels.z};
    double longest = fmax(p->extent[0], fmax(p->extent[1], p->extent[2])), voxels = 1;
    double cells = (double)p->dims[0] * p->dims[1] * p->dims[2];
    for (int a = 0; a < 3; a++) {
        double dx = longest / fmax(p->dims[0], fmax(p->dims[1], p->dims[2]));
        voxels = fmax(voxels, dx * size[a] / p->extent[a]);
    }
    // As if all ordinates were in use, along axes. A sample: position 9, sum 1 (with coefficients delta
    // scaling and 9 sums); a cell: its place 40, and for a component two values between columns.
    double all_nodes = (double)nodes * p->count, samples = all_nodes * ceil(0.4 * voxels - 0.01);
    tyn_rec_work(r, "cells", cells * p->count);
    tyn_rec_work(r, "fetches", samples * (num_components > 1 ? 3 : 1));
    tyn_rec_work(r, "flops",
                 samples * (num_components > 1 ? 40 : 10) + cells * p->count * num_components * 60);
    tyn_rec_work(r, "bytes", num_components * (all_nodes * 4 + cells * p->count * (4 * 4 + 2)));
}

const tyn_pass_desc tyn_pass_columns = {
    .name = "columns",
    .summary = "optical depth along the principal ordinates to the cells of the lattice",
    .serves = "principal ordinates: an environment map",
    TYN_PASS_TABLES(tyn_columns_params),
    .debug_port = COLUMNS_PORT_COLUMNS,
    .debug_meaning = "medium integrated along each ordinate to each cell, roots as halves",
    TYN_COUNTS(COLUMNS_PORT_COUNTERS, struct counters_block, TYN_COUNTER_NON_FINITE),
};
