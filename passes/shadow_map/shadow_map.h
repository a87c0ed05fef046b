// shadow_map.h -- what the lights see of the surfaces: depth maps of all of them in one atlas.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"
#include "shaders/light/shadow_args.h"
#include "shaders/surfaces/surface_args.h"

enum { TYN_SHADOW_VIEWS = TYN_SHADOW_SUNS + 6 * TYN_SHADOW_LAMPS };

typedef struct tyn_shadow_view {
    uint32_t place[2], texels; // in the atlas
    uint32_t light;            // index of shadow_args.h
    struct shadow_map_args args;
    // The plan: all; a method may leave out what is not in view.
    struct surface_range drawn[TYN_SURFACE_RANGES];
} tyn_shadow_view;

typedef struct tyn_shadow_map_params {
    int32_t sun_texels;  // "shadow_map.sun_texels"
    int32_t lamp_texels; // "shadow_map.lamp_texels"
    // Set by tyn_shadow_map_plan:
    uint32_t size[2]; // of the atlas, texels
    uint32_t num_triangles;
    uint32_t num_views;
    struct shadow_light lights[TYN_SHADOW_MAX];
    tyn_shadow_view views[TYN_SHADOW_VIEWS];
} tyn_shadow_map_params;

// Lays out the maps of suns (the first num_suns <= TYN_SHADOW_SUNS) and lamps (points and spots) for the
// sides in params, and fills the rest of params. The atlas's size depends on the kinds and numbers of lights
// alone, so that moving them changes nothing else.
void tyn_shadow_map_plan(tyn_shadow_map_params *params, const struct light_block *suns,
                         uint32_t num_suns, const struct light_block *lamps, uint32_t num_lamps,
                         const struct surface_block *surfaces);

// clang-format off
#define SHADOW_MAP_PORTS(X) \
    X(SHADOW_MAP, TRIANGLES, triangles, IN, BUFFER, "struct surface_triangle[]"), \
    X(SHADOW_MAP, VERTICES, vertices, IN, BUFFER, "struct surface_vertex[]"), \
    X(SHADOW_MAP, SHADOW_ATLAS, shadow_atlas, OUT, IMAGE_2D, \
        "reversed depth of what each light sees first; 0: nothing", .format = VK_FORMAT_D32_SFLOAT), \
    X(SHADOW_MAP, SHADOWS, shadows, OUT, BUFFER, "struct shadow_light[]: where each light's maps are")
// clang-format on
TYN_PASS(SHADOW_MAP, shadow_map);
