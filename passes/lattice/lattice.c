// lattice.c -- the solve: sweeps, each followed by a diffusion correction and Anderson mixing.
#include "lattice.h"
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/counters.h"
#include "passes/lattice_tables.h"
#include <math.h>
#include <string.h>

// The state is in buffers: a software device stores to images several times more slowly. They are read as texels, which
// it does as fast as with images.

// ---- kernels ------------------------------------------------------------------------------------

// ---- levels of the diffusion grid ---------------------------------------------------------------

enum { MAX_LEVELS = 8 };

typedef struct levels {
    tyn_extent size[MAX_LEVELS];
    uint32_t num;         // until no side is longer than 4
    uint32_t first_small; // the first that is solved in one workgroup
    uint32_t cells;       // of all
    uint32_t repeat;      // a bit for each axis along which they go on beyond the box
} levels;

static uint32_t num_cells(tyn_extent e)
{
    return e.x * e.y * e.z;
}

static uint32_t coarse_cells(const tyn_lattice_params *p)
{
    return p->little_shared ? LATTICE_COARSE_FEW : LATTICE_COARSE_CELLS;
}

static levels plan_levels(const tyn_lattice_params *p, tyn_extent dims, const uint32_t repeat[3])
{
    levels l = {.size = {dims}, .num = 1, .cells = num_cells(dims)};
    while (dims.x > 4 || dims.y > 4 || dims.z > 4) {
        dims = (tyn_extent){(dims.x + 1) / 2, (dims.y + 1) / 2, (dims.z + 1) / 2};
        l.size[l.num++] = dims;
        l.cells += num_cells(dims);
    }
    while (num_cells(l.size[l.first_small]) > coarse_cells(p)) {
        l.first_small++;
    }
    for (uint32_t a = 0; a < 3; a++) {
        l.repeat |= (repeat[a] != 0) << a;
    }
    // The checkerboard has neighbours of one colour where an odd number of cells repeats: only small levels can deal with
    // that. Else the sides are as if mirrored; a correction may be inexact.
    for (uint32_t i = 0; i < l.first_small; i++) {
        l.repeat &= ~((l.size[i].x & 1) | (l.size[i].y & 1) << 1 | (l.size[i].z & 1) << 2);
    }
    return l;
}

// ---- declare ------------------------------------------------------------------------------------

static uint32_t lines_of(tyn_extent d)
{
    uint32_t yz = d.y * d.z, xz = d.x * d.z, xy = d.x * d.y;
    return yz > xz ? (yz > xy ? yz : xy) : (xz > xy ? xz : xy);
}

