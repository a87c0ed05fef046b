// lattice.c -- the solve: sweeps, each followed by a diffusion correction and Anderson mixing.
#include "lattice.h"
#include "lattice_args.h"
#include "counters.h"
#include "lattice_start.comp.h"
#include "lattice_stencil.comp.h"
#include "lattice_stencil_coarse.comp.h"
#include "lattice_sweep.comp.h"
#include "lattice_collect.comp.h"
#include "lattice_relax.comp.h"
#include "lattice_restrict.comp.h"
#include "lattice_interpolate.comp.h"
#include "lattice_coarse.comp.h"
#include "lattice_residual.comp.h"
#include "lattice_weights.comp.h"
#include "lattice_mix.comp.h"
#include <math.h>

enum {
    PORT_EMITTED = LATTICE_PORT_FIRST_SCRATCH,
    PORT_MEAN_PSI,
    PORT_SWEPT,
    PORT_STENCIL_LO,
    PORT_STENCIL_HI,
    PORT_RHS,
    PORT_CORRECTION,
    PORT_RESULT,                   // and two more: of the last three sweeps
    PORT_CHANGE = PORT_RESULT + 3, // and two more
    PORT_PARTIALS = PORT_CHANGE + 3,
    PORT_WEIGHTS,
    NUM_PORTS,
};

#define RGBA VK_FORMAT_R32G32B32A32_SFLOAT

static const tyn_port ports[NUM_PORTS] = {
    [LATTICE_PORT_MEDIUM] = {"medium", TYN_IN, TYN_BUFFER, 0, false, "struct medium_block"},
    [LATTICE_PORT_CELLS] = {"cells", TYN_IN, TYN_IMAGE_3D, 0, false, "of lattice_cells"},
    [LATTICE_PORT_SOURCE] = {"source", TYN_IN, TYN_IMAGE_3D, 0, true, "of lattice_source"},
    [LATTICE_PORT_ENVIRONMENT] = {"environment", TYN_IN, TYN_BUFFER, 0, true,
                                  "struct env_block; its mean enters at the box"},
    [LATTICE_PORT_MOMENTS] =
        {"moments", TYN_OUT, TYN_IMAGE_3D, RGBA, false,
         "fluence and net flux of the scattered light, W/m^2; channels stacked "
         "along z"},
    [LATTICE_PORT_COUNTERS] = {"counters", TYN_OUT, TYN_BUFFER, 0, false, "struct counters_block"},
    [LATTICE_PORT_LEAKS] = {"leaks", TYN_OUT, TYN_BUFFER, 0, false,
                            "net power through the box of each line of the last sweep, W"},
    [PORT_EMITTED] = {"emitted", TYN_SCRATCH, TYN_IMAGE_3D, RGBA, false,
                      "scattered radiance per sigma_s', linear in direction"},
    [PORT_MEAN_PSI] = {"mean_psi", TYN_SCRATCH, TYN_IMAGE_3D, VK_FORMAT_R32_SFLOAT, false,
                       "mean radiance in a cell, directions stacked along x"},
    [PORT_SWEPT] = {"swept", TYN_SCRATCH, TYN_IMAGE_3D, RGBA, false, "moments after the sweep"},
    [PORT_STENCIL_LO] = {"stencil_lo", TYN_SCRATCH, TYN_IMAGE_3D, RGBA, false,
                         "conductance to -x, -y, -z; absorption"},
    [PORT_STENCIL_HI] = {"stencil_hi", TYN_SCRATCH, TYN_IMAGE_3D, RGBA, false,
                         "conductance to +x, +y, +z; their sum"},
    [PORT_RHS] = {"rhs", TYN_SCRATCH, TYN_IMAGE_3D, VK_FORMAT_R32_SFLOAT, false,
                  "of the diffusion correction, W"},
    [PORT_CORRECTION] = {"correction", TYN_SCRATCH, TYN_IMAGE_3D, VK_FORMAT_R32_SFLOAT, false,
                         "of the fluence, W/m^2"},
    [PORT_RESULT] = {"result_0", TYN_SCRATCH, TYN_IMAGE_3D, RGBA, false, "corrected moments"},
    [PORT_RESULT + 1] = {"result_1", TYN_SCRATCH, TYN_IMAGE_3D, RGBA, false, "corrected moments"},
    [PORT_RESULT + 2] = {"result_2", TYN_SCRATCH, TYN_IMAGE_3D, RGBA, false, "corrected moments"},
    [PORT_CHANGE] = {"change_0", TYN_SCRATCH, TYN_IMAGE_3D, RGBA, false, "what a sweep changed"},
    [PORT_CHANGE + 1] = {"change_1", TYN_SCRATCH, TYN_IMAGE_3D, RGBA, false,
                         "what a sweep changed"},
    [PORT_CHANGE + 2] = {"change_2", TYN_SCRATCH, TYN_IMAGE_3D, RGBA, false,
                         "what a sweep changed"},
    [PORT_PARTIALS] = {"partials", TYN_SCRATCH, TYN_BUFFER, 0, false, "dot products by workgroup"},
    [PORT_WEIGHTS] = {"weights", TYN_SCRATCH, TYN_BUFFER, 0, false, "shares of earlier sweeps"},
};

