// halve_depth.h -- the host's depth for a view of half its size: of 2 x 2 texels the least and the largest in turn, as on a
// chessboard, so that each side of an edge keeps a ray nearby.
#pragma once
#include <tyndall/pass.h>

typedef struct tyn_halve_depth_params {
    uint32_t unused; // of no parameters
} tyn_halve_depth_params;

// clang-format off
#define HALVE_DEPTH_PORTS(X) \
    X(HALVE_DEPTH, FULL_DEPTH, full_depth, IN, IMAGE_2D, "hardware depth of the host's surfaces"), \
    X(HALVE_DEPTH, HALF_DEPTH, half_depth, OUT, IMAGE_2D, "the same, half as large", .format = VK_FORMAT_R32_SFLOAT)
// clang-format on
TYN_PASS(HALVE_DEPTH, halve_depth);
