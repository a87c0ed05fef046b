// guides.h -- albedo and normal of the surfaces that the camera sees first: what denoisers read beside a picture.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_guides_params {
    uint32_t size[2];  // of the picture, pixels
    uint32_t textured; // 1: materials may have textures; else none is looked at
} tyn_guides_params;

// Without surfaces nothing is connected but the camera, and the images are 0.
// clang-format off
#define GUIDES_PORTS(X) \
    X(GUIDES, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    TYN_GEOMETRY(X##_OPTIONAL, GUIDES), \
    TYN_MATERIALS(X##_OPTIONAL, GUIDES), \
    TYN_GBUFFER(X##_OPTIONAL, GUIDES), \
    X(GUIDES, ALBEDO, albedo, OUT, RGBA_2D, \
        "means over the pixel: albedo, 0 where there is no surface; share that shows one"), \
    X(GUIDES, NORMAL, normal, OUT, RGBA_2D, \
        "mean normal for shading, world, towards the camera; 0 where there is no surface")
// clang-format on
TYN_PASS(GUIDES, guides);
