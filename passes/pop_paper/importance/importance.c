// importance.c -- see importance.h.
#include "importance.h"
#include "passes/importance_tables.h"
#include "shaders/common/scene_args.h"

#define PORT(name) IMPORTANCE_PORT_##name

#define FIELD_OF(name) offsetof(tyn_importance_params, name)
static const tyn_param params[] = {
    {"on", TYN_PARAM_BOOL, FIELD_OF(on), 1, 0, 1, "",
     "weight directions of the environment with their importance for the picture"},
    {"cells", TYN_PARAM_INT, FIELD_OF(cells), 16, 8, 32, "cells",
     "along each side of the grid in the camera's pyramid"},
    {"iterations", TYN_PARAM_INT, FIELD_OF(iterations), 16, 1, 128, "",
     "hops from cell to cell; as many as cells, more scatter too much"},
    {"smoothing", TYN_PARAM_FLOAT, FIELD_OF(smoothing), 0, 0, 0.95, "",
     "weight of the frames before, from one time index to the next; above 0 a picture depends on "
     "them"},
    {"floor", TYN_PARAM_FLOAT, FIELD_OF(floor), 0.1, 0, 1, "",
     "least importance of a direction; the mean is 1"},
};

static tyn_result declare(tyn_builder *b, const void *data)
{
    const tyn_importance_params *p = data;
    const uint32_t n = (uint32_t)p->cells;
    const uint64_t cells = (uint64_t)n * n * n;
    tyn_build_image(b, PORT(IMPORTANCE),
                    (tyn_extent){TYN_IMPORTANCE_WIDTH, TYN_IMPORTANCE_HEIGHT, 1}, 1);
    tyn_build_image(b, PORT(FIELD), (tyn_extent){n, n, n}, 1);
    tyn_build_buffer(b, PORT(GRID), sizeof(struct importance_grid));
    tyn_build_buffer(b, PORT(CELLS), cells * sizeof(struct importance_cell));
    tyn_build_buffer(b, PORT(LIGHT), cells * sizeof(struct importance_light));
    tyn_build_buffer(b, PORT(LIGHT_OTHER), cells * sizeof(struct importance_light));
    tyn_build_buffer(b, PORT(TRACKS), cells * 2 * sizeof(float));
    tyn_build_buffer(b, PORT(SENT), TYN_IMPORTANCE_TEXELS * sizeof(float));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *data)
{
    const tyn_importance_params *p = data;
    const uint32_t n = (uint32_t)p->cells;
    const struct importance_args args = {n, p->scaled, p->smoothing, p->floor};
    const tyn_extent grid = {n, n, n};
    static const uint8_t swapped[] = {PORT(CELLS), PORT(LIGHT), PORT(LIGHT_OTHER), PORT(TRACKS)};

    TYN_DISPATCH(r, .kernel = KERNEL_SETUP, .cells = {1, 1, 1}, .args = &args);
    TYN_DISPATCH(r, .kernel = KERNEL_CELLS, .cells = grid, .args = &args, .spec = &p->mode);
    for (int32_t i = 0; i < p->iterations; i++) {
        TYN_DISPATCH(r, .kernel = KERNEL_STEP, .cells = grid, .args = &args,
                     .ports = i % 2 == 0 ? swapped : NULL);
    }
    TYN_DISPATCH(r, .kernel = KERNEL_FIELD, .cells = grid, .args = &args);
    TYN_DISPATCH(r, .kernel = KERNEL_SEND, .cells = {TYN_IMPORTANCE_RAYS, TYN_IMPORTANCE_TEXELS, 1},
                 .args = &args);
    TYN_DISPATCH(r, .kernel = KERNEL_MAP, .cells = {TYN_IMPORTANCE_GROUP, 1, 1}, .args = &args);
    double hops = (double)n * n * n * p->iterations;
    double steps = (double)TYN_IMPORTANCE_TEXELS * TYN_IMPORTANCE_RAYS * TYN_IMPORTANCE_RAYS *
                   TYN_IMPORTANCE_STEPS;
    tyn_rec_work(r, "cells", hops);
    tyn_rec_work(r, "steps", steps);
    tyn_rec_work(r, "flops", hops * 150 + steps * 70); // counted by hand
}

const tyn_pass_desc tyn_pass_importance = {
    .name = "importance",
    .summary = "directions whose light matters for the picture (Elek 2014, section 5.2)",
    .serves = "ordinates that follow what the camera sees (importance.on)",
    TYN_PASS_TABLES(tyn_importance_params),
    TYN_SETTINGS(params),
    .debug_port = PORT(IMPORTANCE),
    .debug_meaning = "importance by direction, latitude and longitude of the medium's frame",
};
