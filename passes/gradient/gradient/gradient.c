// gradient.c -- tables and dispatches of samples with gradients.
#include "gradient.h"
#include <tyndall/extend/lattice_shape.h>
#include "shaders/common/counters.h"
#include "passes/gradient_tables.h"
#include <math.h>

// Steps of a ray, at most: software devices end all loops of a thread after 65535 turns, of which a list of
// TYN_LIGHT_LIST_MAX lights may need one for each four steps.
static const float MOST_STEPS = 1600;
static const float STEP = 0.5f; // between densities along rays to lights, voxels
// Of a valid radius: the width of radial functions. Their culling radius is three times that in the paper.
static const float RBF_WIDTH = 1.0f / 3;

static float longest_of(const float extent[3])
{
    return fmaxf(extent[0], fmaxf(extent[1], extent[2]));
}

float tyn_gradient_voxel(const float extent[3], const float voxel[3])
{
    const float longest = longest_of(extent);
    const float shortest = fminf(extent[0], fminf(extent[1], extent[2]));
    const float wanted = fminf(longest / 64, shortest / 16);
    return fminf(fmaxf(wanted, longest / 256), fminf(voxel[0], fminf(voxel[1], voxel[2])));
}

static uint32_t levels_of(const tyn_gradient_params *p)
{
    uint32_t levels = 1;
    while (levels < GRADIENT_MAX_LEVELS && p->cells << levels <= p->grid) {
        levels++;
    }
    return levels;
}

static tyn_extent grid_of(const tyn_gradient_params *p, uint32_t level)
{
    return tyn_lattice_dims(p->extent, p->cells << level);
}

uint32_t tyn_gradient_points(const tyn_gradient_params *p)
{
    uint32_t points = 0;
    for (uint32_t k = 0; k < levels_of(p); k++) {
        const tyn_extent n = grid_of(p, k);
        points += n.x * n.y * n.z;
    }
    return points;
}

int32_t tyn_gradient_cells(const float extent[3], int32_t cells)
{
    // As tyn_gradient_voxel has it.
    const float shortest = fminf(extent[0], fminf(extent[1], extent[2]));
    const float flat = fmaxf(0.25f * longest_of(extent) / shortest, 1);
    return (int32_t)fminf(ceilf(0.999f * flat * (float)cells), 256);
}

int32_t tyn_gradient_field(const tyn_gradient_params *p)
{
    const int32_t wanted = tyn_gradient_cells(p->extent, p->field);
    return wanted < p->voxels ? wanted : p->voxels;
}

static tyn_extent field_of(const tyn_gradient_params *p)
{
    return tyn_lattice_dims(p->extent, tyn_gradient_field(p));
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_gradient_params *p = params;
    const tyn_extent n = field_of(p);
    const bool voxel = p->interpolation == GRADIENT_VOXEL;
    const uint32_t points = voxel ? 1 : tyn_gradient_points(p);
    tyn_build_image(b, GRADIENT_PORT_INSCATTER, (tyn_extent){n.x + 2, n.y + 2, n.z + 2}, 1);
    tyn_build_buffer(b, GRADIENT_PORT_SAMPLES, sizeof(struct gradient_sample) * (uint64_t)points);
    tyn_build_buffer(b, GRADIENT_PORT_STATES, 4ull * points);
    tyn_build_buffer(b, GRADIENT_PORT_HEADS, sizeof(struct gradient_head));
    tyn_build_buffer(b, GRADIENT_PORT_ENTRIES, 4ull * points);
    return TYN_OK;
}

