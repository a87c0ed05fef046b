// path_distance.c -- tables and dispatch of the distances to surfaces.
#include "path_distance.h"
#include "passes/path_distance_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_path_distance_params *p = params;
    tyn_build_image(b, PATH_DISTANCE_PORT_RADIANCE, (tyn_extent){p->width, p->height, 1}, 1);
    tyn_build_image(b, PATH_DISTANCE_PORT_SEEN, (tyn_extent){p->width, p->height, 1}, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_path_distance_params *p = params;
    TYN_DISPATCH(r, .cells = {p->width, p->height, 1});
}

const tyn_pass_desc tyn_pass_path_distance = {
    .name = "path_distance",
    .summary = "distances to the surfaces that the camera sees",
    TYN_PASS_TABLES(tyn_path_distance_params),
    .debug_port = PATH_DISTANCE_PORT_SEEN,
    .debug_meaning = "distance to the first surface",
};
