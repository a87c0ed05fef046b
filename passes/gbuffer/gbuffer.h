// gbuffer.h -- the surfaces that the camera sees: where, which way they face, what they reflect and emit.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_gbuffer_params {
    int32_t samples;  // "gbuffer.samples"
    uint32_t size[2]; // of the picture, pixels; set by the method, as the two below
    uint32_t num_triangles;
    uint32_t textured; // 1: materials may have textures; else none is looked at
    // Workgroups along x that go through a list of pixels; 0: as many as suit all devices.
    uint32_t row;
} tyn_gbuffer_params;

enum {
    GBUFFER_PORT_CAMERA,                     // IN buffer struct camera_block
    TYN_GEOMETRY(TYN_BUNDLE_ENUM, GBUFFER),  // IN
    TYN_MATERIALS(TYN_BUNDLE_ENUM, GBUFFER), // IN
    GBUFFER_PORT_DISTANCES,                  // OUT 2D R32F: gbuffer.glsl, as the two below
    GBUFFER_PORT_FACING,                     // OUT 2D RGBA32UI
    GBUFFER_PORT_COLOURS,                    // OUT 2D RGBA32UI
    // OUT buffers, gbuffer_edge_args.h: pixels that show several pieces of surface.
    GBUFFER_PORT_EDGE_COUNT,
    GBUFFER_PORT_EDGES,
    // SCRATCH buffers, the same of pixels whose samples see several triangles.
    GBUFFER_PORT_MIXED_COUNT,
    GBUFFER_PORT_MIXED,
    GBUFFER_PORT_SEEN,  // SCRATCH 2D R32UI: triangle + 1
    GBUFFER_PORT_DEPTH, // SCRATCH 2D D32
    GBUFFER_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_gbuffer;
