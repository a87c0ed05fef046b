// voxel_distance.c -- for each voxel the Euclidean distance to the nearest one that is not empty, beside the density.
#include "voxel_distance.h"
#include "shaders/common/scene_args.h"
#include "passes/voxel_distance_tables.h"
#include <math.h>

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_voxel_distance_params *p = params;
    tyn_extent size = tyn_build_extent(b, VOXEL_DISTANCE_PORT_DENSITY);
    if (p->mode != TYN_MEDIUM_DENSITY) {
        tyn_build_format(b, VOXEL_DISTANCE_PORT_VOXELS, VK_FORMAT_R32G32B32A32_SFLOAT);
    }
    tyn_build_image(b, VOXEL_DISTANCE_PORT_VOXELS, size, 1);
    tyn_build_image(b, VOXEL_DISTANCE_PORT_ALONG_X, size, 1);
    tyn_build_image(b, VOXEL_DISTANCE_PORT_ALONG_Y, size, 1);
    tyn_build_buffer(b, VOXEL_DISTANCE_PORT_ENVELOPE, 4ull * size.x * size.y * size.z);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_voxel_distance_params *p = params;
    const bool coefficients = p->mode != TYN_MEDIUM_DENSITY;
    const tyn_extent size = tyn_rec_extent(r, VOXEL_DISTANCE_PORT_DENSITY);
    const float unit = fminf(p->voxel[0], fminf(p->voxel[1], p->voxel[2]));
    const struct voxel_distance_args args = {
        .size = {size.x, size.y, size.z},
        .unit = unit,
        .side = {p->voxel[0] / unit, p->voxel[1] / unit, p->voxel[2] / unit},
        .reach = p->reach,
    };
    const uint32_t spec[] = {p->emissive};
    TYN_DISPATCH(r, .kernel = coefficients ? KERNEL_ROWS_COEFFICIENTS : KERNEL_ROWS_DENSITY,
                 .cells = {size.y, size.z, 1}, .args = &args, .spec = spec);
    TYN_DISPATCH(r, .kernel = KERNEL_COLUMNS, .cells = {size.x, size.z, 1}, .args = &args);
    TYN_DISPATCH(r, .kernel = coefficients ? KERNEL_LAYERS_COEFFICIENTS : KERNEL_LAYERS_DENSITY,
                 .cells = {size.x, size.y, 1}, .args = &args);
    tyn_rec_work(r, "cells", (double)size.x * size.y * size.z);
}

const tyn_pass_desc tyn_pass_voxel_distance = {
    .name = "voxel_distance",
    .summary = "distance of each voxel to the nearest one that is not empty",
    .serves = "media",
    TYN_PASS_TABLES(tyn_voxel_distance_params),
    .media_only = true,
    .debug_port = VOXEL_DISTANCE_PORT_VOXELS,
    .debug_meaning = "density (red), distance to the nearest voxel that is not empty (green)",
};
