// lpv_blockers.c -- maps along the axes as blockers of light propagation volumes.
#include "lpv_blockers.h"
#include "lpv_blockers_args.h"
#include "passes/lpv_blockers_tables.h"
#include <math.h>
#include <string.h>

float tyn_lpv_blockers_view(const tyn_lpv_blockers_params *p, uint32_t i, uint32_t offset[2],
                            float rows[4][4])
{
    const float *extent = p->shape.extent;
    const uint32_t axis = i % 3, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const float cell = fmaxf(extent[0], fmaxf(extent[1], extent[2])) / (float)p->shape.cells;
    float half_side[3]; // what cells reach beyond the medium, and half a cell, on either side
    const tyn_extent dims = tyn_lattice_dims(extent, p->shape.cells);
    const uint32_t n[3] = {dims.x, dims.y, dims.z};
    for (int a = 0; a < 3; a++) {
        half_side[a] = 0.5f * (float)(n[a] + 1) * cell;
    }
    memset(rows, 0, 16 * sizeof(float));
    rows[0][u] = 1 / half_side[u];
    rows[0][3] = -0.5f * extent[u] / half_side[u];
    rows[1][v] = 1 / half_side[v];
    rows[1][3] = -0.5f * extent[v] / half_side[v];
    // Depths are reversed: 1 in the middle.
    rows[2][axis] = (i < 3 ? -1 : 1) / half_side[axis];
    rows[2][3] = 1 + (i < 3 ? 0.5f : -0.5f) * extent[axis] / half_side[axis];
    rows[3][3] = 1;
    offset[0] = axis * (uint32_t)p->texels;
    offset[1] = i / 3 * (uint32_t)p->texels;
    return 4 * half_side[u] * half_side[v] / ((float)p->texels * (float)p->texels);
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_lpv_blockers_params *p = params;
    const tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    tyn_build_buffer(b, LPV_BLOCKERS_PORT_BLOCKING, 7 * 4ull * dims.x * dims.y * dims.z);
    tyn_build_buffer(b, LPV_BLOCKERS_PORT_POTENTIAL,
                     16ull * (dims.x + 1) * (dims.y + 1) * (dims.z + 1));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_lpv_blockers_params *p = params;
    const float *extent = p->shape.extent;
    const tyn_extent dims = tyn_lattice_dims(extent, p->shape.cells);
    const tyn_extent atlas = tyn_rec_extent(r, LPV_BLOCKERS_PORT_RSM_POSITION);
    struct lpv_blockers_args args = {.extent = {extent[0], extent[1], extent[2]},
                                     .dims = {dims.x, dims.y, dims.z},
                                     .texels = (uint32_t)p->texels};
    for (uint32_t a = 0; a < 3; a++) {
        uint32_t offset[2];
        float rows[4][4];
        args.area[a] = tyn_lpv_blockers_view(p, a, offset, rows);
    }
    tyn_rec_fill(r, LPV_BLOCKERS_PORT_POTENTIAL, 0);
    TYN_DISPATCH(r, .kernel = KERNEL_DEPOSIT, .cells = atlas, .args = &args);
    TYN_DISPATCH(r, .kernel = KERNEL_LINKS, .cells = dims, .args = &args);
    tyn_rec_work(r, "texels", (double)atlas.x * atlas.y);
}

static const tyn_param param_table[] = {
    {"texels", TYN_PARAM_INT, offsetof(tyn_lpv_blockers_params, texels), 256, 16, 1024, "texels",
     "side of each of the six maps of fuzzy blockers", NULL},
};

const tyn_pass_desc tyn_pass_lpv_blockers = {
    .name = "lpv_blockers",
    .summary = "how much surfaces block light between cells, fuzzily",
    .serves = "surfaces in media, with lpv.blockers=fuzzy",
    TYN_PASS_TABLES(tyn_lpv_blockers_params),
    TYN_SETTINGS(param_table),
    .debug_port = LPV_BLOCKERS_PORT_BLOCKING,
    .debug_meaning = "blocked shares of the links, four a word",
};
