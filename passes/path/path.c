// path.c -- tables and dispatches of the path tracer: images.
#include "path.h"
#include "shaders/common/counters.h"
#include "path_resolve.comp.h"
#include "path_trace.comp.h"

#define RGBA VK_FORMAT_R32G32B32A32_SFLOAT

static const tyn_port ports[PATH_NUM_PORTS] = {
    TYN_PATH_SCENE(TYN_BUNDLE_IN, PATH),
    TYN_GEOMETRY(TYN_BUNDLE_OPTIONAL, PATH),
    TYN_MATERIALS(TYN_BUNDLE_OPTIONAL, PATH),
    {"camera", TYN_IN, TYN_BUFFER, 0, false, "rays of the pixels"},
    {"mean", TYN_INOUT, TYN_IMAGE_2D, RGBA, false, "running mean radiance, W/(m^2 sr)"},
    {"low", TYN_INOUT, TYN_IMAGE_2D, RGBA, false, "what single precision loses of the mean"},
    {"deviation", TYN_INOUT, TYN_IMAGE_2D, RGBA, false, "running sum of squared deviations"},
    {"mean_single", TYN_INOUT, TYN_IMAGE_2D, RGBA, false, "running mean of the first order"},
    {"mean_multiple", TYN_INOUT, TYN_IMAGE_2D, RGBA, false, "running mean of higher orders"},
    {"mean_transmittance", TYN_INOUT, TYN_IMAGE_2D, RGBA, false, "running mean transmittance"},
    {"radiance", TYN_OUT, TYN_IMAGE_2D, RGBA, false, "radiance W/(m^2 sr), alpha"},
    {"error", TYN_OUT, TYN_IMAGE_2D, RGBA, false, "standard error of the radiance, W/(m^2 sr)"},
    {"single", TYN_OUT, TYN_IMAGE_2D, RGBA, false, "first-order scattering, W/(m^2 sr)"},
    {"multiple", TYN_OUT, TYN_IMAGE_2D, RGBA, false, "higher orders and emission, W/(m^2 sr)"},
    {"transmittance", TYN_OUT, TYN_IMAGE_2D, RGBA, false, "transmittance of the media"},
    {"counters", TYN_OUT, TYN_BUFFER, 0, false, "collisions, cut paths, non-finite samples"},
    {"partials", TYN_SCRATCH, TYN_BUFFER, 0, false, "statistics of each thread"},
    {"layers", TYN_SCRATCH, TYN_BUFFER, 0, false, "layers of each thread"},
};

static const tyn_kernel kernels[] = {
    TYN_KERNEL(path_trace),
    TYN_KERNEL(path_resolve),
};

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
    tyn_build_buffer(b, PATH_PORT_COUNTERS, sizeof(struct counters_block));
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
    path_specialise(spec, p);
    tyn_rec_fill(r, PATH_PORT_COUNTERS, 0);
    for (uint32_t first = 0; first < pixels; first += s.tile) {
        uint32_t num = pixels - first < s.tile ? pixels - first : s.tile;
        struct path_args args = path_trace_args(p);
        args.first = first;
        args.num = num;
        args.slots = s.slots;
        tyn_rec_dispatch(
            r, &(tyn_dispatch){
                   .kernel = 0, .cells = {num * s.slots, 1, 1}, .args = &args, .spec = spec});
        struct path_resolve_args resolve = {
            .first = first,
            .num = num,
            .slots = s.slots,
            .width = size.x,
            .samples_before = p->first_sample,
            .layers = p->layers,
            .opaque = p->opaque,
        };
        tyn_rec_dispatch(r, &(tyn_dispatch){.kernel = 1, .cells = {num, 1, 1}, .args = &resolve});
    }
    tyn_rec_work(r, "paths", (double)pixels * p->num_samples);
}

const tyn_pass_desc tyn_pass_path = {
    .name = "path",
    .summary = "unbiased path tracing, progressive",
    TYN_PASS_TABLES(tyn_path_params),
    .params = path_params_table,
    .num_params = TYN_COUNT(path_params_table),
    .debug_port = PATH_PORT_ERROR,
    .debug_meaning = "standard error of each pixel",
    .counters = (const tyn_counter[]){TYN_COUNTERS, {NULL}},
};
