// sky_shadows.h -- what the directions of the sky see of the surfaces: parallel depth maps of all of them in one atlas.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/light/sky_map_args.h"
#include "shaders/surfaces/surface_args.h"

typedef struct tyn_sky_shadows_params {
    int32_t texels; // "sky_shadows.texels"
    float reach;    // "sky_shadows.reach"
    // Set by the method:
    uint32_t count; // directions at most
    bool wide;      // surfaces stand beyond the reach: each direction has a second map, of all
    float near_lo[3], near_hi[3]; // tyn_frame_scene.near_lo, near_hi
    uint32_t num_triangles, num_vertices;
} tyn_sky_shadows_params;

// clang-format off
#define SKY_SHADOWS_PORTS(X) \
    X(SKY_SHADOWS, SURFACES, surfaces, IN, BUFFER, "struct surface_block"), \
    X(SKY_SHADOWS, TRIANGLES, triangles, IN, BUFFER, "struct surface_triangle[]"), \
    X(SKY_SHADOWS, VERTICES, vertices, IN, BUFFER, "struct surface_vertex[]"), \
    X(SKY_SHADOWS, ORDINATES, ordinates, IN, BUFFER, "struct ordinates_block: the directions, without their light"), \
    X(SKY_SHADOWS, SKY_ATLAS, sky_atlas, OUT, IMAGE_2D, \
        "reversed depth of what each map sees first; 0: nothing", .format = VK_FORMAT_D32_SFLOAT), \
    X(SKY_SHADOWS, SKY_MAPS, sky_maps, OUT, BUFFER, "struct shadow_light[]: of each direction, and of each around all surfaces"), \
    X(SKY_SHADOWS, CORNERS, corners, SCRATCH, BUFFER, "uint[]: vertices of each triangle")
// clang-format on
TYN_PASS(SKY_SHADOWS, sky_shadows);
