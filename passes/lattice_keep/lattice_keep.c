// lattice_keep.c -- see lattice_keep.h.
#include "lattice_keep.h"
#include "passes/lattice_keep_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)b;
    (void)params;
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const struct lattice_recall_args args = lattice_memory_args(params);
    TYN_DISPATCH(r, .kernel = KERNEL_LATTICE_KEEP, .cells = lattice_memory_texels(&args),
                 .args = &args);
}

const tyn_pass_desc tyn_pass_lattice_keep = {
    .name = "lattice_keep",
    .summary = "puts the scattered light away for the next frame",
    .serves = "sequences that start from the last solution (lattice.warm)",
    TYN_PASS_TABLES(tyn_lattice_recall_params),
    .debug_port = LATTICE_KEEP_PORT_MEMORY,
    .debug_meaning = "what was put away",
};
