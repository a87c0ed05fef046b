// path.c -- tables and dispatches of the path tracer: images.
#include "path.h"
#include "shaders/common/counters.h"
#include "passes/path_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_path_params *p = params;
    tyn_extent size = tyn_build_extent(b, PATH_PORT_MEAN), none = {1, 1, 1};
    path_split s = path_split_work(p, size.x * size.y);
    uint64_t threads = (uint64_t)s.tile * s.slots;
    tyn_build_image(b, PATH_PORT_RADIANCE, size, 1);
    tyn_build_image(b, PATH_PORT_ERROR, size, 1);
    tyn_build_image(b, PATH_PORT_SINGLE, p->layers ? size : none, 1);
    tyn_build_image(b, PATH_PORT_MULTIPLE, p->layers ? size : none, 1);
    tyn_build_image(b, PATH_PORT_TRANSMITTANCE, p->layers ? size : none, 1);
    tyn_build_buffer(b, PATH_PORT_QUEUE, sizeof(uint32_t));
    tyn_build_buffer(b, PATH_PORT_PARTIALS, threads * sizeof(struct path_partial));
    tyn_build_buffer(b, PATH_PORT_LAYERS,
                     (p->layers ? threads : 1) * sizeof(struct path_partial_layers));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_path_params *p = params;
    tyn_extent size = tyn_rec_extent(r, PATH_PORT_MEAN);
    uint32_t pixels = size.x * size.y, spec[TYN_PATH_NUM_SPEC];
    path_split s = path_split_work(p, pixels);
    uint32_t slots = s.slots < p->num_samples ? s.slots : p->num_samples; // none is empty
    path_specialise(spec, p);
    tyn_rec_fill(r, PATH_PORT_QUEUE, 0);
    for (uint32_t first = 0; first < pixels; first += s.tile) {
        uint32_t num = pixels - first < s.tile ? pixels - first : s.tile;
        const struct path_args args = path_trace_args(p, first, num, slots);
        TYN_DISPATCH(r, .kernel = KERNEL_TRACE, .cells = {num * slots, 1, 1}, .args = &args,
                     .spec = spec);
        struct path_resolve_args resolve = {
            .first = first,
            .num = num,
            .slots = slots,
            .width = size.x,
            .samples_before = p->first_sample,
            .layers = p->layers,
            .opaque = p->opaque,
            .resumed = p->resumed,
        };
        TYN_DISPATCH(r, .kernel = KERNEL_RESOLVE, .cells = {num, 1, 1}, .args = &resolve);
    }
    tyn_rec_work(r, "paths", (double)pixels * p->num_samples);
}

const tyn_pass_desc tyn_pass_path = {
    .name = "path",
    .summary = "unbiased path tracing, progressive",
    TYN_PASS_TABLES(tyn_path_params),
    .of_pixels = true,
    TYN_SETTINGS(path_split_params_table),
    .debug_port = PATH_PORT_ERROR,
    .debug_meaning = "standard error of each pixel",
    TYN_COUNTS(PATH_PORT_COUNTERS, struct counters_block, TYN_COUNTERS),
};
