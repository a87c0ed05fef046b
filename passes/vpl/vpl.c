// vpl.c -- see vpl.h.
#include "vpl.h"
#include "vpl_args.h"
#include "passes/vpl_tables.h"
#include "vpl_bounce_args.h"

#include "shaders/beams/radial_args.h"
#include "shaders/common/scene_args.h"
#include <math.h>
#include <string.h>

#define PORT(name) VPL_PORT_##name

static const tyn_param params[] = {
    {"count", TYN_PARAM_INT, offsetof(tyn_vpl_params, count), 192, 0, TYN_RADIAL_VPLS_MAX, "",
     "lights at most that stand for what surfaces emit and reflect; 0 = they light nothing, 1 = "
     "nothing is reflected twice"},
    {"visibility", TYN_PARAM_INT, offsetof(tyn_vpl_params, visibility), 16, 0, 64, "texels",
     "along each side of the maps of what these lights see of the surfaces; 0 = all is lit; "
     "below 2 nothing is reflected twice"},
};

// Texels along each side of a map of distances; 0: none.
static uint32_t map_side(const tyn_vpl_params *p, bool triangles)
{
    return triangles && p->visibility >= 2 ? (uint32_t)p->visibility : 0;
}

static tyn_extent atlas_size(const tyn_vpl_params *p, bool triangles)
{
    const uint32_t side = map_side(p, triangles), in_a_row = 16;
    const uint32_t rows = ((uint32_t)p->count + in_a_row - 1) / in_a_row;
    return side && rows ? (tyn_extent){in_a_row * side, rows * side, 1} : (tyn_extent){1, 1, 1};
}

// ---- the plan -----------------------------------------------------------------------------------

// `plan` may be NULL. Gives the number of blocks.
static uint32_t make_plan(const tyn_vpl_params *p, struct vpl_plan *plan)
{
    uint32_t blocks = 0, sources = 0;
    for (uint32_t i = 0; i < p->num_tiles; i++) {
        const struct rsm_tile *map = &p->tiles[i];
        if (plan) {
            plan->tiles[i] = (struct vpl_tile){*map, blocks};
            if (i == 0 || map->light != p->tiles[i - 1].light) {
                plan->sources[sources++] = blocks;
            }
        }
        blocks += map->texels * map->texels / VPL_BLOCK;
    }
    const uint32_t mesh = (p->num_triangles + VPL_BLOCK - 1) / VPL_BLOCK;
    uint32_t first[2] = {blocks, blocks}; // of fronts and of backs
    for (uint32_t side = 0; side < 2; side++) {
        first[side] = blocks;
        if (side < p->emitters) {
            if (plan) {
                plan->sources[sources++] = blocks;
            }
            blocks += mesh;
        }
    }
    if (plan) {
        plan->front = first[0];
        plan->back = first[1];
        plan->num_blocks = blocks;
        plan->num_tiles = p->num_tiles;
        plan->num_sources = sources;
        plan->num_triangles = p->num_triangles;
    }
    return blocks;
}

static bool bounces(const tyn_vpl_params *p, bool triangles)
{
    return p->count >= 2 && map_side(p, triangles);
}

// Solid angle of a texel in the middle of a map: so that the power of all directions is the VPL's.
static float texel_solid_angle(uint32_t side)
{
    double sum = 0;
    for (uint32_t i = 0; i < side * side; i++) {
        const uint32_t x = i % side, y = i / side;
        const double u = 2.0 * x / (side - 1) - 1, v = 2.0 * y / (side - 1) - 1;
        const double p[2] = {0.5 * (u + v), 0.5 * (u - v)}, z = 1 - fabs(p[0]) - fabs(p[1]);
        const double away2 = p[0] * p[0] + p[1] * p[1] + z * z;
        const double whole = (x % (side - 1) ? 1 : 0.5) * (y % (side - 1) ? 1 : 0.5);
        sum += whole * z / (away2 * away2);
    }
    return (float)(3.14159265358979 / sum);
}

static tyn_result declare(tyn_builder *b, const void *data)
{
    const tyn_vpl_params *p = data;
    const bool triangles = tyn_build_has(b, PORT(TRIANGLES)), again = bounces(p, triangles);
    uint64_t blocks = make_plan(p, NULL);
    blocks = blocks > VPL_BINS / VPL_BLOCK ? blocks : VPL_BINS / VPL_BLOCK;
    const tyn_extent atlas = atlas_size(p, triangles), texel = {1, 1, 1};
    const tyn_extent bins = again ? (tyn_extent){VPL_BIN_SIDE, VPL_BIN_SIDE, 1} : texel;
    tyn_build_buffer(b, PORT(VPLS), sizeof(struct radial_vpls));
    tyn_build_image(b, PORT(VPL_DISTANCES), atlas, 1);
    tyn_build_image(b, PORT(VPL_PLANES), atlas, 1);
    tyn_build_buffer(b, PORT(PLAN), sizeof(struct vpl_plan));
    tyn_build_buffer(b, PORT(WEIGHTS), (blocks + 1) * VPL_BLOCK * sizeof(float));
    tyn_build_buffer(b, PORT(BLOCKS), (blocks + 1) * sizeof(float));
    tyn_build_buffer(b, PORT(STRATA), TYN_RADIAL_VPLS_MAX * sizeof(struct vpl_stratum));
    tyn_build_buffer(b, PORT(BINS), sizeof(struct vpl_bins));
    tyn_build_image(b, PORT(BIN_FLUX), bins, 1);
    tyn_build_image(b, PORT(BIN_POSITION), bins, 1);
    tyn_build_image(b, PORT(BIN_NORMAL), bins, 1);
    return TYN_OK;
}

