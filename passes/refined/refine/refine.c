// refine.c -- tables and dispatches of the fit on layers.
#include "refine.h"
#include "shaders/common/counters.h"
#include "passes/refine_tables.h"

static uint32_t over(uint32_t n, uint32_t of)
{
    return (n + of - 1) / of;
}

typedef struct refine_shapes {
    tyn_extent cells, tiles, pyramid, windows; // of planes
} refine_shapes;

static refine_shapes shapes_of(const struct refine_args *args)
{
    const uint32_t *n = args->cells;
    uint32_t below = 0;
    for (uint32_t level = 1; level < REFINE_LEVELS; level++) {
        below += over(n[1], 1u << level);
    }
    const tyn_extent pyramid = {n[0] + over(n[0], 2), n[1] > below ? n[1] : below, 1};
    return (refine_shapes){
        .cells = {n[0], n[1], 1},
        .tiles = {over(n[0], REFINE_TILE), over(n[1], REFINE_TILE), 1},
        .pyramid = pyramid,
        .windows = {pyramid.x + n[0], pyramid.y, 1},
    };
}

static struct refine_args args_of(const tyn_refine_params *p)
{
    const uint32_t grid = (uint32_t)p->grid;
    struct refine_args args = {
        .picture = {p->picture[0], p->picture[1]},
        .grid = grid,
        .margin = p->margin,
        .noise = p->noise,
        .known = p->known,
        .carried = p->begins,
        .unfinished = p->unfinished,
        .lo = {p->lo[0], p->lo[1], p->lo[2]},
        .hi = {p->hi[0], p->hi[1], p->hi[2]},
    };
    for (int a = 0; a < 2; a++) {
        args.samples[a] = p->known > 0 ? 1 : over(p->picture[a], grid);
        args.cells[a] = over(args.samples[a], 2);
    }
    const tyn_extent tiles = shapes_of(&args).tiles;
    args.groups = tiles.x * tiles.y;
    return args;
}

// An image of `count` planes, `row` of them side by side.
static tyn_extent planes(tyn_extent one, uint32_t count, uint32_t row)
{
    return (tyn_extent){one.x * row, one.y * over(count, row), 1};
}

tyn_extent tyn_refine_kept(const tyn_refine_params *params)
{
    const struct refine_args args = args_of(params);
    const tyn_extent one = {args.cells[0], args.cells[1], 1}, none = {1, 1, 1};
    return params->carry ? planes(one, REFINE_PARTS, REFINE_CELLS_ROW) : none;
}

uint32_t tyn_refine_side(const tyn_refine_params *params)
{
    const struct refine_args args = args_of(params);
    const refine_shapes s = shapes_of(&args);
    const tyn_extent all[] = {
        planes(s.cells, REFINE_CELLS, REFINE_CELLS_ROW),
        planes(s.pyramid, REFINE_MOMENTS, REFINE_MOMENTS_ROW),
        planes(s.windows, REFINE_COEFFICIENTS, REFINE_COEFFICIENTS_ROW),
    };
    uint32_t side = 0;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        side = all[i].x > side ? all[i].x : side;
        side = all[i].y > side ? all[i].y : side;
    }
    return side;
}

