// ceilings.c -- how fast the device at hand is at what passes are made of, and which of it bounds a node.
#include "ceilings.h"
#include "ceiling_empty.comp.h"
#include "ceiling_exp.comp.h"
#include "ceiling_fma.comp.h"
#include "ceiling_trilinear.comp.h"
#include "stats.h"
#include <math.h>
#include <string.h>
#include <tyndall/offline.h>
#include <tyndall/pass.h>

// ---- the pass ---------------------------------------------------------------------------------

enum { PORT_RESULT, PORT_VOLUME, PORT_FROM, PORT_TO, NUM_PORTS };
enum { WHAT_FMA, WHAT_EXP, WHAT_TRILINEAR, WHAT_DISPATCH, WHAT_COPY };

typedef struct ceiling_params {
    int32_t what;
    uint32_t rounds; // loops of a thread, dispatches, copies
} ceiling_params;

enum { SIDE = 256, THREADS = SIDE * SIDE, VOLUME = 64, CHAINS = 12, UNROLLED = 8, FETCHES = 4 };
static const uint64_t copy_bytes = 128u << 20;

static const tyn_port ports[NUM_PORTS] = {
    {"result", TYN_OUT, TYN_BUFFER, 0, false, "a number of each thread, so that its work is done"},
    {"volume", TYN_SCRATCH, TYN_IMAGE_3D, VK_FORMAT_R32_SFLOAT, false, "zeros to sample"},
    {"from", TYN_SCRATCH, TYN_BUFFER, 0, false, "copied"},
    {"to", TYN_SCRATCH, TYN_BUFFER, 0, false, "its copy"},
};
static const tyn_binding writes[] = {{PORT_RESULT, TYN_USE_STORAGE_WRITE, false}};
static const tyn_binding samples[] = {{PORT_RESULT, TYN_USE_STORAGE_WRITE, false},
                                      {PORT_VOLUME, TYN_USE_SAMPLED, true}};
static const tyn_binding changes[] = {{PORT_RESULT, TYN_USE_STORAGE_RW, false}};
static const tyn_kernel kernels[] = {
    [WHAT_FMA] = {.name = "ceiling_fma",
                  .spirv = ceiling_fma_spirv,
                  .spirv_size = sizeof ceiling_fma_spirv,
                  .args_size = sizeof(uint32_t),
                  .local_size = {64, 1, 1},
                  .bindings = writes,
                  .num_bindings = ARRAY_SIZE(writes)},
    [WHAT_EXP] = {.name = "ceiling_exp",
                  .spirv = ceiling_exp_spirv,
                  .spirv_size = sizeof ceiling_exp_spirv,
                  .args_size = sizeof(uint32_t),
                  .local_size = {64, 1, 1},
                  .bindings = writes,
                  .num_bindings = ARRAY_SIZE(writes)},
    [WHAT_TRILINEAR] = {.name = "ceiling_trilinear",
                        .spirv = ceiling_trilinear_spirv,
                        .spirv_size = sizeof ceiling_trilinear_spirv,
                        .args_size = sizeof(uint32_t),
                        .local_size = {8, 8, 1},
                        .bindings = samples,
                        .num_bindings = ARRAY_SIZE(samples)},
    [WHAT_DISPATCH] = {.name = "ceiling_empty",
                       .spirv = ceiling_empty_spirv,
                       .spirv_size = sizeof ceiling_empty_spirv,
                       .local_size = {64, 1, 1},
                       .bindings = changes,
                       .num_bindings = ARRAY_SIZE(changes)},
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    const ceiling_params *p = params;
    const uint64_t copied = p->what == WHAT_COPY ? copy_bytes : 256;
    tyn_build_buffer(b, PORT_RESULT, THREADS * sizeof(float));
    tyn_build_image(b, PORT_VOLUME, (tyn_extent){VOLUME, VOLUME, VOLUME}, 1);
    tyn_build_buffer(b, PORT_FROM, copied);
    tyn_build_buffer(b, PORT_TO, copied);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const ceiling_params *p = params;
    switch (p->what) {
    case WHAT_COPY:
        for (uint32_t i = 0; i < p->rounds; i++) {
            tyn_rec_copy_buffer(r, PORT_FROM, PORT_TO, copy_bytes);
        }
        tyn_rec_fill(r, PORT_RESULT, 0);
        break;
    case WHAT_DISPATCH:
        for (uint32_t i = 0; i < p->rounds; i++) {
            tyn_rec_dispatch(r, &(tyn_dispatch){.kernel = WHAT_DISPATCH, .cells = {1, 1, 1}});
        }
        break;
    default:
        if (p->what == WHAT_TRILINEAR) {
            tyn_rec_clear(r, PORT_VOLUME);
        }
        tyn_rec_dispatch(r, &(tyn_dispatch){.kernel = (uint32_t)p->what,
                                            .cells = p->what == WHAT_TRILINEAR
                                                         ? (tyn_extent){SIDE, SIDE, 1}
                                                         : (tyn_extent){THREADS, 1, 1},
                                            .args = &p->rounds});
    }
}

static const tyn_pass_desc pass = {
    .name = "ceilings",
    .summary = "how fast a device is",
    .serves = "the bench",
    .ports = ports,
    .num_ports = NUM_PORTS,
    .kernels = kernels,
    .num_kernels = ARRAY_SIZE(kernels),
    .params_size = sizeof(ceiling_params),
    .declare = declare,
    .record = record,
    .debug_port = PORT_RESULT,
};

