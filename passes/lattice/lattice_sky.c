// lattice_sky.c -- the environment as the lattice sees it.
#include "lattice.h"
#include "lattice_args.h"
#include "lattice_sky.comp.h"
#include "lattice_sky_scale.comp.h"

static const tyn_port ports[LATTICE_SKY_NUM_PORTS] = {
    [LATTICE_SKY_PORT_ENVIRONMENT] = {"environment", TYN_IN, TYN_BUFFER, 0, false,
                                      "struct env_block"},
    [LATTICE_SKY_PORT_ENV_MAP] = {"env_map", TYN_IN, TYN_IMAGE_2D, 0, true,
                                  "latitude-longitude map"},
    [LATTICE_SKY_PORT_SKY] = {"sky", TYN_OUT, TYN_BUFFER, 0, false,
                              "radiance that enters along each of the 14 directions, W/(m^2 sr)"},
};

enum { KERNEL_LOBES, KERNEL_SCALE, NUM_KERNELS };

static const tyn_binding lobes_bindings[] = {
    {LATTICE_SKY_PORT_ENVIRONMENT, TYN_USE_UNIFORM},
    {LATTICE_SKY_PORT_ENV_MAP, TYN_USE_SAMPLED, true},
    {LATTICE_SKY_PORT_SKY, TYN_USE_STORAGE_WRITE},
};
static const tyn_binding scale_bindings[] = {
    {LATTICE_SKY_PORT_ENVIRONMENT, TYN_USE_UNIFORM},
    {LATTICE_SKY_PORT_SKY, TYN_USE_STORAGE_RW},
};

static const tyn_kernel kernels[NUM_KERNELS] = {
    [KERNEL_LOBES] = {"lobes",
                      lattice_sky_spirv,
                      sizeof lattice_sky_spirv,
                      0,
                      {LATTICE_SKY_GROUP, 1, 1},
                      lobes_bindings,
                      3,
                      0},
    [KERNEL_SCALE] = {"scale",
                      lattice_sky_scale_spirv,
                      sizeof lattice_sky_scale_spirv,
                      0,
                      {16, 1, 1},
                      scale_bindings,
                      2,
                      0},
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_buffer(b, LATTICE_SKY_PORT_SKY, LATTICE_DIRECTIONS * 3 * sizeof(float));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    (void)params;
    tyn_extent map = tyn_rec_extent(r, LATTICE_SKY_PORT_ENV_MAP);
    tyn_rec_dispatch(r, &(tyn_dispatch){.kernel = KERNEL_LOBES,
                                        .cells = {LATTICE_DIRECTIONS * LATTICE_SKY_GROUP, 1, 1}});
    tyn_rec_dispatch(r, &(tyn_dispatch){.kernel = KERNEL_SCALE, .cells = {16, 1, 1}});
    tyn_rec_work(r, "fetches", LATTICE_DIRECTIONS * 0.25 * map.x * map.y);
}

const tyn_pass_desc tyn_pass_lattice_sky = {
    .name = "lattice_sky",
    .summary = "the environment along the directions of the lattice",
    .ports = ports,
    .num_ports = LATTICE_SKY_NUM_PORTS,
    .kernels = kernels,
    .num_kernels = NUM_KERNELS,
    .params_size = sizeof(tyn_lattice_sky_params),
    .declare = declare,
    .record = record,
    .debug_port = LATTICE_SKY_PORT_SKY,
    .debug_meaning = "radiance that enters along each of the 14 directions",
};