// Samples of single pixels may be blended in.
static bool is_blended(const tyn_refine_params *p, bool noise)
{
    return noise && p->grid == 1;
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_refine_params *p = params;
    const struct refine_args args = args_of(p);
    const refine_shapes s = shapes_of(&args);
    const uint64_t tiles = (uint64_t)s.tiles.x * s.tiles.y;
    const tyn_extent pixels = {p->picture[0], p->picture[1], 1}, none = {1, 1, 1};
    tyn_build_image(b, REFINE_PORT_RADIANCE, pixels, 1);
    tyn_build_image(b, REFINE_PORT_ERROR, pixels, 1);
    tyn_build_image(b, REFINE_PORT_BIAS, pixels, 1);
    tyn_build_image(b, REFINE_PORT_ERRORS, s.tiles, 1);
    tyn_build_image(b, REFINE_PORT_CELLS, planes(s.cells, REFINE_CELLS, REFINE_CELLS_ROW), 1);
    tyn_build_image(b, REFINE_PORT_MOMENTS, planes(s.pyramid, REFINE_MOMENTS, REFINE_MOMENTS_ROW),
                    1);
    tyn_build_image(b, REFINE_PORT_COEFFICIENTS,
                    planes(s.windows, REFINE_COEFFICIENTS, REFINE_COEFFICIENTS_ROW), 1);
    tyn_build_image(b, REFINE_PORT_FINAL, (tyn_extent){REFINE_FINAL * s.cells.x, s.cells.y, 1}, 1);
    const bool blended = is_blended(p, tyn_build_has(b, REFINE_PORT_NOISE));
    const tyn_extent fitted = blended ? pixels : none;
    tyn_build_image(b, REFINE_PORT_FITTED, fitted, 1);
    tyn_build_buffer(b, REFINE_PORT_RESIDUALS,
                     sizeof(struct refine_residuals) * (uint64_t)over(fitted.x, 8) *
                         over(fitted.y, 8));
    tyn_build_buffer(b, REFINE_PORT_TILES, tiles * REFINE_CANDIDATES * sizeof(float));
    tyn_build_buffer(b, REFINE_PORT_CHOICES, tiles * sizeof(uint32_t));
    tyn_build_buffer(b, REFINE_PORT_CHANGES, tiles * sizeof(struct refine_changes));
    tyn_build_buffer(b, REFINE_PORT_SUMS, tiles * sizeof(struct refine_sums));
    tyn_build_buffer(b, REFINE_PORT_TOTALS, sizeof(struct refine_totals));
    return TYN_OK;
}

// Of a picture that nobody looks at one group: a record's dispatches are the same whatever its params are.
static tyn_extent threads(const tyn_refine_params *p, uint32_t x, uint32_t y)
{
    return p->unfinished ? (tyn_extent){1, 1, 1} : (tyn_extent){x, y, 1};
}

static void record_fit(tyn_recorder *r, const tyn_refine_params *p, struct refine_args args)
{
    const refine_shapes s = shapes_of(&args);
    const tyn_extent cells = threads(p, s.cells.x, s.cells.y);
    const tyn_extent tiles = threads(p, s.tiles.x, s.tiles.y);
    TYN_DISPATCH(r, .kernel = KERNEL_CELLS, .cells = cells, .args = &args);
    TYN_DISPATCH(r, .kernel = KERNEL_MEAN, .cells = threads(p, 256, 1), .args = &args);
    if (p->carry) {
        const tyn_extent all = p->begins ? s.cells : (tyn_extent){1, 1, 1};
        TYN_DISPATCH(r, .kernel = KERNEL_CARRY, .cells = all, .args = &args);
        TYN_DISPATCH(r, .kernel = KERNEL_CHANGE, .cells = cells, .args = &args);
        TYN_DISPATCH(r, .kernel = KERNEL_RENEW, .cells = cells, .args = &args);
    }
    tyn_rec_clear(r, REFINE_PORT_MOMENTS); // what lies beside a level is read with a weight of 0
    TYN_DISPATCH(r, .kernel = KERNEL_MOMENTS, .cells = cells, .args = &args);
    for (args.level = 3; args.level + 1 < REFINE_LEVELS; args.level += 3) {
        const tyn_extent texels = threads(p, over(args.cells[0], 1u << args.level),
                                          over(args.cells[1], 1u << args.level));
        TYN_DISPATCH(r, .kernel = KERNEL_COARSER, .cells = texels, .args = &args);
    }
    TYN_DISPATCH(r, .kernel = KERNEL_SOLVE, .cells = threads(p, s.windows.x, s.windows.y),
                 .args = &args);
    TYN_DISPATCH(r, .kernel = KERNEL_JUDGE, .cells = cells, .args = &args);
    TYN_DISPATCH(r, .kernel = KERNEL_CHOOSE, .cells = tiles, .args = &args);
    TYN_DISPATCH(r, .kernel = KERNEL_COMBINE, .cells = cells, .args = &args);
    TYN_DISPATCH(r, .kernel = KERNEL_SHRINK, .cells = threads(p, 64, 1), .args = &args);
    TYN_DISPATCH(r, .kernel = KERNEL_ERRORS, .cells = tiles, .args = &args);
    tyn_rec_work(r, "cells", p->unfinished ? 0 : (double)s.cells.x * s.cells.y);
}

