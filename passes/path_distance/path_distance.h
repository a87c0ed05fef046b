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
        "none: surfaces as the ray march takes them, in the dark", .format = VK_FORMAT_R32G32_UINT), \
    X(PATH_DISTANCE, DISTANCES, distances, OUT, IMAGE_2D, \
        "along the ray to the first surface, m; 0: none", .format = VK_FORMAT_R32_SFLOAT)
// clang-format on
TYN_PASS(PATH_DISTANCE, path_distance);
