// lattice_ordinates.c -- the principal ordinates' unscattered light on the lattice.
#include "lattice_ordinates.h"
#include "shaders/lattice/lattice_args.h"
#include "lattice_ordinates.comp.h"

static const tyn_port ports[] = {LATTICE_ORDINATES_PORTS(TYN_PORT_ROW)};

static const tyn_kernel kernels[] = {
    TYN_KERNEL(lattice_ordinates),
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_lattice_ordinates_params *p = params;
    tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    dims.z *= p->shape.channels;
    tyn_build_image(b, LATTICE_ORDINATES_PORT_SOURCE, dims, 1);
    return TYN_OK;
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
    const uint32_t spec[2] = {p->mode, p->grey ? 1 : 3};
    TYN_DISPATCH(r, .cells = {(dims.x + 1) / 2, dims.y, dims.z}, .args = &args, .spec = spec);

    // As if all ordinates were in use. A transmittance: 30 operations; sums 30.
    double cells = (double)dims.x * dims.y * dims.z * p->count;
    tyn_rec_work(r, "cells", cells);
    tyn_rec_work(r, "flops", cells * (spec[1] * 30 + 30));
    tyn_rec_work(r, "bytes", cells * (p->mode == TYN_MEDIUM_COEFFICIENTS ? 18 : 2));
}

const tyn_pass_desc tyn_pass_lattice_ordinates = {
    .name = "lattice_ordinates",
    .summary = "unscattered light of the principal ordinates in the cells of the lattice",
    .serves = "principal ordinates: an environment map, and no walls in the medium",
    TYN_PASS_TABLES(tyn_lattice_ordinates_params),
    .debug_port = LATTICE_ORDINATES_PORT_SOURCE,
    .debug_meaning = "unscattered light of suns and ordinates in a slice, W/m^2",
};
