// path_distance.c -- tables and dispatch of the distances to surfaces.
#include "path_distance.h"
#include "path_distance.comp.h"

static const tyn_port ports[] = {PATH_DISTANCE_PORTS(TYN_PORT_ROW)};

static const tyn_kernel kernel = TYN_KERNEL(path_distance);

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_path_distance_params *p = params;
    tyn_build_image(b, PATH_DISTANCE_PORT_RADIANCE, (tyn_extent){p->width, p->height, 1}, 1);
    tyn_build_image(b, PATH_DISTANCE_PORT_DISTANCES, (tyn_extent){p->width, p->height, 1}, 1);
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
    .ports = ports,
    .num_ports = PATH_DISTANCE_NUM_PORTS,
    .kernels = &kernel,
    .num_kernels = 1,
    .params_size = sizeof(tyn_path_distance_params),
    .declare = declare,
    .record = record,
    .debug_port = PATH_DISTANCE_PORT_DISTANCES,
    .debug_meaning = "distance to the first surface",
};
