// balance.c -- where the energy goes.
#include "probe.h"
#include "probe_args.h"
#include "balance.comp.h"

static const tyn_port ports[BALANCE_NUM_PORTS] = {
    [BALANCE_PORT_MEDIUM] = {"medium", TYN_IN, TYN_BUFFER, 0, false, "struct medium_block"},
    [BALANCE_PORT_LIGHTS] = {"lights", TYN_IN, TYN_BUFFER, 0, true, "struct light_block[]"},
    [BALANCE_PORT_CELLS] = {"cells", TYN_IN, TYN_IMAGE_3D, 0, false, "of lattice_cells"},
    [BALANCE_PORT_MOMENTS] = {"moments", TYN_IN, TYN_IMAGE_3D, 0, false, "of lattice"},
    [BALANCE_PORT_SOURCE] = {"source", TYN_IN, TYN_IMAGE_3D, 0, true, "of lattice_source"},
    [BALANCE_PORT_POWER] = {"power", TYN_IN, TYN_BUFFER, 0, true, "of lattice_source"},
    [BALANCE_PORT_LEAKS] = {"leaks", TYN_IN, TYN_BUFFER, 0, false, "of lattice"},
    [BALANCE_PORT_ENVIRONMENT] = {"environment", TYN_IN, TYN_BUFFER, 0, true,
                                  "struct env_block: its mean without suns enters at the box"},
    [BALANCE_PORT_ORDINATES] = {"ordinates", TYN_IN, TYN_BUFFER, 0, true, "struct ordinates_block"},
    [BALANCE_PORT_WALL_POWER] = {"wall_power", TYN_IN, TYN_BUFFER, 0, true, "of lattice"},
    [BALANCE_PORT_LAMP_POWER] = {"lamp_power", TYN_IN, TYN_BUFFER, 0, true, "of lattice_lamps"},
    [BALANCE_PORT_BALANCE] = {"balance", TYN_OUT, TYN_BUFFER, 0, false, "tyn_balance, W"},
};

static const tyn_binding bindings[] = {
    {BALANCE_PORT_MEDIUM, TYN_USE_UNIFORM},
    {BALANCE_PORT_ENVIRONMENT, TYN_USE_UNIFORM},
    {BALANCE_PORT_LIGHTS, TYN_USE_STORAGE_READ},
    {BALANCE_PORT_CELLS, TYN_USE_SAMPLED},
    {BALANCE_PORT_MOMENTS, TYN_USE_SAMPLED},
    {BALANCE_PORT_SOURCE, TYN_USE_SAMPLED},
    {BALANCE_PORT_POWER, TYN_USE_STORAGE_READ},
    {BALANCE_PORT_LEAKS, TYN_USE_STORAGE_READ},
    {BALANCE_PORT_BALANCE, TYN_USE_STORAGE_WRITE},
    {BALANCE_PORT_ORDINATES, TYN_USE_UNIFORM},
    {BALANCE_PORT_WALL_POWER, TYN_USE_STORAGE_READ},
    {BALANCE_PORT_LAMP_POWER, TYN_USE_STORAGE_READ},
};

static const tyn_kernel kernels[] = {
    {"balance",
     balance_spirv,
     sizeof balance_spirv,
     sizeof(struct balance_args),
     {BALANCE_GROUP, 1, 1},
     bindings,
     12,
     1},
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_buffer(b, BALANCE_PORT_BALANCE, 7 * 3 * sizeof(double)); // tyn_balance: seven triples
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_balance_params *p = params;
    struct balance_args args = {
        .tint = {p->tint[0], p->tint[1], p->tint[2]},
        .channels = p->channels,
        .num_suns = p->num_suns,
        .num_groups = p->num_groups,
        .num_leaks =
            tyn_rec_extent(r, BALANCE_PORT_LEAKS).x / (uint32_t)sizeof(float) / p->channels,
    };
    const uint32_t walls = tyn_rec_has(r, BALANCE_PORT_WALL_POWER);
    tyn_rec_dispatch(r, &(tyn_dispatch){.cells = {BALANCE_GROUP * p->channels, 1, 1},
                                        .args = &args,
                                        .spec = &walls});
}

const tyn_pass_desc tyn_pass_balance = {
    .name = "balance",
    .summary = "power that enters, is emitted, is absorbed and escapes",
    .serves = "a balance",
    .ports = ports,
    .num_ports = BALANCE_NUM_PORTS,
    .kernels = kernels,
    .num_kernels = 1,
    .params_size = sizeof(tyn_balance_params),
    .declare = declare,
    .record = record,
    .debug_port = BALANCE_PORT_BALANCE,
    .debug_meaning = "tyn_balance, W",
};
