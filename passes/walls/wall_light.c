// wall_light.c -- light of suns and virtual point lights on the walls of the lattice.
#include "walls.h"
#include "wall_light_args.h"
#include "wall_light_cells.comp.h"
#include "wall_light_suns.comp.h"
#include "wall_light_vpls.comp.h"

static const tyn_port ports[WALL_LIGHT_NUM_PORTS] = {
    [WALL_LIGHT_PORT_MEDIUM] = {"medium", TYN_IN, TYN_BUFFER, 0, false, "struct medium_block"},
    [WALL_LIGHT_PORT_LIGHTS] = {"lights", TYN_IN, TYN_BUFFER, 0, false, "struct light_block[]"},
    [WALL_LIGHT_PORT_BEAMS] = {"beams", TYN_IN, TYN_BUFFER, 0, true, "struct beam_block[]"},
    [WALL_LIGHT_PORT_COLUMN] = {"column", TYN_IN, TYN_IMAGE_3D, 0, true,
                                "depth along the suns, or that of sigma_s"},
    [WALL_LIGHT_PORT_TAU_A] = {"tau_a", TYN_IN, TYN_IMAGE_3D, 0, true, "of absorption"},
    [WALL_LIGHT_PORT_TAU_P] = {"tau_p", TYN_IN, TYN_IMAGE_3D, 0, true, "of sigma_s'"},
    [WALL_LIGHT_PORT_RADIALS] = {"radials", TYN_IN, TYN_BUFFER, 0, true, "struct radial_block"},
    [WALL_LIGHT_PORT_RADIAL_COLUMN] = {"radial_column", TYN_IN, TYN_IMAGE_3D, 0, true,
                                       "depth along them, or that of sigma_s"},
    [WALL_LIGHT_PORT_RADIAL_TAU_A] = {"radial_tau_a", TYN_IN, TYN_IMAGE_3D, 0, true,
                                      "of absorption"},
    [WALL_LIGHT_PORT_RADIAL_TAU_P] = {"radial_tau_p", TYN_IN, TYN_IMAGE_3D, 0, true, "of sigma_s'"},
    [WALL_LIGHT_PORT_SURFACES] = {"surfaces", TYN_IN, TYN_BUFFER, 0, false, "struct surface_block"},
    [WALL_LIGHT_PORT_VERTICES] = {"vertices", TYN_IN, TYN_BUFFER, 0, false,
                                  "struct surface_vertex[]"},
    [WALL_LIGHT_PORT_TRIANGLES] = {"triangles", TYN_IN, TYN_BUFFER, 0, false,
                                   "struct surface_triangle[]"},
    [WALL_LIGHT_PORT_LINKS] = {"wall_links", TYN_IN, TYN_BUFFER, 0, false, "of walls"},
    [WALL_LIGHT_PORT_CELLS] = {"wall_cells", TYN_IN, TYN_BUFFER, 0, false, "of walls"},
    [WALL_LIGHT_PORT_HITS] = {"hits", TYN_IN, TYN_BUFFER, 0, false, "of walls"},
    [WALL_LIGHT_PORT_ROOMS] = {"rooms", TYN_IN, TYN_BUFFER, 0, true, "of rooms"},
    [WALL_LIGHT_PORT_LIGHT] = {"wall_light", TYN_OUT, TYN_BUFFER, 0, false,
                               "radiance that the walls of a cell send out, W/(m^2 sr)"},
    [WALL_LIGHT_PORT_LIST] = {"list", TYN_SCRATCH, TYN_BUFFER, 0, false,
                              "struct wall_light_list, uint[]: cells whose walls reflect"},
};

static const tyn_binding vpls_bindings[] = {
    {WALL_LIGHT_PORT_MEDIUM, TYN_USE_UNIFORM},
    {WALL_LIGHT_PORT_RADIALS, TYN_USE_UNIFORM},
    {WALL_LIGHT_PORT_RADIAL_COLUMN, TYN_USE_SAMPLED},
    {WALL_LIGHT_PORT_RADIAL_TAU_A, TYN_USE_SAMPLED},
    {WALL_LIGHT_PORT_RADIAL_TAU_P, TYN_USE_SAMPLED},
    {WALL_LIGHT_PORT_SURFACES, TYN_USE_UNIFORM},
    {WALL_LIGHT_PORT_VERTICES, TYN_USE_STORAGE_READ},
    {WALL_LIGHT_PORT_TRIANGLES, TYN_USE_STORAGE_READ},
    {WALL_LIGHT_PORT_LINKS, TYN_USE_STORAGE_READ},
    {WALL_LIGHT_PORT_CELLS, TYN_USE_STORAGE_READ},
    {WALL_LIGHT_PORT_HITS, TYN_USE_STORAGE_READ},
    {WALL_LIGHT_PORT_LIGHT, TYN_USE_STORAGE_RW},
    {WALL_LIGHT_PORT_LIST, TYN_USE_STORAGE_READ},
    {WALL_LIGHT_PORT_ROOMS, TYN_USE_TEXELS_UINT},
};

static const tyn_binding cells_bindings[] = {
    {WALL_LIGHT_PORT_CELLS, TYN_USE_STORAGE_READ},
    {WALL_LIGHT_PORT_LIST, TYN_USE_STORAGE_RW},
    {WALL_LIGHT_PORT_LIGHT, TYN_USE_STORAGE_WRITE},
    {WALL_LIGHT_PORT_LINKS, TYN_USE_STORAGE_READ},
};