// At most `args->count` VPLs of the elements of a plan: of the reflective shadow maps, or of bins.
static void make_lights(tyn_recorder *r, const struct vpl_plan *plan, const struct vpl_args *args,
                        bool of_bins, uint32_t mode)
{
    static const uint8_t bins[][2] = {{PORT(RSM_FLUX), PORT(BIN_FLUX)},
                                      {PORT(RSM_POSITION), PORT(BIN_POSITION)},
                                      {PORT(RSM_NORMAL), PORT(BIN_NORMAL)}};
    const uint32_t exchanged = of_bins ? TYN_COUNT(bins) : 0;
    uint8_t weights[TYN_MAX_BINDINGS], lights[TYN_MAX_BINDINGS];
    tyn_rec_update(r, PORT(PLAN), 0, plan, sizeof *plan);
    TYN_DISPATCH(r, .kernel = KERNEL_WEIGHTS, .cells = {plan->num_blocks * VPL_LANES, 1, 1},
                 .args = args,
                 .ports = tyn_ports_exchanged(&kernels[KERNEL_WEIGHTS], bins, exchanged, weights));
    TYN_DISPATCH(r, .kernel = KERNEL_STRATA, .cells = {VPL_BLOCK, 1, 1}, .args = args);
    TYN_DISPATCH(r, .kernel = KERNEL_LIGHTS, .cells = {args->count * VPL_LANES, 1, 1}, .args = args,
                 .ports = tyn_ports_exchanged(&kernels[KERNEL_LIGHTS], bins, exchanged, lights),
                 .spec = &mode);
    tyn_rec_work(r, "elements", (double)plan->num_blocks * VPL_BLOCK);
}

// What the maps of distances put into bins starts from nothing, in units of the power of all VPLs.
static void count_reflections(tyn_recorder *r)
{
    tyn_rec_fill(r, PORT(BINS), 0);
    TYN_DISPATCH(r, .kernel = KERNEL_POWER, .cells = {TYN_RADIAL_VPLS_MAX, 1, 1});
}

static void record(tyn_recorder *r, const void *data)
{
    const tyn_vpl_params *p = data;
    struct vpl_plan plan = {0};
    make_plan(p, &plan);
    if (plan.num_blocks == 0 || p->count == 0) {
        tyn_rec_fill(r, PORT(VPLS), 0);
        return;
    }
    const bool triangles = tyn_rec_has(r, PORT(TRIANGLES)), again = bounces(p, triangles);
    const uint32_t side = map_side(p, triangles), media = tyn_rec_has(r, PORT(DENSITY));
    const uint32_t later =
        again ? (3 * (uint32_t)p->count + 7) / 8 : 0; // VPLs of further reflections
    struct vpl_args args = {(uint32_t)p->count - later, p->num_suns, media, 0};
    memcpy(args.near_lo, p->near_lo, sizeof args.near_lo);
    memcpy(args.near_hi, p->near_hi, sizeof args.near_hi);
    args.sky_irradiance = p->sky_irradiance;
    struct vpl_distances_args maps = {0, again, side ? texel_solid_angle(side) : 0, media};
    const tyn_dispatch see = {.kernel = KERNEL_DISTANCES,
                              .cells = tyn_rec_extent(r, PORT(VPL_DISTANCES)),
                              .args = &maps,
                              .spec = &p->mode};
    make_lights(r, &plan, &args, false, p->mode);
    if (again) {
        count_reflections(r);
    }
    if (side) {
        tyn_rec_dispatch(r, &see);
    }
    if (again) {
        struct vpl_args added = args;
        added.count = later;
        added.media = 0;
        memset(&plan, 0, sizeof plan);
        plan.num_blocks = plan.front = plan.back = VPL_BINS / VPL_BLOCK;
        plan.num_tiles = plan.num_sources = 1;
        plan.tiles[0].map.texels = VPL_BIN_SIDE;
        maps.later = 1;
        for (uint32_t i = 0; i < 2; i++) {
            const struct vpl_bounce_args of = {i};
            added.append = 1 + i;
            TYN_DISPATCH(r, .kernel = KERNEL_BOUNCE, .cells = {VPL_BLOCK, 1, 1}, .args = &of);
            make_lights(r, &plan, &added, true, p->mode);
            count_reflections(r);
            tyn_rec_dispatch(r, &see);
        }
        TYN_DISPATCH(r, .kernel = KERNEL_FURTHER, .cells = {TYN_RADIAL_VPLS_MAX, 1, 1});
    }
    // Those of further reflections stand in two places, one after the other.
    tyn_rec_work(r, "rays", ((double)p->count + later) * side * side);
    tyn_rec_work(r, "vpls", p->count);
}

const tyn_pass_desc tyn_pass_vpl = {
    .name = "vpl",
    .summary = "what surfaces emit and reflect, as virtual point lights (Keller 1997)",
    .serves = "surfaces that emit or are shone on, with virtual point lights (vpl.count)",
    TYN_PASS_TABLES(tyn_vpl_params),
    TYN_SETTINGS(params),
    .debug_port = PORT(VPL_DISTANCES),
    .debug_meaning = "what each light sees: distances of surfaces",
};