// ---- measuring --------------------------------------------------------------------------------

// Seconds that a round takes. Rounds are added until the whole takes long enough to be timed.
static int seconds_per_round(app *a, tyn_device *device, int32_t what, uint32_t rounds,
                             double *seconds)
{
    enum { RUNS = 4, MOST = 1 << 16 };
    const double enough_ms = 20;
    double ms = 0;
    tyn_result result = TYN_OK;
    while (result == TYN_OK && !app_interrupted()) {
        result = tyn_offline_time_pass(device, &pass, &(ceiling_params){what, rounds}, RUNS, &ms);
        if (ms >= enough_ms || rounds >= MOST) {
            break;
        }
        double factor = ms > 0 ? fmin(fmax(1.5 * enough_ms / ms, 2), 64) : 64;
        rounds = (uint32_t)fmin(MOST, rounds * factor);
    }
    *seconds = ms > 0 ? 1e-3 * ms / rounds : NAN;
    return app_exit_code(a, result, false);
}

int ceilings_measure(app *a, tyn_device *device, ceilings *c)
{
    *c = (ceilings){NAN, NAN, NAN, NAN, NAN};
    const struct {
        int32_t what;
        uint32_t rounds;
        double amount; // of a round
        double *to;    // amount / second
    } all[] = {
        {WHAT_FMA, 64, 1e-9 * 2 * CHAINS * UNROLLED * THREADS, &c->fma_gflops},
        {WHAT_COPY, 1, 1e-9 * 2 * (double)copy_bytes, &c->copy_gb_s},
        {WHAT_TRILINEAR, 8, 1e-9 * FETCHES * THREADS, &c->trilinear_gsamples_s},
        {WHAT_EXP, 4, 1e-9 * CHAINS * UNROLLED * THREADS, &c->exp_gops_s},
        {WHAT_DISPATCH, 64, 1, &c->dispatch_us},
    };
    int code = EXIT_DONE;
    for (size_t i = 0; i < ARRAY_SIZE(all) && code == EXIT_DONE; i++) {
        double seconds = NAN;
        code = seconds_per_round(a, device, all[i].what, all[i].rounds, &seconds);
        *all[i].to = all[i].what == WHAT_DISPATCH ? 1e6 * seconds : all[i].amount / seconds;
    }
    return code;
}

cJSON *ceilings_json(const ceilings *c)
{
    cJSON *json = cJSON_CreateObject();
    json_add_float(json, "fma_gflops", c->fma_gflops);
    json_add_float(json, "copy_gb_s", c->copy_gb_s);
    json_add_float(json, "trilinear_gsamples_s", c->trilinear_gsamples_s);
    json_add_float(json, "exp_gops_s", c->exp_gops_s);
    json_add_float(json, "dispatch_us", c->dispatch_us);
    return json;
}

// ---- nodes ------------------------------------------------------------------------------------

// What a counted step costs at least, by hand from the shaders. March: where there is no medium it is a fetch of the
// density and some twenty flops; full steps cost more, and are not counted apart. Path: a step is sixteen tentative
// collisions, each with a fetch, a logarithm and a random number.
static const struct {
    const char *node;
    double flops, samples, exps;
} steps[] = {
    {"raymarch", 20, 1, 0},
    {"path", 16 * 60, 16, 16},
};

node_work node_work_of(const tyn_node_report *node)
{
    node_work w = {.gpu_ms = node->gpu_ms, .flops = node->flops, .dispatches = node->dispatches};
    for (uint32_t i = 0; i < node->num_work; i++) {
        const char *name = node->work[i].name;
        const double amount = node->work[i].amount;
        w.bytes += strcmp(name, "bytes") == 0 ? amount : 0;
        w.samples += strcmp(name, "fetches") == 0 ? amount : 0;
        for (size_t k = 0; k < ARRAY_SIZE(steps) && strcmp(name, "steps") == 0; k++) {
            if (strcmp(node->name, steps[k].node) == 0) {
                w.flops += steps[k].flops * amount;
                w.samples += steps[k].samples * amount;
                w.exps += steps[k].exps * amount;
            }
        }
    }
    return w;
}

const char *ceilings_bind(const ceilings *c, const node_work *w, double *fraction)
{
    // A node that tells of no work is bound by its dispatches only where these are a good part of it.
    const double enough = w->flops > 0 || w->bytes > 0 || w->samples > 0 ? 0 : 0.3;
    const struct {
        const char *name;
        double ms;
    } bounds[] = {
        {"fma", 1e-6 * w->flops / c->fma_gflops},
        {"copy", 1e-6 * w->bytes / c->copy_gb_s},
        {"trilinear", 1e-6 * w->samples / c->trilinear_gsamples_s},
        {"exp", 1e-6 * w->exps / c->exp_gops_s},
        {"dispatch", 1e-3 * w->dispatches * c->dispatch_us},
    };
    const char *name = NULL;
    double most = 0;
    for (size_t i = 0; i < ARRAY_SIZE(bounds); i++) {
        if (bounds[i].ms > most) { // false for NAN
            most = bounds[i].ms;
            name = bounds[i].name;
        }
    }
    const double share = w->gpu_ms > 0 ? most / w->gpu_ms : 0;
    *fraction = name && share > enough ? fmin(share, 1) : NAN;
    return isnan(*fraction) ? NULL : name;
}
