// residuum.c -- see residuum.h.
#include "residuum.h"
#include "residuum_args.h"
#include "passes/residuum_tables.h"
#include "shaders/common/scene_args.h"
#include <math.h>

#define PORT(name) RESIDUUM_PORT_##name

uint32_t tyn_residuum_after(float a, float g, float sigma_s, float hop, float epsilon)
{
    double depth = (double)sigma_s * (double)hop; // of a hop
    if (a <= epsilon) {
        return 0;
    }
    double events = g <= 0 ? 1 : g >= 1 ? INFINITY : log((double)epsilon / (double)a) / log(g);
    double hops = depth > 0 ? ceil(events / depth) : INFINITY;
    return hops < UINT32_MAX ? (uint32_t)hops : UINT32_MAX;
}

#define FIELD(name) offsetof(tyn_residuum_params, name)
static const tyn_param params[] = {
    {"on", TYN_PARAM_BOOL, FIELD(on), 0, 0, 1, "",
     "merge what is left in the aligned grids and move it on as isotropic light"},
    {"epsilon", TYN_PARAM_FLOAT, FIELD(epsilon), 0.1, 0.001, 0.9, "",
     "mean cosine below which light counts as isotropic"},
    {"after", TYN_PARAM_INT, FIELD(after), 0, 0, 256, "",
     "iterations in the aligned grids before; 0 = as Eq 10 has it, at least as many as cells"},
    {"cells", TYN_PARAM_INT, FIELD(cells), 32, 4, 64, "cells",
     "cubic cells along the longest side of the medium's box"},
    {"iterations", TYN_PARAM_INT, FIELD(iterations), 20, 0, 256, "", "hops of the isotropic light"},
};

static tyn_extent dims_of(const tyn_residuum_params *p)
{
    float longest = fmaxf(p->extent[0], fmaxf(p->extent[1], p->extent[2]));
    uint32_t dims[3];
    for (int i = 0; i < 3; i++) {
        dims[i] = (uint32_t)fmaxf(1.0f, ceilf(p->extent[i] / longest * (float)p->cells - 1e-3f));
    }
    return (tyn_extent){dims[0], dims[1], dims[2]};
}

static tyn_result declare(tyn_builder *b, const void *data)
{
    tyn_extent dims = dims_of(data);
    uint64_t bytes = (uint64_t)dims.x * dims.y * dims.z * 4 * sizeof(float);
    tyn_build_image(b, PORT(RESIDUUM), dims, 1);
    tyn_build_buffer(b, PORT(STATE), bytes);
    tyn_build_buffer(b, PORT(STATE_OTHER), bytes);
    tyn_build_buffer(b, PORT(KEPT), bytes);
    tyn_build_buffer(b, PORT(SUM), bytes);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *data)
{
    // The states are written alternately, so that the last one lands in the output.
    static const uint8_t swap[][2] = {{PORT(STATE), PORT(STATE_OTHER)},
                                      {PORT(STATE_OTHER), PORT(STATE)}};
    uint8_t table[TYN_MAX_BINDINGS];
    const tyn_residuum_params *p = data;
    tyn_extent dims = dims_of(p);
    struct residuum_args args = {
        .dims = {dims.x, dims.y, dims.z},
        .num_grids = p->num_grids,
        .grid_cells = p->grid_cells,
        .grid_along = p->grid_along,
        .channels = p->channels,
        .tiles = tyn_rec_extent(r, PORT(LIGHT)).x / p->grid_cells,
    };
    bool other = p->iterations % 2 != 0;
    TYN_DISPATCH(r, .kernel = KERNEL_START, .cells = dims, .args = &args,
                 .ports = tyn_ports_exchanged(&kernels[KERNEL_START], swap, other ? 2 : 0, table),
                 .spec = &p->mode);
    for (int32_t m = 0; m < p->iterations; m++) {
        other = !other;
        TYN_DISPATCH(r, .kernel = KERNEL_STEP, .cells = dims, .args = &args,
                     .ports =
                         tyn_ports_exchanged(&kernels[KERNEL_STEP], swap, other ? 2 : 0, table));
    }
    TYN_DISPATCH(r, .kernel = KERNEL_COLLECT, .cells = dims, .args = &args);
    tyn_rec_work(r, "cells", (double)dims.x * dims.y * dims.z * p->iterations);
}

const tyn_pass_desc tyn_pass_residuum = {
    .name = "residuum",
    .summary = "light left in the aligned grids moved on as isotropic light in one grid",
    TYN_PASS_TABLES(tyn_residuum_params),
    TYN_SETTINGS(params),
    .debug_port = PORT(RESIDUUM),
    .debug_meaning = "light towards the eye, middle slice of the medium's box",
};
