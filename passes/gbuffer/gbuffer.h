// gbuffer.h -- the surfaces that the camera sees: which triangles.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_gbuffer_params {
    int32_t samples;        // "gbuffer.samples"
    uint32_t size[2];       // of the picture, pixels; set by the method, as the next
    uint32_t num_triangles; // up to 2^29 - 2: gbuffer.glsl
    // Workgroups along x that go through a list of pixels; 0: as many as suit all devices.
    uint32_t row;
} tyn_gbuffer_params;

// clang-format off
#define GBUFFER_PORTS(X) \
    X(GBUFFER, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    TYN_GEOMETRY(X, GBUFFER), \
    TYN_GBUFFER(X##_OUT, GBUFFER), \
    X(GBUFFER, MIXED_COUNT, mixed_count, SCRATCH, BUFFER, \
        "struct gbuffer_edge_count: number of pixels whose samples see several triangles"), \
    X(GBUFFER, MIXED, mixed, SCRATCH, BUFFER, "uint[]: pixels whose samples see several triangles"), \
    X(GBUFFER, DEPTH, depth, SCRATCH, IMAGE_2D, "reversed", .format = VK_FORMAT_D32_SFLOAT)
// clang-format on
TYN_PASS(GBUFFER, gbuffer);