// Vectors of the state of a channel: of the cells, and four cells' walls in one.
static uint32_t num_elements(tyn_extent dims, bool walls)
{
    return num_cells(dims) + (walls ? (num_cells(dims) + 3) / 4 : 0);
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_lattice_params *p = params;
    uint32_t channels = p->shape.channels;
    tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    tyn_extent texels = {dims.x, dims.y, dims.z * channels};
    tyn_extent cells = tyn_build_extent(b, LATTICE_PORT_CELLS);
    if (cells.x != texels.x || cells.y != texels.y || cells.z != texels.z) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "pass 'lattice': 'cells' has %u x %u x %u texels; its own shape has "
                         "%u x %u x %u",
                         cells.x, cells.y, cells.z, texels.x, texels.y, texels.z);
    }
    const uint32_t *repeat = p->shape.repeat;
    if ((repeat[0] && repeat[1] && repeat[2]) ||
        tyn_lattice_fit(p->shape.extent, repeat, p->shape.cells) != p->shape.cells) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "pass 'lattice': sides that repeat must be whole numbers of cells, one "
                         "side must not repeat, and there may be %d cells",
                         TYN_LATTICE_MAX_ALL);
    }
    const bool walls = tyn_build_has(b, LATTICE_PORT_WALL_LINKS);
    if (walls != tyn_build_has(b, LATTICE_PORT_WALL_CELLS)) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "pass 'lattice': 'wall_links' and 'wall_cells' must be connected both or "
                         "neither");
    }
    const uint64_t scalar = sizeof(float) * channels, n = num_cells(dims);
    const uint64_t elements = num_elements(dims, walls);
    const uint64_t all_levels = plan_levels(p, dims, p->shape.repeat).cells;
    uint64_t groups = (elements + LATTICE_GROUP_CELLS - 1) / LATTICE_GROUP_CELLS;
    tyn_build_image(b, LATTICE_PORT_MOMENTS, texels, 1);
    tyn_build_buffer(b, LATTICE_PORT_STATE, 4 * scalar * elements);
    tyn_build_buffer(b, LATTICE_PORT_EMITTED, 4 * scalar * n);
    tyn_build_buffer(b, LATTICE_PORT_MEAN_PSI, LATTICE_DIRECTIONS * scalar * n);
    tyn_build_buffer(b, LATTICE_PORT_SWEPT, 4 * scalar * elements);
    tyn_build_buffer(b, LATTICE_PORT_STENCIL_LO, 4 * scalar * all_levels);
    tyn_build_buffer(b, LATTICE_PORT_STENCIL_HI, 4 * scalar * all_levels);
    tyn_build_buffer(b, LATTICE_PORT_RHS, scalar * all_levels);
    tyn_build_buffer(b, LATTICE_PORT_CORRECTION, scalar * all_levels);
    for (uint8_t i = 0; i < 3; i++) {
        tyn_build_buffer(b, LATTICE_PORT_RESULT_0 + i, 4 * scalar * elements);
        tyn_build_buffer(b, LATTICE_PORT_CHANGE_0 + i, 4 * scalar * elements);
    }
    tyn_build_buffer(b, LATTICE_PORT_PARTIALS, LATTICE_NUM_DOTS * scalar * groups);
    tyn_build_buffer(b, LATTICE_PORT_WEIGHTS,
                     sizeof(float) * 2 * LATTICE_MAX_CHANNELS + sizeof(uint32_t));
    tyn_build_buffer(b, LATTICE_PORT_LAUNCHES, sizeof(uint32_t) * 3 * LATTICE_MAX_LAUNCHES);
    tyn_build_buffer(b, LATTICE_PORT_ARRIVED, walls ? LATTICE_DIRECTIONS * scalar * n : scalar);
    tyn_build_buffer(b, LATTICE_PORT_WALL_POWER, walls ? 2 * scalar * n : scalar);
    tyn_build_buffer(b, LATTICE_PORT_LEAKS,
                     sizeof(float) * LATTICE_DIRECTIONS * lines_of(dims) * channels);
    return TYN_OK;
}

// ---- record -------------------------------------------------------------------------------------

typedef struct solve { // what recording needs to know
    tyn_recorder *r;
    const tyn_lattice_params *params;
    levels levels;
    tyn_extent texels; // of the lattice with its channels
    uint32_t walls[2]; // there are walls; they shine
    bool relax_late;   // the residual relaxes colour 1 of the last cycle
    struct lattice_args args;
    // Launches of a cycle that the device may leave out:
    enum { DIRECT, LISTED, INDIRECT } launch;
    uint32_t num_launches;
    uint32_t launches[LATTICE_MAX_LAUNCHES][3]; // in workgroups
} solve;

static void on_cells(const solve *s, uint32_t kernel)
{
    tyn_rec_dispatch(
        s->r,
        &(tyn_dispatch){.kernel = kernel, .cells = s->texels, .args = &s->args, .spec = s->walls});
}

static void list_launch(solve *s, uint32_t kernel, tyn_extent threads)
{
    const uint32_t n[3] = {threads.x, threads.y, threads.z}, *local = kernels[kernel].local_size;
    for (int a = 0; a < 3; a++) {
        s->launches[s->num_launches][a] = (n[a] + local[a] - 1) / local[a];
    }
    s->num_launches++;
}

