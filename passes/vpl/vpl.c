// vpl.c -- see vpl.h.
#include "vpl.h"
#include "vpl_args.h"
#include "vpl_distances.comp.h"
#include "vpl_lights.comp.h"

#include "vpl_strata.comp.h"
#include "vpl_weights.comp.h"
#include "radial_args.h"
#include "scene_args.h"
#include <string.h>

#define PORT(name) VPL_PORT_##name

static const tyn_port ports[VPL_NUM_PORTS] = {
    [PORT(MEDIUM)] = {"medium", TYN_IN, TYN_BUFFER, .meaning = "struct medium_block"},
    [PORT(DENSITY)] = {"density", TYN_IN, TYN_IMAGE_3D, .optional = true,
                       .meaning = "density, or sigma_s in 1/m"},
    [PORT(SIGMA_A)] = {"sigma_a", TYN_IN, TYN_IMAGE_3D, .optional = true,
                       .meaning = "of unequal media, 1/m"},
    [PORT(G)] = {"g", TYN_IN, TYN_IMAGE_3D, .optional = true, .meaning = "of unequal media"},
    [PORT(SUNS)] = {"suns", TYN_IN, TYN_BUFFER, .meaning = "struct light_block[]"},
    [PORT(LIGHTS)] = {"lights", TYN_IN, TYN_BUFFER, .meaning = "struct light_block[]"},
    [PORT(FLUX)] = {"rsm_flux", TYN_IN, TYN_IMAGE_2D, .optional = true,
                    .meaning = "power that surfaces reflect, W a texel"},
    [PORT(POSITION)] = {"rsm_position", TYN_IN, TYN_IMAGE_2D, .optional = true,
                        .meaning = "where (M, m), and the area in a texel, m^2"},
    [PORT(NORMAL)] = {"rsm_normal", TYN_IN, TYN_IMAGE_2D, .optional = true,
                      .meaning = "normal (M), on the side of the light"},
    [PORT(SURFACES)] = {"surfaces", TYN_IN, TYN_BUFFER, .optional = true,
                        .meaning = "struct surface_block"},
    [PORT(VERTICES)] = {"vertices", TYN_IN, TYN_BUFFER, .optional = true,
                        .meaning = "struct surface_vertex[]"},
    [PORT(TRIANGLES)] = {"triangles", TYN_IN, TYN_BUFFER, .optional = true,
                         .meaning = "struct surface_triangle[]"},
    [PORT(MATERIALS)] = {"materials", TYN_IN, TYN_BUFFER, .optional = true,
                         .meaning = "struct surface_material[]"},
    [PORT(NODES)] = {"nodes", TYN_IN, TYN_BUFFER, .optional = true,
                     .meaning = "struct surface_node[]"},
    [PORT(VPLS)] = {"vpls", TYN_OUT, TYN_BUFFER, .meaning = "struct radial_vpls"},
    [PORT(DISTANCES)] = {"vpl_distances", TYN_OUT, TYN_IMAGE_2D, VK_FORMAT_R32_SFLOAT,
                         .meaning = "of the first surface in every direction of a VPL, m"},
    [PORT(PLAN)] = {"plan", TYN_SCRATCH, TYN_BUFFER, .meaning = "struct vpl_plan"},
    [PORT(WEIGHTS)] = {"weights", TYN_SCRATCH, TYN_BUFFER, .meaning = "float[], of elements"},
    [PORT(BLOCKS)] = {"blocks", TYN_SCRATCH, TYN_BUFFER, .meaning = "float[], of their blocks"},
    [PORT(STRATA)] = {"strata", TYN_SCRATCH, TYN_BUFFER, .meaning = "struct vpl_stratum[]"},
};

#define ELEMENT_BINDINGS                                                                           \
    {PORT(PLAN), TYN_USE_STORAGE_READ}, {PORT(FLUX), TYN_USE_SAMPLED},                             \
        {PORT(POSITION), TYN_USE_SAMPLED}, {PORT(NORMAL), TYN_USE_SAMPLED},                        \
        {PORT(SURFACES), TYN_USE_UNIFORM}, {PORT(VERTICES), TYN_USE_STORAGE_READ},                 \
        {PORT(TRIANGLES), TYN_USE_STORAGE_READ},                                                   \
    {                                                                                              \
        PORT(MATERIALS), TYN_USE_STORAGE_READ                                                      \
    }

static const tyn_binding weights_bindings[] = {
    ELEMENT_BINDINGS,
    {PORT(WEIGHTS), TYN_USE_STORAGE_WRITE},
    {PORT(BLOCKS), TYN_USE_STORAGE_WRITE},
};
static const tyn_binding strata_bindings[] = {
    {PORT(PLAN), TYN_USE_STORAGE_READ},
    {PORT(BLOCKS), TYN_USE_STORAGE_RW},
    {PORT(STRATA), TYN_USE_STORAGE_WRITE},
    {PORT(VPLS), TYN_USE_STORAGE_WRITE},
};
static const tyn_binding lights_bindings[] = {
    ELEMENT_BINDINGS,
    {PORT(MEDIUM), TYN_USE_UNIFORM},
    {PORT(DENSITY), TYN_USE_SAMPLED},
    {PORT(SIGMA_A), TYN_USE_SAMPLED},
    {PORT(G), TYN_USE_SAMPLED},
    {PORT(WEIGHTS), TYN_USE_STORAGE_READ},
    {PORT(BLOCKS), TYN_USE_STORAGE_READ},
    {PORT(STRATA), TYN_USE_STORAGE_READ},
    {PORT(SUNS), TYN_USE_UNIFORM},
    {PORT(LIGHTS), TYN_USE_UNIFORM},
    {PORT(VPLS), TYN_USE_STORAGE_RW},
};