// ---- kernels --------------------------------------------------------------------------------------

enum {
    KERNEL_START,
    KERNEL_STENCIL,
    KERNEL_STENCIL_COARSE,
    KERNEL_SWEEP,
    KERNEL_COLLECT,
    KERNEL_RELAX,
    KERNEL_RESTRICT,
    KERNEL_INTERPOLATE,
    KERNEL_COARSE,
    KERNEL_RESIDUAL,
    KERNEL_WEIGHTS,
    KERNEL_MIX,
    NUM_KERNELS
};

static const tyn_binding start_bindings[] = {
    {LATTICE_PORT_ENVIRONMENT, TYN_USE_UNIFORM}, {LATTICE_PORT_CELLS, TYN_USE_SAMPLED},
    {LATTICE_PORT_SOURCE, TYN_USE_SAMPLED},      {LATTICE_PORT_MOMENTS, TYN_USE_STORAGE_WRITE},
    {PORT_EMITTED, TYN_USE_STORAGE_WRITE},
};
static const tyn_binding stencil_bindings[] = {
    {LATTICE_PORT_CELLS, TYN_USE_SAMPLED},
    {PORT_STENCIL_LO, TYN_USE_STORAGE_WRITE},
    {PORT_STENCIL_HI, TYN_USE_STORAGE_WRITE},
};
static const tyn_binding stencil_coarse_bindings[] = {
    {PORT_STENCIL_LO, TYN_USE_STORAGE_RW},
    {PORT_STENCIL_HI, TYN_USE_STORAGE_RW},
};
static const tyn_binding sweep_bindings[] = {
    {LATTICE_PORT_ENVIRONMENT, TYN_USE_UNIFORM},
    {LATTICE_PORT_CELLS, TYN_USE_SAMPLED},
    {PORT_EMITTED, TYN_USE_SAMPLED},
    {PORT_MEAN_PSI, TYN_USE_STORAGE_WRITE},
    {LATTICE_PORT_LEAKS, TYN_USE_STORAGE_WRITE},
};
static const tyn_binding collect_bindings[] = {
    {LATTICE_PORT_CELLS, TYN_USE_SAMPLED},   {PORT_MEAN_PSI, TYN_USE_SAMPLED},
    {LATTICE_PORT_MOMENTS, TYN_USE_SAMPLED}, {PORT_SWEPT, TYN_USE_STORAGE_WRITE},
    {PORT_RHS, TYN_USE_STORAGE_WRITE},       {PORT_CORRECTION, TYN_USE_STORAGE_WRITE},
};
static const tyn_binding relax_bindings[] = {
    {PORT_STENCIL_LO, TYN_USE_SAMPLED},
    {PORT_STENCIL_HI, TYN_USE_SAMPLED},
    {PORT_RHS, TYN_USE_SAMPLED},
    {PORT_CORRECTION, TYN_USE_STORAGE_RW},
};
static const tyn_binding restrict_bindings[] = {
    {PORT_STENCIL_LO, TYN_USE_SAMPLED},
    {PORT_STENCIL_HI, TYN_USE_SAMPLED},
    {PORT_RHS, TYN_USE_STORAGE_RW},
    {PORT_CORRECTION, TYN_USE_STORAGE_RW},
};
static const tyn_binding interpolate_bindings[] = {{PORT_CORRECTION, TYN_USE_STORAGE_RW}};
static const tyn_binding coarse_bindings[] = {
    {PORT_STENCIL_LO, TYN_USE_SAMPLED},
    {PORT_STENCIL_HI, TYN_USE_SAMPLED},
    {PORT_RHS, TYN_USE_SAMPLED},
    {PORT_CORRECTION, TYN_USE_STORAGE_RW},
};
static const tyn_binding residual_bindings[] = {
    {LATTICE_PORT_MOMENTS, TYN_USE_SAMPLED}, {PORT_SWEPT, TYN_USE_SAMPLED},
    {PORT_CORRECTION, TYN_USE_SAMPLED},      {PORT_CHANGE + 1, TYN_USE_SAMPLED},
    {PORT_CHANGE + 2, TYN_USE_SAMPLED},      {PORT_RESULT, TYN_USE_STORAGE_WRITE},
    {PORT_CHANGE, TYN_USE_STORAGE_WRITE},    {PORT_PARTIALS, TYN_USE_STORAGE_WRITE},
};
static const tyn_binding weights_bindings[] = {
    {PORT_PARTIALS, TYN_USE_STORAGE_READ},
    {PORT_WEIGHTS, TYN_USE_STORAGE_WRITE},
};
static const tyn_binding mix_bindings[] = {
    {LATTICE_PORT_CELLS, TYN_USE_SAMPLED},
    {LATTICE_PORT_SOURCE, TYN_USE_SAMPLED},
    {PORT_RESULT, TYN_USE_SAMPLED},
    {PORT_RESULT + 1, TYN_USE_SAMPLED},
    {PORT_RESULT + 2, TYN_USE_SAMPLED},
    {PORT_WEIGHTS, TYN_USE_STORAGE_READ},
    {LATTICE_PORT_MOMENTS, TYN_USE_STORAGE_WRITE},
    {PORT_EMITTED, TYN_USE_STORAGE_WRITE},
    {LATTICE_PORT_COUNTERS, TYN_USE_STORAGE_RW},
};

