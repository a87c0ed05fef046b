// shdom_view.c -- the solution of shdom for one view.
#include "shdom_view.h"
#include "shdom_view_args.h"
#include "shaders/common/counters.h"
#include "passes/shdom_view_tables.h"

#define PORT(name) SHDOM_VIEW_PORT_##name

static tyn_extent dims_of(tyn_extent cells, uint32_t channels)
{
    return (tyn_extent){cells.x, cells.y, cells.z / channels};
}

static tyn_result declare(tyn_builder *b, const void *data)
{
    const tyn_shdom_view_params *p = data;
    const tyn_extent dims = dims_of(tyn_build_extent(b, PORT(CELLS)), p->channels);
    if (tyn_build_has(b, PORT(ORDINATES)) != tyn_build_has(b, PORT(COLUMNS)) ||
        (p->channels == 3 && !(tyn_build_has(b, PORT(SENT_1)) && tyn_build_has(b, PORT(SENT_2))))) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "shdom_view: 'ordinates' and 'columns' must be connected both or neither, "
                         "and 'sent_1' and 'sent_2' where there are three channels");
    }
    tyn_build_image(b, PORT(INSCATTER), (tyn_extent){dims.x + 2, dims.y + 2, dims.z + 2}, 1);
    tyn_build_image(b, PORT(TOWARDS), dims, 1);
    tyn_build_image(b, PORT(EXTINCTION), dims, 1);
    tyn_build_image(b, PORT(SCATTERED), dims, 1);
    tyn_build_image(b, PORT(SEEN), dims, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *data)
{
    const tyn_shdom_view_params *p = data;
    const tyn_extent size = tyn_rec_extent(r, PORT(INSCATTER));
    const tyn_extent dims = {size.x - 2, size.y - 2, size.z - 2};
    const struct shdom_view_args args = {.dims = {dims.x, dims.y, dims.z},
                                         .channels = p->channels,
                                         .tint = {p->tint[0], p->tint[1], p->tint[2]},
                                         .bands = (uint32_t)p->bands,
                                         .num_suns = p->num_suns,
                                         .lamps = p->lamps};
    const uint32_t spec[4] = {p->mode, p->channels, p->grey, tyn_rec_has(r, PORT(ORDINATES))};
    TYN_DISPATCH(r, .kernel = KERNEL_CELLS, .cells = dims, .args = &args, .spec = spec);
    TYN_DISPATCH(r, .kernel = KERNEL_PEAKS, .cells = dims, .args = &args);
    TYN_DISPATCH(r, .kernel = KERNEL_STORE, .cells = size, .args = &args);
    tyn_rec_work(r, "cells", (double)dims.x * dims.y * dims.z);
}

const tyn_pass_desc tyn_pass_shdom_view = {
    .name = "shdom_view",
    .summary = "spherical harmonics of the source function, towards the eye",
    .serves = "pictures of media that scatter more than once",
    TYN_PASS_TABLES(tyn_shdom_view_params),
    .debug_port = PORT(INSCATTER),
    .debug_meaning = "light towards the eye per sigma_s in a slice",
    TYN_COUNTS(PORT(COUNTERS), struct counters_block, TYN_COUNTER_NON_FINITE,
               {"clamped", offsetof(struct counters_block, clamped)},
               TYN_COUNTER_HIDDEN(
                   "of what cells scatter towards the eye",
                   "accuracy: cells of the lattice would send negative light to the camera, "
                   "which is set to 0: %g %% of what they send; the picture is brighter there")),
};
