// lattice_memory.c -- lattice_recall and lattice_keep: a solution outlives its frame.
#include "lattice.h"
#include "lattice_args.h"
#include "lattice_keep.comp.h"
#include "lattice_recall.comp.h"
#include "lattice_recall_power.comp.h"
#include <string.h>

uint64_t tyn_lattice_memory_size(int32_t cells, uint32_t channels)
{
    const uint64_t n = (uint64_t)cells;
    return sizeof(struct lattice_memory_block) + 4 * sizeof(float) * channels * n * n * n;
}

static struct lattice_recall_args args_of(const tyn_lattice_recall_params *p)
{
    const tyn_lattice_shape *s = &p->shape;
    const tyn_extent dims = tyn_lattice_dims(s->extent, s->cells);
    struct lattice_recall_args args = {.dims = {dims.x, dims.y, dims.z}, .channels = s->channels};
    memcpy(args.world, p->world, sizeof args.world);
    memcpy(args.extent, s->extent, sizeof args.extent);
    memcpy(args.tint, s->tint, sizeof args.tint);
    return args;
}

static tyn_extent texels_of(const struct lattice_recall_args *args)
{
    return (tyn_extent){args->dims[0], args->dims[1], args->dims[2] * args->channels};
}

// ---- recall -------------------------------------------------------------------------------------

static const tyn_port recall_ports[LATTICE_RECALL_NUM_PORTS] = {
    [LATTICE_RECALL_PORT_MEMORY] = {"memory", TYN_IN, TYN_BUFFER, 0, false,
                                    "struct lattice_memory_block and moments"},
    [LATTICE_RECALL_PORT_CELLS] = {"cells", TYN_IN, TYN_IMAGE_3D, 0, false, "of lattice_cells"},
    [LATTICE_RECALL_PORT_SOURCE] = {"source", TYN_IN, TYN_IMAGE_3D, 0, true, "of lattice_source"},
    [LATTICE_RECALL_PORT_ENVIRONMENT] = {"environment", TYN_IN, TYN_BUFFER, 0, true,
                                         "struct env_block"},
    [LATTICE_RECALL_PORT_GUESS] = {"guess", TYN_OUT, TYN_BUFFER, 0, false, "moments to start from"},
    [LATTICE_RECALL_PORT_POWER] = {"power", TYN_OUT, TYN_BUFFER, 0, false,
                                   "what light puts into the cells"},
};

enum { KERNEL_POWER, KERNEL_RECALL, NUM_RECALL_KERNELS };

static const tyn_binding power_bindings[] = {
    {LATTICE_RECALL_PORT_CELLS, TYN_USE_SAMPLED},
    {LATTICE_RECALL_PORT_SOURCE, TYN_USE_SAMPLED},
    {LATTICE_RECALL_PORT_ENVIRONMENT, TYN_USE_UNIFORM},
    {LATTICE_RECALL_PORT_POWER, TYN_USE_STORAGE_WRITE},
};
static const tyn_binding recall_bindings[] = {
    {LATTICE_RECALL_PORT_MEMORY, TYN_USE_STORAGE_READ},
    {LATTICE_RECALL_PORT_ENVIRONMENT, TYN_USE_UNIFORM},
    {LATTICE_RECALL_PORT_POWER, TYN_USE_STORAGE_READ},
    {LATTICE_RECALL_PORT_GUESS, TYN_USE_STORAGE_WRITE},
};

static const tyn_kernel recall_kernels[NUM_RECALL_KERNELS] = {
    [KERNEL_POWER] = TYN_KERNEL(lattice_recall_power, sizeof(struct lattice_recall_args),
                                LATTICE_SUN_GROUP, 1, 1, power_bindings, 0),
    [KERNEL_RECALL] =
        TYN_KERNEL(lattice_recall, sizeof(struct lattice_recall_args), 8, 4, 2, recall_bindings, 0),
};