#define KERNEL(name, args, x, y, z)                                                                \
    {                                                                                              \
#name, lattice_##name##_spirv, sizeof lattice_##name##_spirv, sizeof(struct args),         \
            {x, y, z }, name##_bindings, sizeof name##_bindings / sizeof name##_bindings[0], 0     \
    }

static const tyn_kernel kernels[NUM_KERNELS] = {
    [KERNEL_START] = KERNEL(start, lattice_args, 8, 4, 2),
    [KERNEL_STENCIL] = KERNEL(stencil, lattice_level_args, 8, 4, 2),
    [KERNEL_STENCIL_COARSE] = KERNEL(stencil_coarse, lattice_level_args, 4, 4, 4),
    [KERNEL_SWEEP] = KERNEL(sweep, lattice_args, LATTICE_SWEEP_GROUP, 1, 1),
    [KERNEL_COLLECT] = KERNEL(collect, lattice_args, 8, 4, 2),
    [KERNEL_RELAX] = KERNEL(relax, lattice_level_args, 8, 4, 2),
    [KERNEL_RESTRICT] = KERNEL(restrict, lattice_level_args, 4, 4, 4),
    [KERNEL_INTERPOLATE] = KERNEL(interpolate, lattice_level_args, 8, 4, 2),
    [KERNEL_COARSE] = KERNEL(coarse, lattice_level_args, LATTICE_COARSE_GROUP, 1, 1),
    [KERNEL_RESIDUAL] = KERNEL(residual, lattice_args, LATTICE_GROUP, 1, 1),
    [KERNEL_WEIGHTS] = KERNEL(weights, lattice_args, LATTICE_GROUP, 1, 1),
    [KERNEL_MIX] = KERNEL(mix, lattice_args, 8, 4, 2),
};

