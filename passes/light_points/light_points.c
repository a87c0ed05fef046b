// light_points.c -- see light_points.h.
#include "light_points.h"
#include "passes/light_points_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_light_points_params *p = params;
    tyn_build_buffer(b, LIGHT_POINTS_PORT_POINTS,
                     3 * sizeof(float) * (uint64_t)p->size[0] * p->size[1] * p->size[2]);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_light_points_params *p = params;
    TYN_DISPATCH(r, .cells = {p->size[0], p->size[1], p->size[2]}, .args = p);
}

const tyn_pass_desc tyn_pass_light_points = {
    .name = "light_points",
    .summary = "where the texels of a light field are",
    .serves = "a host's images of the light field, and paths that end in it",
    TYN_PASS_TABLES(tyn_light_points_params),
    .media_only = true,
    .debug_port = LIGHT_POINTS_PORT_POINTS,
    .debug_meaning = "positions, m",
};
