// propagate_rect.c -- see propagate_rect.h.
#include "propagate_rect.h"
#include "propagate_rect_args.h"
#include "propagate_rect_cells.comp.h"
#include "propagate_rect_setup.comp.h"
#include "propagate_rect_start.comp.h"
#include "propagate_rect_step.comp.h"
#include "scene_args.h"

#define PORT(name) PROPAGATE_RECT_PORT_##name
#define RGBA VK_FORMAT_R32G32B32A32_SFLOAT

static const tyn_port ports[PROPAGATE_RECT_NUM_PORTS] = {
    [PORT(MEDIUM)] = {"medium", TYN_IN, TYN_BUFFER, .meaning = "struct medium_block"},
    [PORT(LIGHTS)] = {"lights", TYN_IN, TYN_BUFFER, .meaning = "struct light_block[]"},
    [PORT(CAMERA)] = {"camera", TYN_IN, TYN_BUFFER, .meaning = "struct camera_block"},
    [PORT(DENSITY)] = {"density", TYN_IN, TYN_IMAGE_3D, .meaning = "density, or sigma_s in 1/m"},
    [PORT(SIGMA_A)] = {"sigma_a", TYN_IN, TYN_IMAGE_3D, .optional = true,
                       .meaning = "absorption, 1/m"},
    [PORT(G)] = {"g", TYN_IN, TYN_IMAGE_3D, .optional = true,
                 .meaning = "mean cosine of scattering"},
    [PORT(GRIDS)] = {"grids", TYN_OUT, TYN_BUFFER, .meaning = "struct propagate_grid[]"},
    [PORT(CELLS)] = {"cells", TYN_OUT, TYN_IMAGE_3D, RGBA,
                     .meaning =
                         "mean sigma_s, sigma_a of the aligned cells, 1/m; g; decay of a, 1/m"},
    [PORT(STATE)] = {"state", TYN_OUT, TYN_IMAGE_3D, RGBA,
                     .meaning = "L per irradiance, 1 - a, its fractions to a side and to the back"},
    [PORT(SEEN)] = {"seen", TYN_OUT, TYN_IMAGE_3D, VK_FORMAT_R32_SFLOAT,
                    .meaning =
                        "L_acc: light sent to the eye in all iterations, per irradiance, 1/sr"},
    [PORT(STATE_OTHER)] = {"state_other", TYN_SCRATCH, TYN_IMAGE_3D, RGBA,
                           .meaning = "state of every other iteration"},
    [PORT(SEEN_OTHER)] = {"seen_other", TYN_SCRATCH, TYN_IMAGE_3D, VK_FORMAT_R32_SFLOAT,
                          .meaning = "L_acc of every other iteration"},
};

enum { SETUP, CELLS, START, STEP, NUM_KERNELS };

static const tyn_binding setup_bindings[] = {
    {PORT(MEDIUM), TYN_USE_UNIFORM},
    {PORT(LIGHTS), TYN_USE_STORAGE_READ},
    {PORT(GRIDS), TYN_USE_STORAGE_WRITE},
};
static const tyn_binding cells_bindings[] = {
    {PORT(MEDIUM), TYN_USE_UNIFORM},     {PORT(DENSITY), TYN_USE_SAMPLED},
    {PORT(SIGMA_A), TYN_USE_SAMPLED},    {PORT(G), TYN_USE_SAMPLED},
    {PORT(GRIDS), TYN_USE_STORAGE_READ}, {PORT(CELLS), TYN_USE_STORAGE_WRITE},
};
static const tyn_binding start_bindings[] = {
    {PORT(GRIDS), TYN_USE_STORAGE_READ}, {PORT(CAMERA), TYN_USE_UNIFORM},
    {PORT(CELLS), TYN_USE_SAMPLED},      {PORT(STATE), TYN_USE_STORAGE_WRITE},
    {PORT(SEEN), TYN_USE_STORAGE_WRITE},
};
static const tyn_binding step_bindings[] = {
    {PORT(GRIDS), TYN_USE_STORAGE_READ}, {PORT(CAMERA), TYN_USE_UNIFORM},
    {PORT(CELLS), TYN_USE_SAMPLED},      {PORT(STATE_OTHER), TYN_USE_SAMPLED},
    {PORT(SEEN_OTHER), TYN_USE_SAMPLED}, {PORT(STATE), TYN_USE_STORAGE_WRITE},
    {PORT(SEEN), TYN_USE_STORAGE_WRITE},
};

#define KERNEL(step, x, y, z, specs)                                                               \
    .name = "propagate_rect_" #step, .spirv = propagate_rect_##step##_spirv,                       \
    .spirv_size = sizeof propagate_rect_##step##_spirv,                                            \
    .args_size = sizeof(struct propagate_rect_args), .local_size = {x, y, z},                      \
    .bindings = step##_bindings, .num_bindings = sizeof step##_bindings / sizeof *step##_bindings, \
    .num_spec = specs
static const tyn_kernel kernels[NUM_KERNELS] = {
    [SETUP] = {KERNEL(setup, 64, 1, 1, 0)},
    [CELLS] = {KERNEL(cells, 4, 4, 4, 1)},
    [START] = {KERNEL(start, 8, 8, 1, 1)},
    [STEP] = {KERNEL(step, 4, 4, 4, 0)},
};