// ---- levels of the diffusion grid -----------------------------------------------------------------

typedef struct solve { // what recording needs to know
    tyn_recorder *r;
    const tyn_lattice_params *params;
    tyn_extent size[8];   // of the levels
    uint32_t levels;      // until no side is longer than 4
    uint32_t first_small; // the first level that is solved in one workgroup
    tyn_extent texels;    // of the lattice with its channels
    struct lattice_args args;
} solve;

static uint32_t level_sizes(tyn_extent dims, tyn_extent size[8])
{
    uint32_t levels = 1;
    size[0] = dims;
    while (dims.x > 4 || dims.y > 4 || dims.z > 4) {
        dims = (tyn_extent){(dims.x + 1) / 2, (dims.y + 1) / 2, (dims.z + 1) / 2};
        size[levels++] = dims;
    }
    return levels;
}

// Level 0, and to the right of it the others one below the other.
static tyn_extent levels_extent(tyn_extent dims, uint32_t channels)
{
    tyn_extent size[8], extent = {dims.x, dims.y, dims.z * channels};
    uint32_t levels = level_sizes(dims, size), below = 0;
    for (uint32_t l = 1; l < levels; l++) {
        below += size[l].y;
    }
    extent.x += levels > 1 ? size[1].x : 0;
    extent.y = below > extent.y ? below : extent.y;
    return extent;
}

// ---- declare --------------------------------------------------------------------------------------

static uint32_t lines_of(tyn_extent d)
{
    uint32_t yz = d.y * d.z, xz = d.x * d.z, xy = d.x * d.y;
    return yz > xz ? (yz > xy ? yz : xy) : (xz > xy ? xz : xy);
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_lattice_params *p = params;
    uint32_t channels = p->shape.channels;
    tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    tyn_extent texels = {dims.x, dims.y, dims.z * channels};
    tyn_extent cells = tyn_build_extent(b, LATTICE_PORT_CELLS);
    if (cells.x != texels.x || cells.y != texels.y || cells.z != texels.z) {
        tyn_log_print(tyn_build_log(b), TYN_LOG_ERROR,
                      "pass 'lattice': 'cells' has %u x %u x %u texels; its own shape has "
                      "%u x %u x %u",
                      cells.x, cells.y, cells.z, texels.x, texels.y, texels.z);
        return TYN_ERR_PARAMS;
    }
    tyn_extent all_levels = levels_extent(dims, channels);
    tyn_build_image(b, LATTICE_PORT_MOMENTS, texels, 1);
    tyn_build_image(b, PORT_EMITTED, texels, 1);
    tyn_build_image(b, PORT_MEAN_PSI,
                    (tyn_extent){LATTICE_DIRECTIONS * texels.x, texels.y, texels.z}, 1);
    tyn_build_image(b, PORT_SWEPT, texels, 1);
    tyn_build_image(b, PORT_STENCIL_LO, all_levels, 1);
    tyn_build_image(b, PORT_STENCIL_HI, all_levels, 1);
    tyn_build_image(b, PORT_RHS, all_levels, 1);
    tyn_build_image(b, PORT_CORRECTION, all_levels, 1);
    for (uint8_t i = 0; i < 3; i++) {
        tyn_build_image(b, PORT_RESULT + i, texels, 1);
        tyn_build_image(b, PORT_CHANGE + i, texels, 1);
    }
    uint32_t groups = (dims.x * dims.y * dims.z + LATTICE_GROUP - 1) / LATTICE_GROUP;
    tyn_build_buffer(b, PORT_PARTIALS, sizeof(float) * LATTICE_NUM_DOTS * groups * channels);
    tyn_build_buffer(b, PORT_WEIGHTS, sizeof(float) * 2 * channels);
    tyn_build_buffer(b, LATTICE_PORT_COUNTERS, sizeof(struct counters_block));
    tyn_build_buffer(b, LATTICE_PORT_LEAKS,
                     sizeof(float) * LATTICE_DIRECTIONS * lines_of(dims) * channels);
    return TYN_OK;
}