static const tyn_binding suns_bindings[] = {
    {WALL_LIGHT_PORT_MEDIUM, TYN_USE_UNIFORM},
    {WALL_LIGHT_PORT_LIGHTS, TYN_USE_STORAGE_READ},
    {WALL_LIGHT_PORT_BEAMS, TYN_USE_STORAGE_READ},
    {WALL_LIGHT_PORT_COLUMN, TYN_USE_SAMPLED},
    {WALL_LIGHT_PORT_TAU_A, TYN_USE_SAMPLED},
    {WALL_LIGHT_PORT_TAU_P, TYN_USE_SAMPLED},
    {WALL_LIGHT_PORT_SURFACES, TYN_USE_UNIFORM},
    {WALL_LIGHT_PORT_VERTICES, TYN_USE_STORAGE_READ},
    {WALL_LIGHT_PORT_TRIANGLES, TYN_USE_STORAGE_READ},
    {WALL_LIGHT_PORT_LINKS, TYN_USE_STORAGE_READ},
    {WALL_LIGHT_PORT_CELLS, TYN_USE_STORAGE_READ},
    {WALL_LIGHT_PORT_HITS, TYN_USE_STORAGE_READ},
    {WALL_LIGHT_PORT_LIGHT, TYN_USE_STORAGE_WRITE},
};

enum { SUNS = 0, VPLS, WALL_CELLS, NUM_KERNELS };

#define KERNEL(step, x, y, z, specs)                                                               \
    .name = #step, .spirv = wall_light_##step##_spirv,                                             \
    .spirv_size = sizeof wall_light_##step##_spirv, .args_size = sizeof(struct wall_light_args),   \
    .local_size = {x, y, z}, .bindings = step##_bindings,                                          \
    .num_bindings = sizeof step##_bindings / sizeof *step##_bindings, .num_spec = specs
static const tyn_kernel kernels[NUM_KERNELS] = {
    [SUNS] = {KERNEL(suns, 8, 4, 2, 1)},
    [VPLS] = {KERNEL(vpls, WALL_LIGHT_GROUP, 1, 1, 3)},
    [WALL_CELLS] = {KERNEL(cells, WALL_LIGHT_GROUP, 1, 1, 1)},
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_wall_light_params *p = params;
    if (p->num_suns == 0 && !tyn_build_has(b, WALL_LIGHT_PORT_RADIALS)) {
        tyn_log_print(tyn_build_log(b), TYN_LOG_ERROR,
                      "pass 'wall_light': neither suns nor 'radials': nothing shines");
        return TYN_ERR_PARAMS;
    }
    const uint64_t cells = (uint64_t)p->dims[0] * p->dims[1] * p->dims[2];
    tyn_build_buffer(b, WALL_LIGHT_PORT_LIGHT, 12 * cells);
    const bool listed = tyn_build_has(b, WALL_LIGHT_PORT_RADIALS);
    tyn_build_buffer(b, WALL_LIGHT_PORT_LIST,
                     sizeof(struct wall_light_list) + (listed ? 8 * cells : 0));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_wall_light_params *p = params;
    struct wall_light_args args = {
        .extent = {p->extent[0], p->extent[1], p->extent[2]},
        .dims = {p->dims[0], p->dims[1], p->dims[2]},
        .num_suns = p->num_suns,
    };
    const tyn_extent cells = {p->dims[0], p->dims[1], p->dims[2]};
    if (p->num_suns > 0) {
        tyn_rec_dispatch(
            r, &(tyn_dispatch){.kernel = SUNS, .cells = cells, .args = &args, .spec = &p->mode});
    }
    if (tyn_rec_has(r, WALL_LIGHT_PORT_RADIALS)) {
        const uint32_t spec[3] = {p->mode, p->num_suns > 0, tyn_rec_has(r, WALL_LIGHT_PORT_ROOMS)};
        const tyn_extent all = {p->dims[0] * p->dims[1] * p->dims[2], 1, 1};
        tyn_rec_fill(r, WALL_LIGHT_PORT_LIST, 0);
        tyn_rec_dispatch(
            r,
            &(tyn_dispatch){.kernel = WALL_CELLS, .cells = all, .args = &args, .spec = spec + 1});
        tyn_rec_dispatch_indirect(r, &(tyn_dispatch){.kernel = VPLS, .args = &args, .spec = spec},
                                  WALL_LIGHT_PORT_LIST, 0);
    }
    tyn_rec_work(r, "cells", (double)p->dims[0] * p->dims[1] * p->dims[2]);
}

const tyn_pass_desc tyn_pass_wall_light = {
    .name = "wall_light",
    .summary = "light of suns and virtual point lights on the walls of the lattice's cells",
    .serves = "walls in media that suns shine on periodically, or virtual point lights without "
              "further reflections",
    .ports = ports,
    .num_ports = WALL_LIGHT_NUM_PORTS,
    .kernels = kernels,
    .num_kernels = NUM_KERNELS,
    .params_size = sizeof(tyn_wall_light_params),
    .declare = declare,
    .record = record,
    .debug_port = WALL_LIGHT_PORT_LIGHT,
    .debug_meaning = "radiance of the walls per cell, W/(m^2 sr)",
};
