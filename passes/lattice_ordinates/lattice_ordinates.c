// lattice_ordinates.c -- the principal ordinates' unscattered light on the lattice.
#include "lattice_ordinates.h"
#include "shaders/lattice/lattice_args.h"
#include "passes/lattice_ordinates_tables.h"
#include <math.h>
enum { LINES = 14 }; // through a cell: lattice_sweep.glsl

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_lattice_ordinates_params *p = params;
    tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    const bool seen = tyn_build_has(b, LATTICE_ORDINATES_PORT_SKY_SEEN);
    dims.z *= p->shape.channels;
    tyn_build_image(b, LATTICE_ORDINATES_PORT_SOURCE, dims, 1);
    const tyn_extent texel = {1, 1, 1};
    tyn_build_image(b, LATTICE_ORDINATES_PORT_EVEN, seen && p->mean ? dims : texel, 1);
    tyn_build_buffer(b, LATTICE_ORDINATES_PORT_GUESS,
                     seen && p->mean ? 16ull * dims.x * dims.y * dims.z : 16);
    tyn_build_buffer(b, LATTICE_ORDINATES_PORT_MEAN_PSI,
                     seen && p->mean ? 4ull * LINES * dims.x * dims.y * dims.z : 4);
    return TYN_OK;
}

// The sky's mean along the lines.
static void record_lines(tyn_recorder *r, const tyn_lattice_ordinates_params *p)
{
    const tyn_extent d = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    const uint32_t dims[3] = {d.x, d.y, d.z};
    struct lattice_mean_args args = {
        .dims = {d.x, d.y, d.z},
        .channels = p->shape.channels,
        .tint = {p->shape.tint[0], p->shape.tint[1], p->shape.tint[2]},
        .march = 2,
    };
    uint32_t most = 0, lines = 0;
    for (uint32_t a = 0; a < 3; a++) {
        const uint32_t across = dims[(a + 1) % 3] * dims[(a + 2) % 3];
        lines = across > lines ? across : lines;
        most = dims[a] > most ? dims[a] : most;
    }
    const float *e = p->shape.extent;
    args.dx = fmaxf(e[0], fmaxf(e[1], e[2])) / (float)most;
    TYN_DISPATCH(r, .kernel = KERNEL_LINES, .cells = {lines, LINES, args.channels}, .args = &args);
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_lattice_ordinates_params *p = params;
    tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    struct lattice_ordinates_args args = {
        .dims = {dims.x, dims.y, dims.z},
        .channels = p->shape.channels,
        .tint = {p->shape.tint[0], p->shape.tint[1], p->shape.tint[2]},
        .count = p->count,
    };
    const uint32_t seen = tyn_rec_has(r, LATTICE_ORDINATES_PORT_SKY_SEEN);
    const uint32_t spec[4] = {p->mode, p->grey ? 1 : 3, seen, seen && p->mean};
    if (seen && p->mean) {
        record_lines(r, p);
    }
    TYN_DISPATCH(r, .kernel = KERNEL_LATTICE_ORDINATES, .cells = {(dims.x + 1) / 2, dims.y, dims.z},
                 .args = &args, .spec = spec);

    // As if all ordinates were in use. A transmittance: 30 operations; sums 30.
    double cells = (double)dims.x * dims.y * dims.z * p->count;
    tyn_rec_work(r, "cells", cells);
    tyn_rec_work(r, "flops", cells * (spec[1] * 30 + 30));
    tyn_rec_work(r, "bytes", cells * (p->mode != TYN_MEDIUM_DENSITY ? 18 : 2));
}

const tyn_pass_desc tyn_pass_lattice_ordinates = {
    .name = "lattice_ordinates",
    .summary = "unscattered light of the principal ordinates in the cells of the lattice",
    .serves = "principal ordinates: an environment map",
    TYN_PASS_TABLES(tyn_lattice_ordinates_params),
    .debug_port = LATTICE_ORDINATES_PORT_SOURCE,
    .debug_meaning = "unscattered light of suns and ordinates in a slice, W/m^2",
};
