// impostor_camera.h -- the camera by which the media were marched last: as given when that is done, then the same until it is
// done again.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/scene_args.h"

typedef struct tyn_impostor_camera_params {
    struct camera_block camera; // of a march made now
    uint32_t size[2];           // of the view, pixels
    tyn_hold hold; // until the view has changed so much that the media are marched again
} tyn_impostor_camera_params;

// clang-format off
#define IMPOSTOR_CAMERA_PORTS(X) \
    X(IMPOSTOR_CAMERA, TAKEN, taken, INOUT, BUFFER, "struct camera_block: of the last one, a history")
// clang-format on
TYN_PASS(IMPOSTOR_CAMERA, impostor_camera);