// ---- record ---------------------------------------------------------------------------------------

static void on_cells(const solve *s, uint32_t kernel, const uint8_t *with_ports)
{
    tyn_rec_dispatch(
        s->r, &(tyn_dispatch){
                  .kernel = kernel, .cells = s->texels, .args = &s->args, .ports = with_ports});
}

static void on_level(const solve *s, uint32_t kernel, uint32_t level, tyn_extent threads,
                     uint32_t colour)
{
    const float *extent = s->params->shape.extent;
    struct lattice_level_args args = {
        .dims = {s->size[0].x, s->size[0].y, s->size[0].z},
        .level = level,
        .levels = s->levels,
        .channels = s->params->shape.channels,
        .colour = colour,
        .dx = s->args.dx,
        .least_transport = 0.3f / fmaxf(extent[0], fmaxf(extent[1], extent[2])),
    };
    threads.z *= s->params->shape.channels;
    tyn_rec_dispatch(s->r, &(tyn_dispatch){.kernel = kernel, .cells = threads, .args = &args});
}

static void relax_twice(const solve *s, uint32_t level)
{
    tyn_extent threads = s->size[level];
    threads.x = (threads.x + 1) / 2;
    for (uint32_t i = 0; i < 4; i++) {
        on_level(s, KERNEL_RELAX, level, threads, i % 2);
    }
}

static void v_cycle(const solve *s)
{
    for (uint32_t l = 0; l < s->first_small; l++) {
        relax_twice(s, l);
        on_level(s, KERNEL_RESTRICT, l + 1, s->size[l + 1], 0);
    }
    tyn_rec_dispatch(
        s->r, &(tyn_dispatch){.kernel = KERNEL_COARSE,
                              .cells = {LATTICE_COARSE_GROUP * s->params->shape.channels, 1, 1},
                              .args = &(struct lattice_level_args){
                                  .dims = {s->size[0].x, s->size[0].y, s->size[0].z},
                                  .level = s->first_small,
                                  .levels = s->levels,
                                  .channels = s->params->shape.channels,
                                  .dx = s->args.dx,
                              }});
    for (uint32_t l = s->first_small; l-- > 0;) {
        on_level(s, KERNEL_INTERPOLATE, l, s->size[l], 0);
        relax_twice(s, l);
    }
}

