// validity_mask.h -- which pixels show any medium, and where on their rays it begins, seen from behind.
//
// Navarro, Gutierrez and Seron, "Interactive HDR lighting of dynamic participating media" (The Visual Computer 24, 2008),
// section 4.2. Depends on media and camera alone.
#pragma once
#include <tyndall/pass.h>
#include "validity_mask_args.h"

typedef struct tyn_validity_mask_params {
    // Set by the method.
    uint32_t mode;     // TYN_MEDIUM_*
    uint32_t distance; // 1: empty space is skipped
    uint32_t width, height;
    struct slices_args slices;
} tyn_validity_mask_params;

// clang-format off
#define VALIDITY_MASK_PORTS(X) \
    X(VALIDITY_MASK, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    X(VALIDITY_MASK, VOXELS, voxels, IN, IMAGE_3D, "of voxel_distance"), \
    X(VALIDITY_MASK, EMISSION, emission, OPTIONAL, IMAGE_3D, "of unequal media, W/(m^3 sr)"), \
    X(VALIDITY_MASK, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    X(VALIDITY_MASK, MASK, mask, OUT, IMAGE_2D, \
        "direction of the ray (M); iFirst: the farthest slice that is not empty, counted from the nearest one in the " \
        "box, or -1", .format = VK_FORMAT_R16G16B16A16_SFLOAT)
// clang-format on
TYN_PASS(VALIDITY_MASK, validity_mask);
