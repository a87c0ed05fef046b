// merge.c -- the light field of the lattice and of the ordinates for one view.
#include "merge.h"
#include "merge_args.h"
#include "shaders/common/counters.h"
#include "passes/merge_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_merge_params *p = params;
    tyn_extent dims = tyn_build_extent(b, MERGE_PORT_MOMENTS);
    bool ordinates = tyn_build_has(b, MERGE_PORT_ORDINATES);
    const uint8_t with[] = {MERGE_PORT_COLUMNS, MERGE_PORT_TMS};
    for (size_t i = 0; i < sizeof with; i++) {
        const uint8_t port = with[i];
        if (tyn_build_has(b, port) != ordinates) {
            return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                             "merge: '%s' and '%s' must be connected both or neither",
                             ports[MERGE_PORT_ORDINATES].name, ports[port].name);
        }
    }
    bool radials = tyn_build_has(b, MERGE_PORT_RADIALS);
    if ((ordinates || radials) && !tyn_build_has(b, MERGE_PORT_LUT_BLOCK)) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS, "merge: 'lut_block' must be connected");
    }
    if (p->channels == 1) {
        tyn_build_format(b, MERGE_PORT_INSCATTER, VK_FORMAT_R32_SFLOAT);
    }
    tyn_build_image(b, MERGE_PORT_INSCATTER,
                    (tyn_extent){dims.x + 2, dims.y + 2, dims.z / p->channels + 2}, 1);
    tyn_build_buffer(b, MERGE_PORT_FIELD,
                     4ull * dims.x * dims.y * (dims.z / p->channels) * (p->channels + 1));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_merge_params *p = params;
    tyn_extent size = tyn_rec_extent(r, MERGE_PORT_INSCATTER);
    tyn_extent dims = {size.x - 2, size.y - 2, size.z - 2};
    struct merge_args args = {.dims = {dims.x, dims.y, dims.z},
                              .channels = p->channels,
                              .tint = {p->tint[0], p->tint[1], p->tint[2]},
                              .first_radial = p->marched_lamps,
                              .repeat = {p->repeat[0], p->repeat[1], p->repeat[2]},
                              .reach = p->reach};
    TYN_DISPATCH(r, .kernel = KERNEL_CELLS, .cells = dims, .args = &args);
    if (tyn_rec_has(r, MERGE_PORT_ORDINATES)) {
        const uint32_t spec[4] = {p->mode, p->grey, p->channels,
                                  tyn_rec_has(r, MERGE_PORT_SKY_SEEN)};
        TYN_DISPATCH(r, .kernel = KERNEL_ORDINATES, .cells = dims, .args = &args, .spec = spec);
    }
    if (tyn_rec_has(r, MERGE_PORT_RADIALS)) {
        const uint32_t spec[5] = {p->mode, p->grey, p->channels,
                                  tyn_rec_has(r, MERGE_PORT_SHADOW_ATLAS), p->tabled};
        TYN_DISPATCH(r, .kernel = KERNEL_RADIALS, .cells = dims, .args = &args, .spec = spec);
    }
    TYN_DISPATCH(r, .kernel = p->channels == 1 ? KERNEL_ONE : KERNEL_THREE, .cells = size,
                 .args = &args);
    tyn_rec_work(r, "cells", (double)dims.x * dims.y * dims.z);
}

const tyn_pass_desc tyn_pass_merge = {
    .name = "merge",
    .summary = "light that each cell scatters towards the eye",
    .serves = "pictures of media that scatter more than once",
    TYN_PASS_TABLES(tyn_merge_params),
    .debug_port = MERGE_PORT_INSCATTER,
    .debug_meaning = "radiance towards the eye per sigma_s' in a slice",
    TYN_COUNTS(MERGE_PORT_COUNTERS, struct counters_block, TYN_COUNTERS,
               {"ghosts", offsetof(struct counters_block, ghosts)},
               TYN_COUNTER_HIDDEN(
                   "of what cells scatter towards the eye",
                   "accuracy: cells of the lattice would send negative light to the camera, "
                   "which is set to 0: %g %% of what they send; the picture is brighter there")),
};