static tyn_result declare_recall(tyn_builder *b, const void *params)
{
    const struct lattice_recall_args args = args_of(params);
    const tyn_extent texels = texels_of(&args);
    tyn_build_buffer(b, LATTICE_RECALL_PORT_GUESS,
                     4 * sizeof(float) * (uint64_t)texels.x * texels.y * texels.z);
    tyn_build_buffer(b, LATTICE_RECALL_PORT_POWER, 3 * sizeof(float));
    return TYN_OK;
}

static void record_recall(tyn_recorder *r, const void *params)
{
    const struct lattice_recall_args args = args_of(params);
    tyn_rec_fill(r, LATTICE_RECALL_PORT_POWER, 0); // of channels that are not solved
    tyn_rec_dispatch(r, &(tyn_dispatch){.kernel = KERNEL_POWER,
                                        .cells = {LATTICE_SUN_GROUP * args.channels, 1, 1},
                                        .args = &args});
    tyn_rec_dispatch(
        r, &(tyn_dispatch){.kernel = KERNEL_RECALL, .cells = texels_of(&args), .args = &args});
}

const tyn_pass_desc tyn_pass_lattice_recall = {
    .name = "lattice_recall",
    .summary = "the last frame's scattered light at the places of this frame's cells",
    .serves = "sequences that start from the last solution (lattice.warm)",
    .ports = recall_ports,
    .num_ports = LATTICE_RECALL_NUM_PORTS,
    .kernels = recall_kernels,
    .num_kernels = NUM_RECALL_KERNELS,
    .params_size = sizeof(tyn_lattice_recall_params),
    .declare = declare_recall,
    .record = record_recall,
    .debug_port = LATTICE_RECALL_PORT_GUESS,
    .debug_meaning = "moments that the solve starts from",
};

// ---- keep ---------------------------------------------------------------------------------------

static const tyn_port keep_ports[LATTICE_KEEP_NUM_PORTS] = {
    [LATTICE_KEEP_PORT_MOMENTS] = {"moments", TYN_IN, TYN_IMAGE_3D, 0, false, "of lattice"},
    [LATTICE_KEEP_PORT_POWER] = {"power", TYN_IN, TYN_BUFFER, 0, false, "of lattice_recall"},
    [LATTICE_KEEP_PORT_MEMORY] = {"memory", TYN_INOUT, TYN_BUFFER, 0, false,
                                  "struct lattice_memory_block and moments"},
};

static const tyn_binding keep_bindings[] = {
    {LATTICE_KEEP_PORT_MOMENTS, TYN_USE_SAMPLED},
    {LATTICE_KEEP_PORT_POWER, TYN_USE_STORAGE_READ},
    {LATTICE_KEEP_PORT_MEMORY, TYN_USE_STORAGE_WRITE},
};

static const tyn_kernel keep_kernels[] = {
    TYN_KERNEL(lattice_keep, sizeof(struct lattice_recall_args), 8, 4, 2, keep_bindings, 0),
};

static tyn_result declare_keep(tyn_builder *b, const void *params)
{
    (void)b;
    (void)params;
    return TYN_OK;
}

static void record_keep(tyn_recorder *r, const void *params)
{
    const struct lattice_recall_args args = args_of(params);
    tyn_rec_dispatch(r, &(tyn_dispatch){.kernel = 0, .cells = texels_of(&args), .args = &args});
}

const tyn_pass_desc tyn_pass_lattice_keep = {
    .name = "lattice_keep",
    .summary = "puts the scattered light away for the next frame",
    .serves = "sequences that start from the last solution (lattice.warm)",
    .ports = keep_ports,
    .num_ports = LATTICE_KEEP_NUM_PORTS,
    .kernels = keep_kernels,
    .num_kernels = 1,
    .params_size = sizeof(tyn_lattice_recall_params),
    .declare = declare_keep,
    .record = record_keep,
    .debug_port = LATTICE_KEEP_PORT_MEMORY,
    .debug_meaning = "what was put away",
};