static const tyn_binding distances_bindings[] = {
    {PORT(SURFACES), TYN_USE_UNIFORM},       {PORT(VERTICES), TYN_USE_STORAGE_READ},
    {PORT(TRIANGLES), TYN_USE_STORAGE_READ}, {PORT(NODES), TYN_USE_STORAGE_READ},
    {PORT(VPLS), TYN_USE_STORAGE_READ},      {PORT(DISTANCES), TYN_USE_STORAGE_WRITE},
};

enum { WEIGHTS = 0, STRATA, LIGHTS, DISTANCES, NUM_KERNELS };

#define KERNEL(step, x, y, args, specs)                                                            \
    .name = "vpl_" #step, .spirv = vpl_##step##_spirv, .spirv_size = sizeof vpl_##step##_spirv,    \
    .args_size = args, .local_size = {x, y, 1}, .bindings = step##_bindings,                       \
    .num_bindings = sizeof step##_bindings / sizeof *step##_bindings, .num_spec = specs

static const tyn_kernel kernels[NUM_KERNELS] = {
    [WEIGHTS] = {KERNEL(weights, VPL_BLOCK, 1, 0, 0)},
    [STRATA] = {KERNEL(strata, VPL_BLOCK, 1, sizeof(struct vpl_args), 0)},
    [LIGHTS] = {KERNEL(lights, VPL_BLOCK, 1, sizeof(struct vpl_args), 1)},
    [DISTANCES] = {KERNEL(distances, 8, 8, 0, 0)},
};

static const tyn_param params[] = {
    {"count", TYN_PARAM_INT, offsetof(tyn_vpl_params, count), 128, 0, TYN_RADIAL_VPLS_MAX, "",
     "lights at most that stand for what surfaces reflect first and emit"},
    {"visibility", TYN_PARAM_INT, offsetof(tyn_vpl_params, visibility), 16, 0, 64, "texels",
     "along each side of the maps of what these lights see of the surfaces; 0 = all is lit"},
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

static tyn_result declare(tyn_builder *b, const void *data)
{
    const uint64_t blocks = make_plan(data, NULL);
    tyn_build_buffer(b, PORT(VPLS), sizeof(struct radial_vpls));
    tyn_build_image(b, PORT(DISTANCES), atlas_size(data, tyn_build_has(b, PORT(TRIANGLES))), 1);
    tyn_build_buffer(b, PORT(PLAN), sizeof(struct vpl_plan));
    tyn_build_buffer(b, PORT(WEIGHTS), (blocks + 1) * VPL_BLOCK * sizeof(float));
    tyn_build_buffer(b, PORT(BLOCKS), (blocks + 1) * sizeof(float));
    tyn_build_buffer(b, PORT(STRATA), TYN_RADIAL_VPLS_MAX * sizeof(struct vpl_stratum));
    return TYN_OK;
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
    const struct vpl_args args = {(uint32_t)p->count, p->num_suns, tyn_rec_has(r, PORT(DENSITY))};
    tyn_rec_update(r, PORT(PLAN), 0, &plan, sizeof plan);
    tyn_rec_dispatch(
        r, &(tyn_dispatch){.kernel = WEIGHTS, .cells = {plan.num_blocks * VPL_BLOCK, 1, 1}});
    tyn_rec_dispatch(r,
                     &(tyn_dispatch){.kernel = STRATA, .cells = {VPL_BLOCK, 1, 1}, .args = &args});
    tyn_rec_dispatch(r, &(tyn_dispatch){.kernel = LIGHTS,
                                        .cells = {args.count * VPL_BLOCK, 1, 1},
                                        .args = &args,
                                        .spec = &p->mode});
    const bool triangles = tyn_rec_has(r, PORT(TRIANGLES));
    if (map_side(p, triangles)) {
        tyn_rec_dispatch(
            r, &(tyn_dispatch){.kernel = DISTANCES, .cells = tyn_rec_extent(r, PORT(DISTANCES))});
        tyn_rec_work(r, "rays", (double)args.count * p->visibility * p->visibility);
    }
    tyn_rec_work(r, "elements", (double)plan.num_blocks * VPL_BLOCK);
    tyn_rec_work(r, "vpls", args.count);
}

const tyn_pass_desc tyn_pass_vpl = {
    .name = "vpl",
    .summary = "what surfaces reflect first and emit, as virtual point lights (Keller 1997)",
    .ports = ports,
    .num_ports = VPL_NUM_PORTS,
    .kernels = kernels,
    .num_kernels = NUM_KERNELS,
    .params = params,
    .num_params = sizeof params / sizeof *params,
    .params_size = sizeof(tyn_vpl_params),
    .declare = declare,
    .record = record,
    .debug_port = PORT(DISTANCES),
    .debug_meaning = "what each light sees: distances of surfaces",
};
