// merge.c -- the light field of the lattice for one view.
#include "merge.h"
#include "merge_args.h"
#include "merge.comp.h"

static const tyn_port ports[MERGE_NUM_PORTS] = {
    [MERGE_PORT_MEDIUM] = {"medium", TYN_IN, TYN_BUFFER, 0, false, "struct medium_block"},
    [MERGE_PORT_CAMERA] = {"camera", TYN_IN, TYN_BUFFER, 0, false, "struct camera_block"},
    [MERGE_PORT_CELLS] = {"cells", TYN_IN, TYN_IMAGE_3D, 0, false, "of lattice_cells"},
    [MERGE_PORT_MOMENTS] = {"moments", TYN_IN, TYN_IMAGE_3D, 0, false, "of lattice"},
    [MERGE_PORT_INSCATTER] = {"inscatter", TYN_OUT, TYN_IMAGE_3D, VK_FORMAT_R32G32B32A32_SFLOAT,
                              false,
                              "radiance scattered towards the eye per sigma_s', W/(m^2 sr); one "
                              "ghost cell around"},
};

static const tyn_binding bindings[] = {
    {MERGE_PORT_MEDIUM, TYN_USE_UNIFORM},          {MERGE_PORT_CAMERA, TYN_USE_UNIFORM},
    {MERGE_PORT_CELLS, TYN_USE_SAMPLED},           {MERGE_PORT_MOMENTS, TYN_USE_SAMPLED},
    {MERGE_PORT_INSCATTER, TYN_USE_STORAGE_WRITE},
};

static const tyn_kernel kernels[] = {
    {"merge",
     merge_spirv,
     sizeof merge_spirv,
     sizeof(struct merge_args),
     {8, 4, 2},
     bindings,
     5,
     0},
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_merge_params *p = params;
    tyn_extent dims = tyn_build_extent(b, MERGE_PORT_MOMENTS);
    tyn_build_image(b, MERGE_PORT_INSCATTER,
                    (tyn_extent){dims.x + 2, dims.y + 2, dims.z / p->channels + 2}, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_merge_params *p = params;
    tyn_extent size = tyn_rec_extent(r, MERGE_PORT_INSCATTER);
    struct merge_args args = {{p->tint[0], p->tint[1], p->tint[2]}, p->channels};
    tyn_rec_dispatch(r, &(tyn_dispatch){.cells = size, .args = &args});
    tyn_rec_work(r, "cells", (double)size.x * size.y * size.z);
}

const tyn_pass_desc tyn_pass_merge = {
    .name = "merge",
    .summary = "light that each cell scatters towards the eye",
    .ports = ports,
    .num_ports = MERGE_NUM_PORTS,
    .kernels = kernels,
    .num_kernels = 1,
    .params_size = sizeof(tyn_merge_params),
    .declare = declare,
    .record = record,
    .debug_port = MERGE_PORT_INSCATTER,
    .debug_meaning = "radiance towards the eye per sigma_s' in a slice",
};