static void on_level_as(solve *s, uint32_t kernel, uint32_t level, tyn_extent threads,
                        uint32_t colour, uint32_t spec)
{
    const float *extent = s->params->shape.extent;
    tyn_extent dims = s->levels.size[0];
    struct lattice_level_args args = {
        .dims = {dims.x, dims.y, dims.z},
        .level = level,
        .levels = s->levels.num,
        .stride = s->levels.cells,
        .channels = s->params->shape.channels,
        .colour = colour,
        .dx = s->args.dx,
        .repeat = {s->params->shape.repeat[0], s->params->shape.repeat[1],
                   s->params->shape.repeat[2]},
        .least_transport = 0.3f / fmaxf(extent[0], fmaxf(extent[1], extent[2])),
    };
    const uint32_t specs[3] = {spec, s->levels.repeat, s->params->little_shared};
    const tyn_dispatch d = {.kernel = kernel, .cells = threads, .args = &args, .spec = specs};
    if (s->launch == LISTED) {
        list_launch(s, kernel, threads);
    } else if (s->launch == INDIRECT) {
        tyn_rec_dispatch_indirect(s->r, &d, LATTICE_PORT_LAUNCHES,
                                  sizeof s->launches[0] * s->num_launches++);
    } else {
        tyn_rec_dispatch(s->r, &d);
    }
}

static void on_level(solve *s, uint32_t kernel, uint32_t level, tyn_extent threads, uint32_t colour)
{
    on_level_as(s, kernel, level, threads, colour, s->walls[0]);
}

// Threads of a kernel that visits every cell of a level, or every second one along x.
static tyn_extent cells_of(const solve *s, uint32_t level)
{
    tyn_extent e = s->levels.size[level];
    return (tyn_extent){e.x, e.y, e.z * s->params->shape.channels};
}

static void coarse_stencils(solve *s)
{
    for (uint32_t l = 1; l < s->levels.num; l++) {
        if (s->walls[0]) { // first the fine cells that the coarse ones do not stand for
            on_level_as(s, KERNEL_STENCIL_COARSE, l, cells_of(s, l), 0, 1);
        }
        on_level_as(s, KERNEL_STENCIL_COARSE, l, cells_of(s, l), 0, 2 * s->walls[0]);
    }
    if (s->walls[0]) {
        on_level(s, KERNEL_STENCIL_WALLS, 0,
                 (tyn_extent){s->levels.cells, s->params->shape.channels, 1}, 0);
    }
}

static void relax(solve *s, uint32_t level, uint32_t colour)
{
    tyn_extent threads = cells_of(s, level);
    threads.x = (threads.x + 1) / 2;
    on_level(s, KERNEL_RELAX, level, threads, colour);
}

// A workgroup for each block of cells of level `fine`.
static void on_blocks(solve *s, uint32_t kernel, uint32_t level, uint32_t fine)
{
    const tyn_extent e = s->levels.size[fine];
    const uint32_t last = LATTICE_TILE - 1;
    on_level(s, kernel, level,
             (tyn_extent){(e.x + last) / LATTICE_TILE * kernels[kernel].local_size[0],
                          (e.y + last) / LATTICE_TILE,
                          (e.z + last) / LATTICE_TILE * s->params->shape.channels},
             0);
}

// V(1,1): two of them are better than one V(2,2), which costs as much. Where corrections start from 0 whoever starts
// them has relaxed colour 0. Of the last cycle colour 1 may be left to the residual.
static void v_cycle(solve *s, bool fresh, bool last)
{
    const uint32_t small = s->levels.first_small;
    for (uint32_t l = 0; l < small; l++) {
        if (l == 0 && !fresh) {
            relax(s, l, 0);
        }
        on_blocks(s, KERNEL_RESTRICT, l + 1, l);
    }
    on_level(s, KERNEL_COARSE, small,
             (tyn_extent){LATTICE_COARSE_GROUP * s->params->shape.channels, 1, 1},
             small > 0 || fresh);
    for (uint32_t l = small; l-- > 0;) {
        on_blocks(s, KERNEL_INTERPOLATE, l, l);
        if (l > 0 || !last) {
            relax(s, l, 1);
        }
    }
}

// The second and further cycles of a correction: among walls the device leaves them out if the medium is thin.
static void further_cycle(solve *s, bool last)
{
    s->launch = s->walls[0] ? INDIRECT : DIRECT;
    s->num_launches = 0;
    v_cycle(s, false, last);
    s->launch = DIRECT;
}

