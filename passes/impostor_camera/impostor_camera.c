// impostor_camera.c -- see impostor_camera.h.
#include "impostor_camera.h"
#include "impostor_camera.comp.h"

static const tyn_port ports[] = {IMPOSTOR_CAMERA_PORTS(TYN_PORT_ROW)};

static const tyn_kernel kernels[] = {TYN_KERNEL(impostor_camera)};

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)b;
    (void)params;
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    (void)params;
    TYN_DISPATCH(r, .cells = {1, 1, 1});
}

const tyn_pass_desc tyn_pass_impostor_camera = {
    .name = "impostor_camera",
    .summary = "the camera by which the media were marched last",
    .serves = "impostors (impostor.on)",
    TYN_PASS_TABLES(tyn_impostor_camera_params),
    .debug_port = IMPOSTOR_CAMERA_PORT_TAKEN,
    .debug_meaning = "the camera",
    .holds = offsetof(tyn_impostor_camera_params, hold),
};
