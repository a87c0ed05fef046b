// medium.c -- resamples the shapes where they are not one grid already; bricks and distances.
#include "medium.h"
#include "medium_args.h"
#include "passes/medium_tables.h"

static const char *const storages[] = {"auto", "half", "float"};

static const tyn_param params_table[] = {
    {"storage", TYN_PARAM_ENUM, offsetof(tyn_medium_params, storage), 0, 0, 2, "",
     "how density grids are kept: auto is half floats on a GPU if their range is enough", storages},
    {"samples", TYN_PARAM_INT, offsetof(tyn_medium_params, samples), 3, 1, 8, "",
     "points along each axis of a voxel at the edge of a shape that its mean is taken over", NULL},
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_medium_params *p = params;
    tyn_extent size = {p->size[0], p->size[1], p->size[2]};
    tyn_extent bricks = {p->bricks[0], p->bricks[1], p->bricks[2]};
    for (int i = 0; i < 3; i++) {
        if (p->size[i] == 0 || p->bricks[i] != (p->size[i] + TYN_BRICK - 1) / TYN_BRICK) {
            return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                             "medium: %u bricks of %d for %u voxels along axis %d", p->bricks[i],
                             TYN_BRICK, p->size[i], i);
        }
    }
    if (p->mode != TYN_MEDIUM_DENSITY) {
        tyn_build_format(b, MEDIUM_PORT_DENSITY, VK_FORMAT_R32G32B32A32_SFLOAT);
        tyn_build_image(b, MEDIUM_PORT_DENSITY, size, 1);
        tyn_build_image(b, MEDIUM_PORT_SIGMA_A, size, 1);
        if (p->mode == TYN_MEDIUM_COEFFICIENTS) {
            tyn_build_image(b, MEDIUM_PORT_G, size, 1);
        }
        if (p->emissive) {
            tyn_build_image(b, MEDIUM_PORT_EMISSION, size, 1);
        }
    } else if (!p->direct) {
        tyn_build_image(b, MEDIUM_PORT_DENSITY, size, 1);
    }
    tyn_build_image(b, MEDIUM_PORT_BRICKS, bricks, 1);
    tyn_build_image(b, MEDIUM_PORT_DISTANCE, bricks, 1);
    tyn_build_image(b, MEDIUM_PORT_DISTANCE_SCRATCH, bricks, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_medium_params *p = params;
    bool coefficients = p->mode != TYN_MEDIUM_DENSITY;
    bool colors = coefficients && p->colors;
    tyn_extent size = {p->size[0], p->size[1], p->size[2]};
    tyn_extent bricks = {p->bricks[0], p->bricks[1], p->bricks[2]};
    struct resample_args resample = {(uint32_t)p->samples};
    if (coefficients) {
        // An image that is not written to may be any.
        static const uint8_t absent[][2] = {{MEDIUM_PORT_G, MEDIUM_PORT_SIGMA_A}};
        const uint32_t kernel = colors ? KERNEL_COLORS : KERNEL_COEFFICIENTS;
        uint8_t bindings[TYN_MAX_BINDINGS];
        tyn_ports_exchanged(&kernels[kernel], absent, p->mode == TYN_MEDIUM_ONE_PHASE, bindings);
        TYN_DISPATCH(r, .kernel = kernel, .cells = size, .args = &resample, .ports = bindings);
        if (p->emissive) {
            TYN_DISPATCH(r, .kernel = colors ? KERNEL_EMISSION_COLORS : KERNEL_EMISSION_PLAIN,
                         .cells = size, .args = &resample);
        }
    } else if (!p->direct) {
        TYN_DISPATCH(r, .kernel = KERNEL_DENSITY, .cells = size, .args = &resample);
    }

    TYN_DISPATCH(r, .kernel = colors ? KERNEL_BRICKS_COLORS : KERNEL_BRICKS_PLAIN, .cells = bricks,
                 .args = &(struct bricks_args){p->direct ? 0.0f : 1.0f});

    // x: bricks -> distance, y: distance -> scratch, z: scratch -> distance.
    static const uint8_t chain[] = {MEDIUM_PORT_BRICKS, MEDIUM_PORT_DISTANCE,
                                    MEDIUM_PORT_DISTANCE_SCRATCH, MEDIUM_PORT_DISTANCE};
    for (uint32_t axis = 0; axis < 3; axis++) {
        TYN_DISPATCH(r, .kernel = KERNEL_DISTANCE, .cells = bricks,
                     .args = &(struct distance_args){axis},
                     .ports = (const uint8_t[]){MEDIUM_PORT_MEDIUM, chain[axis], chain[axis + 1]});
    }
    double voxels = (double)size.x * size.y * size.z;
    double written = p->direct ? 0 : 4;
    if (coefficients) {
        written = 32 + 16 * (p->emissive + (p->mode == TYN_MEDIUM_COEFFICIENTS));
    }
    tyn_rec_work(r, "cells", voxels);
    tyn_rec_work(r, "bytes", voxels * (4 + written)); // atlas, textures
}

const tyn_pass_desc tyn_pass_medium = {
    .name = "medium",
    .summary = "textures of all media together, ranges over bricks, distances through empty space",
    .serves = "media",
    TYN_PASS_TABLES(tyn_medium_params),
    TYN_SETTINGS(params_table),
    .media_only = true,
    .debug_port = MEDIUM_PORT_BRICKS,
    .debug_meaning = "least (red) and largest (green) density or sigma_t of the bricks",
};
