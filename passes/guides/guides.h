// guides.h -- albedo and normal of the surfaces that the camera sees first: what denoisers read beside a picture.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_guides_params {
    uint32_t size[2];  // of the picture, pixels
    int32_t samples;   // of the G-buffer, along each side of a pixel
    uint32_t textured; // 1: materials may have textures; else none is looked at
} tyn_guides_params;

// Without surfaces nothing is connected but the camera, and the images are 0.
// clang-format off
#define GUIDES_PORTS(X) \
    X(GUIDES, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    TYN_GEOMETRY(X##_OPTIONAL, GUIDES), \
    TYN_MATERIALS(X##_OPTIONAL, GUIDES), \
    TYN_GBUFFER(X##_OPTIONAL, GUIDES), \
    X(GUIDES, ALBEDO, albedo, OUT, IMAGE_2D, \
        "means over the pixel: albedo, 0 where there is no surface; share that shows one", \
        .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(GUIDES, NORMAL, normal, OUT, IMAGE_2D, \
        "mean normal for shading, world, towards the camera; 0 where there is no surface", \
        .format = VK_FORMAT_R32G32B32A32_SFLOAT)
// clang-format on
enum { GUIDES_PORTS(TYN_PORT_ENUM), GUIDES_NUM_PORTS };
extern const tyn_pass_desc tyn_pass_guides;