// Nothing changes.
static void record_no_fit(tyn_recorder *r)
{
    tyn_rec_clear(r, REFINE_PORT_FINAL);
    tyn_rec_clear(r, REFINE_PORT_ERRORS);
    tyn_rec_fill(r, REFINE_PORT_TOTALS, 0);
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_refine_params *p = params;
    const struct refine_args args = args_of(p);
    const tyn_extent pixels = threads(p, p->picture[0], p->picture[1]);
    if (tyn_rec_has(r, REFINE_PORT_SAMPLES)) {
        record_fit(r, p, args);
    } else {
        record_no_fit(r);
    }
    const bool blended = is_blended(p, tyn_rec_has(r, REFINE_PORT_NOISE));
    static const uint8_t into[][2] = {{REFINE_PORT_RADIANCE, REFINE_PORT_FITTED}};
    uint8_t ports_of_fit[TYN_MAX_BINDINGS];
    TYN_DISPATCH(r, .kernel = KERNEL_APPLY, .cells = pixels, .args = &args,
                 .ports = blended
                              ? tyn_ports_exchanged(&kernels[KERNEL_APPLY], into, 1, ports_of_fit)
                              : NULL);
    if (blended) {
        TYN_DISPATCH(r, .kernel = KERNEL_RESIDUAL, .cells = pixels, .args = &args);
        TYN_DISPATCH(r, .kernel = KERNEL_LEVEL, .cells = threads(p, 64, 1), .args = &args);
        TYN_DISPATCH(r, .kernel = KERNEL_BLEND, .cells = pixels, .args = &args);
    }
}

static const tyn_param param_table[] = {
    {"grid", TYN_PARAM_INT, offsetof(tyn_refine_params, grid), 1, 1, 16, "pixels",
     "along a side of the square that a sample is of: 4 with 8 samples are half a sample a pixel",
     NULL},
    {"margin", TYN_PARAM_FLOAT, offsetof(tyn_refine_params, margin), 2.5, 0, 16, "standard errors",
     "of what the parts confirm, below which the picture is left as it is", NULL},
    {"noise", TYN_PARAM_FLOAT, offsetof(tyn_refine_params, noise), 1.2, 1, 100, "",
     "what of the samples' own variance must be exceeded before pixels come nearer to samples",
     NULL},
    {"bias", TYN_PARAM_FLOAT, offsetof(tyn_refine_params, bias), 0.03, 0, 1, "of the light",
     "that may be taken from pop: paths end in its field in deep media without surfaces (from "
     "0.03 on), and there are none where next to nothing scatters (from 0.0075 on)",
     NULL},
    {"carry", TYN_PARAM_BOOL, offsetof(tyn_refine_params, carry), 1, 0, 1, "",
     "what the samples of earlier pictures said of pop is carried over to the next", NULL},
    {"depth", TYN_PARAM_INT, offsetof(tyn_refine_params, depth), 0, 0, 1024, "scatterings",
     "after which they do; 0: by the largest mean cosine g, 1.4 / (1 - g), 8 at least; above 64 "
     "they do not",
     NULL},
};

const tyn_pass_desc tyn_pass_refine = {
    .name = "refine",
    .summary = "a picture corrected by samples of the truth, fitted on its layers",
    TYN_PASS_TABLES(tyn_refine_params),
    TYN_SETTINGS(param_table),
    .of_pixels = true,
    .debug_port = REFINE_PORT_RADIANCE,
    .debug_meaning = "refined radiance",
    TYN_COUNTS(REFINE_PORT_COUNTERS, struct counters_block, TYN_COUNTER_NON_FINITE,
               {"clamped", offsetof(struct counters_block, clamped)}),
};