static void list_further_cycle(solve *s)
{
    s->launch = LISTED;
    v_cycle(s, false, false);
    s->launch = DIRECT;
    tyn_rec_update(s->r, LATTICE_PORT_LAUNCHES, 0, s->launches, sizeof s->launches);
    tyn_rec_dispatch(s->r, &(tyn_dispatch){.kernel = KERNEL_DEPTH,
                                           .cells = {LATTICE_DEPTH_GROUP, 1, 1},
                                           .args = &s->args});
}

// Mixes the result of sweep number `index` with those of the two before; the three newest go round.
static void mix(solve *s, uint32_t index)
{
    const tyn_lattice_params *p = s->params;
    uint8_t result[3], change[3];
    for (uint8_t age = 0; age < 3; age++) {
        result[age] = (uint8_t)(LATTICE_PORT_RESULT_0 + (index + 3 - age) % 3);
        change[age] = (uint8_t)(LATTICE_PORT_CHANGE_0 + (index + 3 - age) % 3);
    }
    s->args.history = index < 2 ? index : 2;
    s->args.anderson = p->anderson;
    uint32_t groups = (s->args.elements + LATTICE_GROUP_CELLS - 1) / LATTICE_GROUP_CELLS;
    const uint32_t spec[2] = {index + 1 == (uint32_t)p->sweeps, s->walls[0]};
    const uint32_t residual_spec[4] = {s->walls[0], spec[0], s->levels.repeat, s->relax_late};
    tyn_rec_dispatch(
        s->r, &(tyn_dispatch){.kernel = KERNEL_RESIDUAL,
                              .cells = {groups * LATTICE_GROUP, p->shape.channels, 1},
                              .args = &s->args,
                              .spec = residual_spec,
                              .ports = (const uint8_t[]){
                                  LATTICE_PORT_STATE, LATTICE_PORT_SWEPT, LATTICE_PORT_CORRECTION,
                                  change[1], change[2], result[0], change[0], LATTICE_PORT_PARTIALS,
                                  LATTICE_PORT_WALL_CELLS, LATTICE_PORT_STENCIL_LO,
                                  LATTICE_PORT_STENCIL_HI, LATTICE_PORT_RHS, LATTICE_PORT_WEIGHTS,
                                  LATTICE_PORT_COUNTERS}});
    tyn_rec_dispatch(
        s->r,
        &(tyn_dispatch){.kernel = KERNEL_MIX,
                        .cells = s->texels,
                        .args = &s->args,
                        .spec = spec,
                        .ports = (const uint8_t[]){
                            LATTICE_PORT_CELLS, LATTICE_PORT_SOURCE, result[0], result[1],
                            result[2], LATTICE_PORT_WEIGHTS, LATTICE_PORT_STATE,
                            LATTICE_PORT_EMITTED, LATTICE_PORT_COUNTERS, LATTICE_PORT_MOMENTS,
                            LATTICE_PORT_SWEPT, LATTICE_PORT_WALL_CELLS, LATTICE_PORT_WALL_POWER}});
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_lattice_params *p = params;
    const float *extent = p->shape.extent;
    tyn_extent dims = tyn_lattice_dims(extent, p->shape.cells);
    solve s = {
        .r = r,
        .params = p,
        .levels = plan_levels(p, dims, p->shape.repeat),
        .texels = {dims.x, dims.y, dims.z * p->shape.channels},
        .args = {.dims = {dims.x, dims.y, dims.z},
                 .channels = p->shape.channels,
                 .tint = {p->shape.tint[0], p->shape.tint[1], p->shape.tint[2]},
                 .dx = fmaxf(extent[0], fmaxf(extent[1], extent[2])) / (float)p->shape.cells,
                 .lines = lines_of(dims),
                 .guess = tyn_rec_has(r, LATTICE_PORT_GUESS)},
    };
    s.args.stride = s.levels.cells;
    s.walls[0] = tyn_rec_has(r, LATTICE_PORT_WALL_LINKS);
    s.walls[1] = tyn_rec_has(r, LATTICE_PORT_WALL_LIGHT);
    s.args.elements = num_elements(dims, s.walls[0]);
    s.args.corrected = p->cycles > 0;
    // Among walls the residual reads corrections more than once.
    s.relax_late = p->cycles > 0 && !s.walls[0] && s.levels.first_small > 0;
    const uint32_t *repeat = p->shape.repeat;
    const uint32_t sweep_spec[2] = {s.walls[0], repeat[0] || repeat[1] || repeat[2]};
    memcpy(s.args.repeat, repeat, sizeof s.args.repeat);
    s.args.march = !repeat[2] ? 2 : !repeat[1] ? 1 : 0;
    tyn_rec_fill(r, LATTICE_PORT_WEIGHTS, 0);
    if (p->cycles > 1 && s.walls[0]) {
        list_further_cycle(&s);
    }
    on_cells(&s, KERNEL_START);
    if (p->cycles > 0) {
        on_level(&s, KERNEL_STENCIL, 0, cells_of(&s, 0), 0);
    }
    for (uint32_t i = 0; i < (uint32_t)p->sweeps; i++) {
        TYN_DISPATCH(r, .kernel = KERNEL_SWEEP,
                     .cells = {s.args.lines, LATTICE_DIRECTIONS, p->shape.channels},
                     .args = &s.args, .spec = sweep_spec);
        if (i == 0 && p->cycles > 0) { // beside the first sweep: no barrier is between them
            coarse_stencils(&s);
        }
        on_cells(&s, KERNEL_COLLECT);
        for (int32_t c = 0; c < p->cycles; c++) {
            const bool last = c + 1 == p->cycles && s.relax_late;
            if (c == 0) {
                v_cycle(&s, true, last);
            } else {
                further_cycle(&s, last);
            }
        }
        mix(&s, i);
    }
    double cells = (double)num_cells(s.texels) * p->sweeps;
    tyn_rec_work(r, "cells", cells);
    // A line's segment: 30 operations; collecting, mixing: 130; a cycle: 8/7 * 9 stencils of 15.
    tyn_rec_work(r, "flops", cells * (LATTICE_DIRECTIONS * 30 + 130 + 150 * p->cycles));
}

