// refine_camera.h -- the view's camera for an image of samples that has fewer pixels.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/scene_args.h"

typedef struct tyn_refine_camera_params {
    struct camera_block camera;
} tyn_refine_camera_params;

// clang-format off
#define REFINE_CAMERA_PORTS(X) \
    X(REFINE_CAMERA, CAMERA, camera, OUT, BUFFER, "struct camera_block of the image of samples")
// clang-format on
TYN_PASS(REFINE_CAMERA, refine_camera);

// The camera whose pixels are squares of `grid` pixels of `from`, from its first pixel on; the last ones reach beyond its picture.
void tyn_refine_camera(const struct camera_block *from, uint32_t grid, struct camera_block *to);
