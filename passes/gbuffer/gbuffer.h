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

// clang-format off
#define GBUFFER_PORTS(X) \
    X(GBUFFER, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    TYN_GEOMETRY(X, GBUFFER), \
    TYN_MATERIALS(X, GBUFFER), \
    X(GBUFFER, DISTANCES, distances, OUT, IMAGE_2D, \
        "along the rays of a pixel's samples, m; 0: no surface", .format = VK_FORMAT_R32_SFLOAT), \
    X(GBUFFER, FACING, facing, OUT, IMAGE_2D, \
        "what a pixel shows; normals (M) of facet and for shading, folded", .format = VK_FORMAT_R32G32B32A32_UINT), \
    X(GBUFFER, COLOURS, colours, OUT, IMAGE_2D, \
        "albedo and emission in W/(m^2 sr); of edges, triangles of samples", \
        .format = VK_FORMAT_R32G32B32A32_UINT), \
    X(GBUFFER, EDGE_COUNT, edge_count, OUT, BUFFER, \
        "struct gbuffer_edge_count: gbuffer_edge_args.h: pixels that show several pieces of surface"), \
    X(GBUFFER, EDGES, edges, OUT, BUFFER, "uint[]: pixels that show several pieces of surface"), \
    X(GBUFFER, MIXED_COUNT, mixed_count, SCRATCH, BUFFER, \
        "struct gbuffer_edge_count: the same of pixels whose samples see several triangles"), \
    X(GBUFFER, MIXED, mixed, SCRATCH, BUFFER, "uint[]: pixels whose samples see several triangles"), \
    X(GBUFFER, SEEN, seen, SCRATCH, IMAGE_2D, "index of the triangle + 1, 0: none", .format = VK_FORMAT_R32_UINT), \
    X(GBUFFER, DEPTH, depth, SCRATCH, IMAGE_2D, "reversed", .format = VK_FORMAT_D32_SFLOAT)
// clang-format on
enum { GBUFFER_PORTS(TYN_PORT_ENUM), GBUFFER_NUM_PORTS };
extern const tyn_pass_desc tyn_pass_gbuffer;
