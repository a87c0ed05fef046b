// radial_beam.c -- lays out the grids of local lights and sweeps them in one dispatch.
#include "radial_beam.h"
#include "radial_beam_args.h"
#include "passes/radial_beam_tables.h"
#include "shaders/common/counters.h"
#include <math.h>
#include <string.h>

// With coefficients a node has 48 bytes instead of 4: fine grids are kept to 64 cells, 10 MB per lamp.
enum { MAX_CELLS = 160, MAX_COEFFICIENT_CELLS = 64, FURTHER_CELLS = 32 };
enum { LEAST_WIDTH = 128 }; // texels that tiles of many lights are laid side by side in

static const tyn_param params_table[] = {
    {"cells", TYN_PARAM_INT, offsetof(tyn_radial_beam_params, cells), 112, 2, MAX_CELLS, "cells",
     "along a side of the strongest lamps' maps of directions (64 at most where coefficients are "
     "textures; 32 for further lamps); no finer than the medium",
     NULL},
    {"vpl_cells", TYN_PARAM_INT, offsetof(tyn_radial_beam_params, vpl_cells), 8, 2, 32, "cells",
     "... of lights that stand for reflections and emission of surfaces", NULL},
};

// ---- layout ---------------------------------------------------------------------------------------

void tyn_radial_beam_plan(tyn_radial_beam_params *params, float (*colors)[4],
                          const struct medium_block *medium, const struct light_block *lamps,
                          uint32_t num_lamps, uint32_t fine, uint32_t max_vpls)
{
    uint32_t count = 0;
    for (; count < num_lamps && count < TYN_RADIAL_LAMPS_MAX; count++) {
        uint32_t at = count;
        for (; at > 0 && light_strength(params->lamps[at - 1]) < light_strength(lamps[count]);
             at--) {
            params->lamps[at] = params->lamps[at - 1];
        }
        params->lamps[at] = lamps[count];
    }
    for (uint32_t i = 0; i < count; i++) {
        memcpy(colors[i], params->lamps[i].color, sizeof params->lamps[i].color);
        memset(params->lamps[i].color, 0, sizeof params->lamps[i].color);
    }
    params->mode = medium->mode;
    params->num_lamps = count;
    params->num_fine = fine < count ? fine : count;
    params->max_vpls = max_vpls < TYN_RADIAL_VPLS_MAX ? max_vpls : TYN_RADIAL_VPLS_MAX;
    // A cell of the map is sqrt(4 pi) / cells wide; at half the box's diagonal as wide as a voxel.
    double diagonal = 0, voxel = INFINITY;
    for (int a = 0; a < 3; a++) {
        diagonal += (double)medium->extent[a] * medium->extent[a];
        voxel = fmin(voxel, medium->voxel[a]);
    }
    bool even = medium->size[0] * medium->size[1] * medium->size[2] == 1;
    double finest = ceil(3.545 * 0.5 * sqrt(diagonal) / voxel);
    params->finest = even ? 2 : (uint32_t)fmin(fmax(finest, 4), MAX_CELLS);
}

