// impostor_camera.c -- see impostor_camera.h.
#include "impostor_camera.h"

static const tyn_port ports[] = {IMPOSTOR_CAMERA_PORTS(TYN_PORT_ROW)};

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)b;
    (void)params;
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_impostor_camera_params *p = params;
    tyn_rec_update(r, IMPOSTOR_CAMERA_PORT_TAKEN, 0, &p->camera, sizeof p->camera);
}

const tyn_pass_desc tyn_pass_impostor_camera = {
    .name = "impostor_camera",
    .summary = "the camera by which the media were marched last",
    .serves = "impostors (impostor.on)",
    .ports = ports,
    .num_ports = TYN_COUNT(ports),
    .params_size = sizeof(tyn_impostor_camera_params),
    .declare = declare,
    .record = record,
    .debug_port = IMPOSTOR_CAMERA_PORT_TAKEN,
    .debug_meaning = "the camera",
    .holds = offsetof(tyn_impostor_camera_params, hold),
};
