// lattice_recall.c -- see lattice_recall.h.
#include "lattice_recall.h"
#include "passes/lattice_recall_tables.h"

uint64_t tyn_lattice_memory_size(int32_t cells, uint32_t channels)
{
    const uint64_t n = (uint64_t)cells;
    return sizeof(struct lattice_memory_block) + 4 * sizeof(float) * channels * n * n * n;
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const struct lattice_recall_args args = lattice_memory_args(params);
    const tyn_extent texels = lattice_memory_texels(&args);
    tyn_build_buffer(b, LATTICE_RECALL_PORT_GUESS,
                     4 * sizeof(float) * (uint64_t)texels.x * texels.y * texels.z);
    tyn_build_buffer(b, LATTICE_RECALL_PORT_POWER, 3 * sizeof(float));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const struct lattice_recall_args args = lattice_memory_args(params);
    tyn_rec_fill(r, LATTICE_RECALL_PORT_POWER, 0); // of channels that are not solved
    TYN_DISPATCH(r, .kernel = KERNEL_POWER, .cells = {LATTICE_SUN_GROUP * args.channels, 1, 1},
                 .args = &args);
    TYN_DISPATCH(r, .kernel = KERNEL_LATTICE_RECALL, .cells = lattice_memory_texels(&args),
                 .args = &args);
}

const tyn_pass_desc tyn_pass_lattice_recall = {
    .name = "lattice_recall",
    .summary = "the last frame's scattered light at the places of this frame's cells",
    .serves = "sequences that start from the last solution (lattice.warm)",
    TYN_PASS_TABLES(tyn_lattice_recall_params),
    .debug_port = LATTICE_RECALL_PORT_GUESS,
    .debug_meaning = "moments that the solve starts from",
};