static const tyn_param param_table[] = {
    {"cells", TYN_PARAM_INT, offsetof(tyn_lattice_params, shape.cells), 32, 4,
     TYN_LATTICE_MAX_CELLS, "cells",
     "lattice cells along the longest side of the medium; 262144 in all", NULL},
    {"sweeps", TYN_PARAM_INT, offsetof(tyn_lattice_params, sweeps), 4, 1, 256, "",
     "iterations of the solve; the error falls about tenfold with each two", NULL},
    {"cycles", TYN_PARAM_INT, offsetof(tyn_lattice_params, cycles), 2, 0, 8, "",
     "multigrid cycles of the diffusion correction after each sweep; thin media among walls get "
     "one; "
     "0 = no correction",
     NULL},
    {"anderson", TYN_PARAM_BOOL, offsetof(tyn_lattice_params, anderson), 1, 0, 1, "",
     "mix the results of the last three sweeps (Anderson acceleration)", NULL},
};

const tyn_pass_desc tyn_pass_lattice = {
    .name = "lattice",
    .summary =
        "light that has scattered, solved on a lattice of cubic cells for all lights at once",
    .serves = "media that scatter more than once",
    TYN_PASS_TABLES(tyn_lattice_params),
    TYN_SETTINGS(param_table),
    .debug_port = LATTICE_PORT_MOMENTS,
    .debug_meaning = "fluence and flux of the scattered light in a slice, W/m^2",
    TYN_COUNTS(
        LATTICE_PORT_COUNTERS, struct counters_block, TYN_COUNTERS,
        {.name = "unsettled",
         .offset = offsetof(struct counters_block, unsettled),
         .real = true,
         .count = 3,
         .unit = "of the scattered light",
         .limit = 0.02,
         .warning =
             "accuracy: the lattice is not solved to the end: about %g %% of the scattered light "
             "would still change; more sweeps are needed (-D lattice.sweeps)"},
        TYN_COUNTER_HIDDEN(
            "of what walls send out",
            "accuracy: walls of the lattice would send out negative light, which is set "
            "to 0: %g %% of what they send out; the lattice is not solved to the end "
            "(-D lattice.sweeps)")),
};
