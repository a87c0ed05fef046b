// merge.c -- the light field of the lattice for one view.
#include "merge.h"
#include "merge_one.comp.h"
#include "merge_three.comp.h"

static const tyn_port ports[MERGE_NUM_PORTS] = {
    [MERGE_PORT_MEDIUM] = {"medium", TYN_IN, TYN_BUFFER, 0, false, "struct medium_block"},
    [MERGE_PORT_CAMERA] = {"camera", TYN_IN, TYN_BUFFER, 0, false, "struct camera_block"},
    [MERGE_PORT_CELLS] = {"cells", TYN_IN, TYN_IMAGE_3D, 0, false, "of lattice_cells"},
    [MERGE_PORT_MOMENTS] = {"moments", TYN_IN, TYN_IMAGE_3D, 0, false, "of lattice"},
    [MERGE_PORT_INSCATTER] = {"inscatter", TYN_OUT, TYN_IMAGE_3D, VK_FORMAT_R32G32B32A32_SFLOAT,
                              false,
                              "radiance scattered towards the eye per sigma_s', W/(m^2 sr); one "
                              "ghost cell around; R32F where one channel is solved"},
};

static const tyn_binding bindings[] = {
    {MERGE_PORT_MEDIUM, TYN_USE_UNIFORM},          {MERGE_PORT_CAMERA, TYN_USE_UNIFORM},
    {MERGE_PORT_CELLS, TYN_USE_SAMPLED},           {MERGE_PORT_MOMENTS, TYN_USE_SAMPLED},
    {MERGE_PORT_INSCATTER, TYN_USE_STORAGE_WRITE},
};

enum { KERNEL_ONE, KERNEL_THREE, NUM_KERNELS };

static const tyn_kernel kernels[NUM_KERNELS] = {
    [KERNEL_ONE] =
        {"merge_one", merge_one_spirv, sizeof merge_one_spirv, 0, {8, 4, 2}, bindings, 5, 0},
    [KERNEL_THREE] =
        {"merge_three", merge_three_spirv, sizeof merge_three_spirv, 0, {8, 4, 2}, bindings, 5, 0},
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_merge_params *p = params;
    tyn_extent dims = tyn_build_extent(b, MERGE_PORT_MOMENTS);
    if (p->channels == 1) {
        tyn_build_format(b, MERGE_PORT_INSCATTER, VK_FORMAT_R32_SFLOAT);
    }
    tyn_build_image(b, MERGE_PORT_INSCATTER,
                    (tyn_extent){dims.x + 2, dims.y + 2, dims.z / p->channels + 2}, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_merge_params *p = params;
    tyn_extent size = tyn_rec_extent(r, MERGE_PORT_INSCATTER);
    uint32_t kernel = p->channels == 1 ? KERNEL_ONE : KERNEL_THREE;
    tyn_rec_dispatch(r, &(tyn_dispatch){.kernel = kernel, .cells = size});
    tyn_rec_work(r, "cells", (double)size.x * size.y * size.z);
}

const tyn_pass_desc tyn_pass_merge = {
    .name = "merge",
    .summary = "light that each cell scatters towards the eye",
    .ports = ports,
    .num_ports = MERGE_NUM_PORTS,
    .kernels = kernels,
    .num_kernels = NUM_KERNELS,
    .params_size = sizeof(tyn_merge_params),
    .declare = declare,
    .record = record,
    .debug_port = MERGE_PORT_INSCATTER,
    .debug_meaning = "radiance towards the eye per sigma_s' in a slice",
};
