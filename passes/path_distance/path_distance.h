// path_distance.h -- where surfaces are, in the middles of the pixels.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_path_distance_params {
    uint32_t width, height; // of the picture
} tyn_path_distance_params;
// clang-format off
#define PATH_DISTANCE_PORTS(X) \
    X(PATH_DISTANCE, CAMERA, camera, IN, BUFFER, "struct camera_block: rays of the pixels"), \
    TYN_GEOMETRY(X, PATH_DISTANCE), \
    X(PATH_DISTANCE, RADIANCE, radiance, OUT, IMAGE_2D, \
        "piece_light.glsl: surfaces as the ray march takes them, in the dark", .format = VK_FORMAT_R32G32B32A32_UINT), \
    X(PATH_DISTANCE, SEEN, seen, OUT, IMAGE_2D, "gbuffer.glsl: the first surface", .format = VK_FORMAT_R32_UINT)
// clang-format on
TYN_PASS(PATH_DISTANCE, path_distance);
