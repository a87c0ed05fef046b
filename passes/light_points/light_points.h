// light_points.h -- where the texels of a host's light field are: the middles of the cells of a grid over the media's box.
#pragma once
#include <tyndall/pass.h>

typedef struct tyn_light_points_params {
    uint32_t size[3]; // texels of the host's images
} tyn_light_points_params;

// clang-format off
#define LIGHT_POINTS_PORTS(X) \
    X(LIGHT_POINTS, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    X(LIGHT_POINTS, POINTS, points, OUT, BUFFER, "vec3[], m, x fastest")
// clang-format on
TYN_PASS(LIGHT_POINTS, light_points);