static uint32_t smaller(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static struct radial_beam_args layout(const tyn_radial_beam_params *p)
{
    const uint32_t cells[RADIAL_CLASSES] = {(uint32_t)p->cells, FURTHER_CELLS,
                                            (uint32_t)p->vpl_cells};
    const uint32_t counts[RADIAL_CLASSES] = {p->num_fine, p->num_lamps - p->num_fine, p->max_vpls};
    uint32_t most =
        smaller(p->mode != TYN_MEDIUM_DENSITY ? MAX_COEFFICIENT_CELLS : MAX_CELLS, p->finest);
    struct radial_beam_args args = {.num_lamps = p->num_lamps, .max_vpls = p->max_vpls};
    uint32_t width = 1, first = 0;
    for (uint32_t c = 0; c < RADIAL_CLASSES; c++) {
        struct radial_class *class = &args.classes[c];
        class->first_light = first;
        class->count = counts[c];
        class->cells = smaller(cells[c], most);
        class->shells = class->cells < 4 ? 2 : (3 * class->cells + 3) / 4;
        class->patches = (class->cells + 2 + RADIAL_GROUP - 1) / RADIAL_GROUP;
        first += counts[c];
        uint32_t tile = class->cells + 2, row = (uint32_t)ceil(sqrt(counts[c]));
        uint32_t fit = LEAST_WIDTH / tile > 1 ? LEAST_WIDTH / tile : 1;
        uint32_t wanted = tile * smaller(row, fit);
        width = counts[c] > 0 && wanted > width ? wanted : width;
    }
    uint32_t layers = 0;
    for (uint32_t c = 0; c < RADIAL_CLASSES; c++) {
        struct radial_class *class = &args.classes[c];
        class->first_layer = layers;
        if (class->count == 0) {
            continue;
        }
        class->per_row = width / (class->cells + 2);
        uint32_t per_layer = class->per_row * class->per_row;
        layers += (class->count + per_layer - 1) / per_layer * (class->shells + 1);
    }
    args.size[0] = args.size[1] = width;
    args.size[2] = layers;
    return args;
}

// ---- the pass -------------------------------------------------------------------------------------

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_radial_beam_params *p = params;
    uint32_t lights = p->num_lamps + p->max_vpls;
    if (lights == 0 || p->num_lamps > TYN_RADIAL_LAMPS_MAX || p->num_fine > p->num_lamps ||
        p->max_vpls > TYN_RADIAL_VPLS_MAX || p->finest < 1) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "radial_beam: %u lamps and %u VPLs planned, must be 1 to %d and 0 to %d",
                         p->num_lamps, p->max_vpls, TYN_RADIAL_LAMPS_MAX, TYN_RADIAL_VPLS_MAX);
    }
    struct radial_beam_args args = layout(p);
    tyn_extent extent = {args.size[0], args.size[1], args.size[2]};
    tyn_build_buffer(b, RADIAL_BEAM_PORT_GRIDS,
                     offsetof(struct radial_block, list) + lights * sizeof(struct radial_grid));
    tyn_build_buffer(b, RADIAL_BEAM_PORT_LAMPS, sizeof p->lamps);
    if (p->mode == TYN_MEDIUM_DENSITY) {
        tyn_build_image(b, RADIAL_BEAM_PORT_RADIAL_COLUMN, extent, 1);
    } else {
        tyn_build_format(b, RADIAL_BEAM_PORT_RADIAL_COLUMN, VK_FORMAT_R32G32B32A32_SFLOAT);
        tyn_build_image(b, RADIAL_BEAM_PORT_RADIAL_COLUMN, extent, 1);
        tyn_build_image(b, RADIAL_BEAM_PORT_RADIAL_TAU_A, extent, 1);
        tyn_build_image(b, RADIAL_BEAM_PORT_RADIAL_TAU_P, extent, 1);
    }
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_radial_beam_params *p = params;
    struct radial_beam_args args = layout(p);
    tyn_rec_update(r, RADIAL_BEAM_PORT_LAMPS, 0, p->lamps, sizeof p->lamps);
    TYN_DISPATCH(r, .kernel = KERNEL_SETUP, .cells = {p->num_lamps + p->max_vpls, 1, 1},
                 .args = &args);
    uint32_t groups = 0;
    double nodes = 0;
    for (uint32_t c = 0; c < RADIAL_CLASSES; c++) {
        const struct radial_class *class = &args.classes[c];
        groups += class->count * class->patches * class->patches;
        nodes += (double)class->count * class->cells * class->cells * (class->shells + 1);
    }
    bool density = p->mode == TYN_MEDIUM_DENSITY;
    TYN_DISPATCH(r, .kernel = density ? KERNEL_DENSITY : KERNEL_COEFFICIENTS,
                 .cells = {groups * RADIAL_GROUP * RADIAL_GROUP, 1, 1}, .args = &args,
                 .spec = &p->mode);
    tyn_rec_work(r, "cells", nodes);
    tyn_rec_work(r, "bytes", nodes * (density ? 4 : 48));
}

const tyn_pass_desc tyn_pass_radial_beam = {
    .name = "radial_beam",
    .summary = "optical depth from local lights outwards, in a grid around each",
    .serves = "lamps and virtual point lights in media",
    TYN_PASS_TABLES(tyn_radial_beam_params),
    TYN_SETTINGS(params_table),
    .debug_port = RADIAL_BEAM_PORT_RADIAL_COLUMN,
    .debug_meaning = "mean density from lights outwards: maps of directions",
    TYN_COUNTS(RADIAL_BEAM_PORT_COUNTERS, struct counters_block, TYN_COUNTER_NON_FINITE),
};