static struct gradient_args args_of(const tyn_gradient_params *p)
{
    const tyn_extent n = field_of(p);
    const float *e = p->extent;
    const float diagonal = sqrtf(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
    struct gradient_args args = {
        .levels = levels_of(p),
        .longest = longest_of(e),
        .radius = longest_of(e) / (float)p->cells,
        .step = fmaxf(STEP * p->voxel, diagonal / MOST_STEPS),
        .apart = p->voxel,
        .nearest = 0.5f * p->voxel,
        .epsilon = p->epsilon,
        .linear = (uint32_t)p->extrapolation,
        .fading = p->weight == 0,
        .narrow = RBF_WIDTH,
        .soft = p->soft * longest_of(e) / (float)(p->cells << (levels_of(p) - 1)),
        .tint = {p->tint[0], p->tint[1], p->tint[2]},
        .x = n.x,
        .y = n.y,
        .z = n.z,
    };
    for (uint32_t k = 0; k < args.levels; k++) {
        const tyn_extent grid = grid_of(p, k);
        args.grids[k] = grid.x | grid.y << 8 | grid.z << 16;
    }
    return args;
}

static void record_level(tyn_recorder *r, const tyn_gradient_params *p, struct gradient_args *args,
                         uint32_t features)
{
    const uint32_t threads = args->level + 1 < args->levels ? 16 : 8;
    const uint32_t next = args->level + 2 < args->levels ? 16 : 8;
    const uint32_t spec[] = {p->mode, features, threads}, split_spec[] = {0, next};
    const tyn_extent n = grid_of(p, args->level);
    const uint32_t points = n.x * n.y * n.z;
    const tyn_dispatch sample = {.kernel = KERNEL_SAMPLE, .args = args, .spec = spec};
    const tyn_dispatch split = {.kernel = KERNEL_SPLIT, .args = args, .spec = split_spec};
    const uint64_t head =
        offsetof(struct gradient_head, levels) + args->level * sizeof(struct gradient_level_head);
    if (args->level == 0) {
        const uint32_t groups = (points * threads + GRADIENT_GROUP - 1) / GRADIENT_GROUP;
        const uint32_t rows = (groups + GRADIENT_ROW - 1) / GRADIENT_ROW;
        tyn_dispatch all = sample;
        all.cells = (tyn_extent){(rows > 1 ? GRADIENT_ROW : groups) * GRADIENT_GROUP, rows, 1};
        tyn_rec_dispatch(r, &all);
    } else {
        tyn_rec_dispatch_indirect(r, &sample, GRADIENT_PORT_HEADS,
                                  head + offsetof(struct gradient_level_head, groups));
    }
    if (args->level + 1 == args->levels) {
        return;
    }
    if (args->level == 0) {
        TYN_DISPATCH(r, .kernel = KERNEL_REFERENCE, .cells = {256, 1, 1}, .args = args,
                     .spec = (const uint32_t[]){0});
        tyn_dispatch all = split;
        const uint32_t groups = (points + GRADIENT_GROUP - 1) / GRADIENT_GROUP;
        const uint32_t rows = (groups + GRADIENT_ROW - 1) / GRADIENT_ROW;
        all.cells = (tyn_extent){(rows > 1 ? GRADIENT_ROW : groups) * GRADIENT_GROUP, rows, 1};
        tyn_rec_dispatch(r, &all);
    } else {
        tyn_rec_dispatch_indirect(r, &split, GRADIENT_PORT_HEADS,
                                  head + offsetof(struct gradient_level_head, split));
    }
}

static uint32_t features_of(const tyn_recorder *r, const tyn_gradient_params *p)
{
    const bool shadows = tyn_rec_has(r, GRADIENT_PORT_SHADOW_ATLAS);
    const bool multiple = tyn_rec_has(r, GRADIENT_PORT_SCATTERED);
    uint32_t features = p->lamps ? GRADIENT_LAMPS : 0;
    features |= shadows ? GRADIENT_SHADOWS : 0;
    features |= shadows && p->soft > 0 ? GRADIENT_SOFT : 0;
    const bool sky = tyn_rec_has(r, GRADIENT_PORT_LIGHT_SHADES);
    features |= sky ? GRADIENT_SKY : 0;
    features |= sky && tyn_rec_has(r, GRADIENT_PORT_SKY_MAPS) ? GRADIENT_MAPS : 0;
    features |= multiple ? GRADIENT_MULTIPLE : 0;
    features |= multiple && tyn_rec_has(r, GRADIENT_PORT_WALL_LINKS) ? GRADIENT_WALLS : 0;
    features |= multiple && p->one_channel ? GRADIENT_ONE_CHANNEL : 0;
    return features;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_gradient_params *p = params;
    struct gradient_args args = args_of(p);
    const uint32_t features = features_of(r, p);
    const tyn_extent cells = {args.x + 2, args.y + 2, args.z + 2};
    if (p->interpolation == GRADIENT_VOXEL) {
        const uint32_t spec[] = {p->mode, features};
        TYN_DISPATCH(r, .kernel = KERNEL_VOXELS, .cells = cells, .args = &args, .spec = spec);
    } else {
        tyn_rec_fill(r, GRADIENT_PORT_STATES, 0);
        tyn_rec_fill(r, GRADIENT_PORT_HEADS, 0);
        for (args.level = 0; args.level < args.levels; args.level++) {
            record_level(r, p, &args, features);
        }
        const uint32_t spec[] = {0, (uint32_t)p->interpolation,
                                 tyn_rec_has(r, GRADIENT_PORT_BRICKS)};
        TYN_DISPATCH(r, .kernel = KERNEL_FIELD, .cells = cells, .args = &args, .spec = spec);
    }
    tyn_rec_work(r, "cells", (double)args.x * args.y * args.z);
}

static const char *const interpolations[] = {"gradient", "rbf", "voxel"};
static const char *const extrapolations[] = {"exponential", "linear"};
static const char *const weights[] = {"fading", "printed"};
static const char *const multiples[] = {"none", "lattice"};

static const tyn_param param_table[] = {
    {"cells", TYN_PARAM_INT, offsetof(tyn_gradient_params, cells), 8, 2, 32, "cells",
     "of the first grid of samples along the longest side", NULL},
    {"grid", TYN_PARAM_INT, offsetof(tyn_gradient_params, grid), 64, 2, GRADIENT_MAX_CELLS, "cells",
     "of the finest, at most: each grid is twice as fine as the one before", NULL},
    {"field", TYN_PARAM_INT, offsetof(tyn_gradient_params, field), 64, 16, 256, "cells",
     "of the field that is made of samples, along the longest side: more where the medium is flat, "
     "at most as many as voxels (64 at least)",
     NULL},
    {"medium", TYN_PARAM_INT, offsetof(tyn_gradient_params, medium), 64, 16, 256, "texels",
     "along the longest side, of the mean densities through which light is followed where the "
     "medium "
     "is finer (one medium); 256: as it is",
     NULL},
    {"epsilon", TYN_PARAM_FLOAT, offsetof(tyn_gradient_params, epsilon), 1e-4, 0, 1, "",
     "samples are split whose error is a larger share of all light seen (Eq 6)", NULL},
    {"lights", TYN_PARAM_INT, offsetof(tyn_gradient_params, lights), 32, 1, 64, "",
     "distant lights that stand for the environment", NULL},
    {"interpolation", TYN_PARAM_ENUM, offsetof(tyn_gradient_params, interpolation),
     GRADIENT_GRADIENT, 0, 2, "",
     "gradient: Eq 4; rbf: radial functions of the same samples; voxel: light is followed to each "
     "cell",
     interpolations},
    {"weight", TYN_PARAM_ENUM, offsetof(tyn_gradient_params, weight), 0, 0, 1, "",
     "of a sample: fading = (R / d - 1) / R^3; printed = R / d, which ends in a step", weights},
    {"extrapolation", TYN_PARAM_ENUM, offsetof(tyn_gradient_params, extrapolation), 0, 0, 1, "",
     "from a sample: exponential = L e^((x - x_j) grad L / L); linear = L + (x - x_j) grad L, as "
     "published",
     extrapolations},
    {"soft", TYN_PARAM_FLOAT, offsetof(tyn_gradient_params, soft), 0, 0, 8, "cells",
     "of the finest grid, across which edges of the shadows of surfaces are soft; 0: they are "
     "sharp",
     NULL},
    {"multiple", TYN_PARAM_ENUM, offsetof(tyn_gradient_params, multiple), 0, 0, 1, "",
     "light that has scattered more than once: none = left out, as published; lattice = samples "
     "read "
     "the solution of pop's lattice",
     multiples},
};

const tyn_pass_desc tyn_pass_gradient = {
    .name = "gradient",
    .summary = "light towards the eye from samples with gradients, split where they err",
    TYN_PASS_TABLES(tyn_gradient_params),
    TYN_SETTINGS(param_table),
    .debug_port = GRADIENT_PORT_INSCATTER,
    .debug_meaning = "light scattered towards the eye, per sigma_s",
    TYN_COUNTS(
        GRADIENT_PORT_COUNTERS, struct counters_block,
        {"samples", offsetof(struct counters_block, pixels)},
        {"followed", offsetof(struct counters_block, steps)}, TYN_COUNTER_NON_FINITE,
        {"clamped", offsetof(struct counters_block, clamped)},
        TYN_COUNTER_HIDDEN(
            "of the light",
            "accuracy: gradients lead below 0 between samples: %.1f %% of the light was set to 0 "
            "(-D gradient.extrapolation=exponential)")),
};
