// photon_upsample.c -- tables of the cache's upsampling.
#include "photon_upsample.h"
#include "photon_upsample_args.h"
#include "passes/photon_upsample_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_photon_upsample_params *p = params;
    const tyn_extent n = tyn_lattice_dims(p->shape.extent, p->cells);
    const tyn_extent all = {n.x, n.y, n.z * p->lobes};
    tyn_build_image(b, PHOTON_UPSAMPLE_PORT_FLUENCE, all, 1);
    tyn_build_image(b, PHOTON_UPSAMPLE_PORT_WAY, all, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_photon_upsample_params *p = params;
    const tyn_extent n = tyn_lattice_dims(p->shape.extent, p->cells),
                     coarse = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    const struct photon_upsample_args args = {
        .dims = {n.x, n.y, n.z},
        .coarse = {coarse.x, coarse.y, coarse.z},
        .lobes = p->lobes,
        .channels = p->shape.channels,
        .filter_is = (uint32_t)p->filter,
        .lobe = (uint32_t)p->lobe,
        .majorant = p->majorant,
        .scaled = p->scaled,
        .weighted = p->weighted,
    };
    TYN_DISPATCH(r, .cells = {n.x, n.y, n.z * p->lobes}, .args = &args, .spec = &p->mode);
    tyn_rec_work(r, "cells", (double)n.x * n.y * n.z * p->lobes);
}

static const char *const filters[] = {"trilinear", "depth"};
static const char *const lobes[] = {"extrapolated", "printed"};

static const tyn_param param_table[] = {
    {"cells", TYN_PARAM_INT, offsetof(tyn_photon_upsample_params, cells), 64, 4, 64, "cells",
     "along the longest side of the medium that the picture reads, at most: no more than voxels",
     NULL},
    {"filter", TYN_PARAM_ENUM, offsetof(tyn_photon_upsample_params, filter), PHOTON_FILTER_DEPTH, 0,
     1, "",
     "between the cache's cells: trilinear; depth = by the medium's extinction and density, as "
     "published",
     filters},
    {"lobe", TYN_PARAM_ENUM, offsetof(tyn_photon_upsample_params, lobe), PHOTON_LOBE_EXTRAPOLATED,
     0, 1, "",
     "mean cosine between cells: extrapolated = g' g^delta by the penetration depth; printed = "
     "g^delta is a weight",
     lobes},
};

const tyn_pass_desc tyn_pass_photon_upsample = {
    .name = "photon_upsample",
    .summary = "the cache of photons at the places of finer cells",
    TYN_PASS_TABLES(tyn_photon_upsample_params),
    TYN_SETTINGS(param_table),
    .debug_port = PHOTON_UPSAMPLE_PORT_FLUENCE,
    .debug_meaning = "fluence of the first lobe",
};
