// path.c -- tables and dispatches of the path tracer.
#include "path.h"
#include "counters.h"
#include "path_args.h"
#include "path_tables.h"
#include "path_probe.comp.h"
#include "path_probe_resolve.comp.h"
#include "path_resolve.comp.h"
#include "path_trace.comp.h"

#define RGBA VK_FORMAT_R32G32B32A32_SFLOAT

enum { PROBE_STATE_BYTES = 3 * TYN_PATH_PROBE_VALUES * 4 };

// ---- tables -----------------------------------------------------------------------------------

const tyn_param path_params_table[PATH_NUM_PARAMS] = {
    {"mixture", TYN_PARAM_BOOL, offsetof(tyn_path_params, mixture), 1, 0, 1, "",
     "draw directions from a mixture with light lobes; 0: the phase function alone", NULL},
    {"equiangular", TYN_PARAM_BOOL, offsetof(tyn_path_params, equiangular), 1, 0, 1, "",
     "draw distances by the angle seen from lamps as well; 0: free flights alone", NULL},
    {"max_steps", TYN_PARAM_INT, offsetof(tyn_path_params, max_steps), 200000, 100, 100000000,
     "steps", "safety cap of one path; cut paths are counted", NULL},
};

static const tyn_port image_ports[PATH_NUM_PORTS] = {
    PATH_SCENE_PORT_ROWS,
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

static const tyn_binding trace_bindings[] = {
    PATH_SCENE_BINDING_ROWS,
    {PATH_PORT_CAMERA, TYN_USE_UNIFORM, false},
    {PATH_PORT_PARTIALS, TYN_USE_STORAGE_WRITE, false},
    {PATH_PORT_COUNTERS, TYN_USE_STORAGE_RW, false},
    {PATH_PORT_LAYERS, TYN_USE_STORAGE_WRITE, false},
};

static const tyn_binding resolve_bindings[] = {
    {PATH_PORT_PARTIALS, TYN_USE_STORAGE_READ, false},
    {PATH_PORT_LAYERS, TYN_USE_STORAGE_READ, false},
    {PATH_PORT_MEAN, TYN_USE_STORAGE_RW, false},
    {PATH_PORT_LOW, TYN_USE_STORAGE_RW, false},
    {PATH_PORT_DEVIATION, TYN_USE_STORAGE_RW, false},
    {PATH_PORT_MEAN_SINGLE, TYN_USE_STORAGE_RW, false},
    {PATH_PORT_MEAN_MULTIPLE, TYN_USE_STORAGE_RW, false},
    {PATH_PORT_MEAN_TRANSMITTANCE, TYN_USE_STORAGE_RW, false},
    {PATH_PORT_RADIANCE, TYN_USE_STORAGE_WRITE, false},
    {PATH_PORT_ERROR, TYN_USE_STORAGE_WRITE, false},
    {PATH_PORT_SINGLE, TYN_USE_STORAGE_WRITE, false},
    {PATH_PORT_MULTIPLE, TYN_USE_STORAGE_WRITE, false},
    {PATH_PORT_TRANSMITTANCE, TYN_USE_STORAGE_WRITE, false},
};

static const tyn_kernel image_kernels[] = {
    TYN_KERNEL(path_trace, sizeof(struct path_args), 64, 1, 1, trace_bindings, TYN_PATH_NUM_SPEC),
    TYN_KERNEL(path_resolve, sizeof(struct path_resolve_args), 64, 1, 1, resolve_bindings, 0),
};

static const tyn_port probe_ports[PATH_PROBE_NUM_PORTS] = {
    PATH_SCENE_PORT_ROWS,
    {"points", TYN_IN, TYN_BUFFER, 0, false, "points in M, m"},
    {"state", TYN_INOUT, TYN_BUFFER, 0, false, "running statistics of each point"},
    {"results", TYN_OUT, TYN_BUFFER, 0, false, "fluence and net flux with standard errors, W/m^2"},
    {"counters", TYN_OUT, TYN_BUFFER, 0, false, "collisions, cut paths, non-finite samples"},
    {"partials", TYN_SCRATCH, TYN_BUFFER, 0, false, "statistics of each thread"},
};

static const tyn_binding probe_bindings[] = {
    PATH_SCENE_BINDING_ROWS,
    {PATH_PROBE_PORT_POINTS, TYN_USE_STORAGE_READ, false},
    {PATH_PROBE_PORT_PARTIALS, TYN_USE_STORAGE_WRITE, false},
    {PATH_PROBE_PORT_COUNTERS, TYN_USE_STORAGE_RW, false},
};

static const tyn_binding probe_resolve_bindings[] = {
    {PATH_PROBE_PORT_PARTIALS, TYN_USE_STORAGE_READ, false},
    {PATH_PROBE_PORT_STATE, TYN_USE_STORAGE_RW, false},
    {PATH_PROBE_PORT_RESULTS, TYN_USE_STORAGE_WRITE, false},
};

static const tyn_kernel probe_kernels[] = {
    TYN_KERNEL(path_probe, sizeof(struct path_args), 64, 1, 1, probe_bindings, TYN_PATH_NUM_SPEC),
    TYN_KERNEL(path_probe_resolve, sizeof(struct path_resolve_args), 64, 1, 1,
               probe_resolve_bindings, 0),
};

// ---- splitting the work -----------------------------------------------------------------------

// Elements (pixels, points) are worked off in tiles of at most `threads`; where there are fewer, several
// threads share the samples of each. Depends on sizes alone, so that the frame keeps its structure whatever
// the number of samples.
typedef struct split {
    uint32_t tile, slots;
} split;

static split split_work(const tyn_path_params *p, uint32_t elements)
{
    uint32_t threads = p->threads ? p->threads : 16384;
    split s;
    s.tile = elements < threads ? elements : threads;
    s.slots = threads / s.tile;
    return s;
}

struct path_args path_trace_args(const tyn_path_params *p)
{
    return (struct path_args){
        .first_sample = p->first_sample,
        .num_samples = p->num_samples,
        .seed = p->seed,
        .num_lights = p->num_lights,
        .max_depth = p->max_depth ? p->max_depth : UINT32_MAX,
        .rr_depth = p->rr_depth ? p->rr_depth : 4,
        .max_steps = (uint32_t)p->max_steps,
        .sigma_guess = p->sigma_guess,
        .stretch = p->stretch,
        .world = {{p->world[0][0], p->world[0][1], p->world[0][2]},
                  {p->world[1][0], p->world[1][1], p->world[1][2]},
                  {p->world[2][0], p->world[2][1], p->world[2][2]}},
        .box_lo = {p->box[0][0], p->box[0][1], p->box[0][2]},
        .box_hi = {p->box[1][0], p->box[1][1], p->box[1][2]},
    };
}

void path_specialise(uint32_t spec[TYN_PATH_NUM_SPEC], const tyn_path_params *p)
{
    // A lobe needs a light; under a constant sky every direction is as good.
    bool lights = p->num_lights > 0 || p->environment == TYN_PATH_ENV_MAP || p->emitters;
    spec[TYN_PATH_SPEC_SHAPES] = p->num_shapes <= TYN_PATH_SHAPES_MAX ? p->num_shapes : 0;
    spec[TYN_PATH_SPEC_HOMOGENEOUS] = p->homogeneous ? 1 : 0;
    spec[TYN_PATH_SPEC_GREY] = p->grey ? 1 : 0;
    spec[TYN_PATH_SPEC_LIGHTS] = p->num_lights < 2 ? p->num_lights : 2;
    spec[TYN_PATH_SPEC_ENVIRONMENT] = p->environment;
    spec[TYN_PATH_SPEC_FLAGS] =
        (p->repeat ? TYN_PATH_REPEAT : 0) | (p->sphere ? TYN_PATH_SPHERE : 0) |
        (p->emissive ? TYN_PATH_EMISSIVE : 0) | (p->mixture && lights ? TYN_PATH_MIXTURE : 0) |
        (p->num_lamps ? TYN_PATH_LAMPS : 0) |
        (p->equiangular && p->near_lamps ? TYN_PATH_EQUIANGULAR : 0) |
        (p->layers ? TYN_PATH_LAYERS : 0) | (p->scattered ? TYN_PATH_SCATTERED : 0) |
        (p->stretch > 1 ? TYN_PATH_THIN : 0) | (p->surfaces ? TYN_PATH_SURFACES : 0) |
        (p->surfaces && p->emitters ? TYN_PATH_EMITTERS : 0);
}

// ---- image ------------------------------------------------------------------------------------

static tyn_result declare_image(tyn_builder *b, const void *params)
{
    const tyn_path_params *p = params;
    tyn_extent size = tyn_build_extent(b, PATH_PORT_MEAN), none = {1, 1, 1};
    split s = split_work(p, size.x * size.y);
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

static void record_image(tyn_recorder *r, const void *params)
{
    const tyn_path_params *p = params;
    tyn_extent size = tyn_rec_extent(r, PATH_PORT_MEAN);
    uint32_t pixels = size.x * size.y, spec[TYN_PATH_NUM_SPEC];
    split s = split_work(p, pixels);
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
    .ports = image_ports,
    .num_ports = PATH_NUM_PORTS,
    .kernels = image_kernels,
    .num_kernels = 2,
    .params = path_params_table,
    .num_params = PATH_NUM_PARAMS,
    .params_size = sizeof(tyn_path_params),
    .declare = declare_image,
    .record = record_image,
    .debug_port = PATH_PORT_ERROR,
    .debug_meaning = "standard error of each pixel",
    .counters = (const tyn_counter[]){TYN_COUNTERS, {NULL}},
};

// ---- probes -----------------------------------------------------------------------------------

uint64_t tyn_path_probe_state_size(uint32_t num_points)
{
    return (uint64_t)num_points * PROBE_STATE_BYTES;
}

static tyn_result declare_probe(tyn_builder *b, const void *params)
{
    uint32_t points = tyn_build_extent(b, PATH_PROBE_PORT_STATE).x / PROBE_STATE_BYTES;
    split s = split_work(params, points);
    tyn_build_buffer(b, PATH_PROBE_PORT_RESULTS,
                     (uint64_t)points * sizeof(struct path_probe_result));
    tyn_build_buffer(b, PATH_PROBE_PORT_COUNTERS, sizeof(struct counters_block));
    tyn_build_buffer(b, PATH_PROBE_PORT_PARTIALS,
                     (uint64_t)s.tile * s.slots * sizeof(struct path_probe_partial));
    return TYN_OK;
}

static void record_probe(tyn_recorder *r, const void *params)
{
    const tyn_path_params *p = params;
    uint32_t points = tyn_rec_extent(r, PATH_PROBE_PORT_STATE).x / PROBE_STATE_BYTES;
    uint32_t spec[TYN_PATH_NUM_SPEC];
    split s = split_work(p, points);
    path_specialise(spec, p);
    tyn_rec_fill(r, PATH_PROBE_PORT_COUNTERS, 0);
    for (uint32_t first = 0; first < points; first += s.tile) {
        uint32_t num = points - first < s.tile ? points - first : s.tile;
        struct path_args args = path_trace_args(p);
        args.first = first;
        args.num = num;
        args.slots = s.slots;
        tyn_rec_dispatch(
            r, &(tyn_dispatch){
                   .kernel = 0, .cells = {num * s.slots, 1, 1}, .args = &args, .spec = spec});
        struct path_resolve_args resolve = {
            .first = first, .num = num, .slots = s.slots, .samples_before = p->first_sample};
        tyn_rec_dispatch(r, &(tyn_dispatch){.kernel = 1,
                                            .cells = {num * TYN_PATH_PROBE_VALUES, 1, 1},
                                            .args = &resolve});
    }
    tyn_rec_work(r, "paths", (double)points * p->num_samples);
}

const tyn_pass_desc tyn_pass_path_probe = {
    .name = "path_probe",
    .summary = "unbiased fluence and net flux at points, progressive",
    .ports = probe_ports,
    .num_ports = PATH_PROBE_NUM_PORTS,
    .kernels = probe_kernels,
    .num_kernels = 2,
    .params = path_params_table,
    .num_params = PATH_NUM_PARAMS,
    .params_size = sizeof(tyn_path_params),
    .declare = declare_probe,
    .record = record_probe,
    .debug_port = PATH_PROBE_PORT_RESULTS,
    .debug_meaning = "fluence and net flux",
    .counters = (const tyn_counter[]){TYN_COUNTERS, {NULL}},
};