#define FIELD(name) offsetof(tyn_propagate_rect_params, name)
static const tyn_param params[] = {
    {"cells", TYN_PARAM_INT, FIELD(cells), 16, 2, 64, "cells",
     "cubic cells along the longest side of the box aligned with the light"},
    {"iterations", TYN_PARAM_INT, FIELD(iterations), 16, 1, 256, "",
     "hops from cell to cell; the paper takes about as many as cells"},
    {"init", TYN_PARAM_ENUM, FIELD(init), TYN_PROPAGATE_INIT_ENTRY, 0, 3, "",
     "light before the first hop: entry is the only one that has the right power without "
     "scattering",
     (const char *const[]){"entry", "all_transmittance", "all_absorption", "first_collision"}},
    {"last_event", TYN_PARAM_BOOL, FIELD(last_event), 1, 0, 1, "",
     "scatter once more towards the eye: hg(mu, g a) instead of the incident hg(mu, a)"},
    {"rate", TYN_PARAM_ENUM, FIELD(rate), TYN_PROPAGATE_RATE_PAPER, 0, 1, "",
     "how a hop lowers the mean cosine: paper is g^(sigma_s t), exact is exp(-(1 - g) sigma_s t)",
     (const char *const[]){"paper", "exact"}},
    {"source", TYN_PARAM_ENUM, FIELD(source), TYN_PROPAGATE_SOURCE_SCATTERED, 0, 1, "",
     "what a point of the medium sends to the eye: sigma_s L_acc, or L_acc where there is any "
     "medium",
     (const char *const[]){"scattered", "accumulated"}},
};

static tyn_result declare(tyn_builder *b, const void *data)
{
    const tyn_propagate_rect_params *p = data;
    uint32_t cells = (uint32_t)p->cells;
    tyn_build_buffer(b, PORT(GRIDS), p->num_suns * sizeof(struct propagate_grid));
    for (uint8_t port = PORT(CELLS); port <= PORT(SEEN_OTHER); port++) {
        tyn_build_image(b, port, (tyn_extent){cells, cells, cells * p->num_suns * p->channels}, 1);
    }
    return TYN_OK;
}

// Ports of a kernel's bindings. The states are written alternately to the outputs and to scratch, so
// that the last one lands in the outputs; `swap` exchanges the two.
static const uint8_t *alternate(uint8_t *out, uint32_t kernel, bool swap)
{
    for (uint32_t i = 0; i < kernels[kernel].num_bindings; i++) {
        uint8_t port = kernels[kernel].bindings[i].port;
        if (swap && (port == PORT(STATE) || port == PORT(SEEN))) {
            port += PORT(STATE_OTHER) - PORT(STATE);
        } else if (swap && (port == PORT(STATE_OTHER) || port == PORT(SEEN_OTHER))) {
            port -= PORT(STATE_OTHER) - PORT(STATE);
        }
        out[i] = port;
    }
    return out;
}

static void record(tyn_recorder *r, const void *data)
{
    const tyn_propagate_rect_params *p = data;
    const uint32_t cells = (uint32_t)p->cells, stacks = p->num_suns * p->channels;
    const uint32_t init = (uint32_t)p->init;
    const struct propagate_rect_args args = {cells, p->num_suns, p->channels, p->last_event,
                                             (uint32_t)p->rate};
    uint8_t table[TYN_MAX_BINDINGS];

    tyn_rec_dispatch(r,
                     &(tyn_dispatch){.kernel = SETUP, .cells = {p->num_suns, 1, 1}, .args = &args});
    tyn_rec_dispatch(r, &(tyn_dispatch){.kernel = CELLS,
                                        .cells = {cells, cells, cells * p->num_suns},
                                        .args = &args,
                                        .spec = &p->mode});
    bool other = p->iterations % 2 != 0; // what is written now goes to scratch
    tyn_rec_dispatch(r, &(tyn_dispatch){.kernel = START,
                                        .cells = {cells, cells, stacks},
                                        .args = &args,
                                        .ports = alternate(table, START, other),
                                        .spec = &init});
    for (int32_t m = 0; m < p->iterations; m++) {
        other = !other;
        tyn_rec_dispatch(r, &(tyn_dispatch){.kernel = STEP,
                                            .cells = {cells, cells, cells * stacks},
                                            .args = &args,
                                            .ports = alternate(table, STEP, other)});
    }
    double hops = (double)cells * cells * cells * stacks * p->iterations;
    tyn_rec_work(r, "cells", hops);
    tyn_rec_work(r, "flops", hops * 200); // counted by hand
}

const tyn_pass_desc tyn_pass_propagate_rect = {
    .name = "propagate_rect",
    .summary = "light of each directional light moved cell by cell in its aligned grid (Elek 2014)",
    .ports = ports,
    .num_ports = PROPAGATE_RECT_NUM_PORTS,
    .kernels = kernels,
    .num_kernels = NUM_KERNELS,
    .params = params,
    .num_params = sizeof params / sizeof *params,
    .params_size = sizeof(tyn_propagate_rect_params),
    .declare = declare,
    .record = record,
    .debug_port = PORT(SEEN),
    .debug_meaning = "radiance sent to the eye, middle of the stacked aligned grids",
};