static void sweep(solve *s, uint32_t index)
{
    const tyn_lattice_params *p = s->params;
    tyn_rec_dispatch(
        s->r, &(tyn_dispatch){.kernel = KERNEL_SWEEP,
                              .cells = {s->args.lines, LATTICE_DIRECTIONS, p->shape.channels},
                              .args = &s->args});
    on_cells(s, KERNEL_COLLECT, NULL);
    for (int32_t i = 0; i < p->cycles; i++) {
        v_cycle(s);
    }
    // The three newest results and changes go round.
    uint8_t result[3], change[3];
    for (uint8_t age = 0; age < 3; age++) {
        result[age] = (uint8_t)(PORT_RESULT + (index + 3 - age) % 3);
        change[age] = (uint8_t)(PORT_CHANGE + (index + 3 - age) % 3);
    }
    s->args.history = !p->anderson ? 0 : index < 2 ? index : 2;
    const tyn_extent n = s->size[0];
    tyn_rec_dispatch(
        s->r, &(tyn_dispatch){.kernel = KERNEL_RESIDUAL,
                              .cells = {n.x * n.y * n.z, p->shape.channels, 1},
                              .args = &s->args,
                              .ports = (const uint8_t[]){LATTICE_PORT_MOMENTS, PORT_SWEPT,
                                                         PORT_CORRECTION, change[1], change[2],
                                                         result[0], change[0], PORT_PARTIALS}});
    tyn_rec_dispatch(s->r, &(tyn_dispatch){.kernel = KERNEL_WEIGHTS,
                                           .cells = {LATTICE_GROUP * p->shape.channels, 1, 1},
                                           .args = &s->args});
    on_cells(s, KERNEL_MIX,
             (const uint8_t[]){LATTICE_PORT_CELLS, LATTICE_PORT_SOURCE, result[0], result[1],
                               result[2], PORT_WEIGHTS, LATTICE_PORT_MOMENTS, PORT_EMITTED,
                               LATTICE_PORT_COUNTERS});
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_lattice_params *p = params;
    const float *extent = p->shape.extent;
    tyn_extent dims = tyn_lattice_dims(extent, p->shape.cells);
    solve s = {
        .r = r,
        .params = p,
        .texels = {dims.x, dims.y, dims.z * p->shape.channels},
        .args = {.dims = {dims.x, dims.y, dims.z},
                 .channels = p->shape.channels,
                 .tint = {p->shape.tint[0], p->shape.tint[1], p->shape.tint[2]},
                 .dx = fmaxf(extent[0], fmaxf(extent[1], extent[2])) / (float)p->shape.cells,
                 .lines = lines_of(dims)},
    };
    s.levels = level_sizes(dims, s.size);
    while (s.size[s.first_small].x * s.size[s.first_small].y * s.size[s.first_small].z >
           LATTICE_COARSE_CELLS) {
        s.first_small++;
    }
    tyn_rec_fill(r, LATTICE_PORT_COUNTERS, 0);
    on_cells(&s, KERNEL_START, NULL);
    if (p->cycles > 0) {
        on_level(&s, KERNEL_STENCIL, 0, dims, 0);
        for (uint32_t l = 1; l < s.levels; l++) {
            on_level(&s, KERNEL_STENCIL_COARSE, l, s.size[l], 0);
        }
    }
    for (uint32_t i = 0; i < (uint32_t)p->sweeps; i++) {
        sweep(&s, i);
    }
    double cells = (double)s.texels.x * s.texels.y * s.texels.z * p->sweeps;
    tyn_rec_work(r, "cells", cells);
    // A line's segment: 30 operations; collecting, mixing: 130; a cycle: 8/7 * 9 stencils of 15.
    tyn_rec_work(r, "flops", cells * (LATTICE_DIRECTIONS * 30 + 130 + 150 * p->cycles));
}

static const tyn_param param_table[] = {
    {"cells", TYN_PARAM_INT, offsetof(tyn_lattice_params, shape.cells), 32, 4,
     TYN_LATTICE_MAX_CELLS, "cells", "lattice cells along the longest side of the medium", NULL},
    {"sweeps", TYN_PARAM_INT, offsetof(tyn_lattice_params, sweeps), 4, 1, 64, "",
     "iterations of the solve; the error falls about tenfold with each two", NULL},
    {"cycles", TYN_PARAM_INT, offsetof(tyn_lattice_params, cycles), 2, 0, 8, "",
     "multigrid cycles of the diffusion correction after each sweep; 0 = no correction", NULL},
    {"anderson", TYN_PARAM_BOOL, offsetof(tyn_lattice_params, anderson), 1, 0, 1, "",
     "mix the results of the last three sweeps (Anderson acceleration)", NULL},
};

const tyn_pass_desc tyn_pass_lattice = {
    .name = "lattice",
    .summary =
        "light that has scattered, solved on a lattice of cubic cells for all lights at once",
    .ports = ports,
    .num_ports = NUM_PORTS,
    .kernels = kernels,
    .num_kernels = NUM_KERNELS,
    .params = param_table,
    .num_params = sizeof param_table / sizeof param_table[0],
    .params_size = sizeof(tyn_lattice_params),
    .declare = declare,
    .record = record,
    .debug_port = LATTICE_PORT_MOMENTS,
    .debug_meaning = "fluence and flux of the scattered light in a slice, W/m^2",
};
