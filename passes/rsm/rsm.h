// rsm.h -- reflective shadow maps: what each light shines on, and the power reflected there.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/light/rsm_args.h"
#include "rsm_draw_args.h"
#include "shaders/common/scene_args.h"
#include "shaders/surfaces/surface_args.h"

typedef struct tyn_rsm_params {
    int32_t sun_texels;  // "rsm.sun_texels"
    int32_t lamp_texels; // "rsm.lamp_texels"
    // Set by the method:
    uint32_t size[2]; // of the atlas, texels
    uint32_t num_triangles;
    float extent[3];    // medium_block.extent, m; 0 without media
    uint32_t num_tiles; // by tyn_rsm_add
    struct rsm_tile tiles[TYN_RSM_MAX_TILES];
    struct rsm_draw_args draws[TYN_RSM_MAX_TILES];
    struct surface_range drawn[TYN_RSM_MAX_TILES][TYN_SURFACE_RANGES];
} tyn_rsm_params;

// Adds the map of a light, or one face of it, with all triangles: `drawn` may leave out what is not
// in view. `kind`: TYN_SHADOW_*; a face of a CUBE ends where the angle to its axis is 45 degrees,
// even if the map goes on. `clip`: rows, world -> clip space. `texel`: of a sun its area across the
// light, m^2; of a lamp the solid angle of a texel in the middle, sr.
void tyn_rsm_add(tyn_rsm_params *params, const struct rsm_tile *tile, uint32_t kind,
                 const tyn_vec4 clip[4], const struct light_block *light, float texel);

// clang-format off
#define RSM_PORTS(X) \
    TYN_GEOMETRY(X, RSM), \
    TYN_MATERIALS(X, RSM), \
    X(RSM, RSM_FLUX, rsm_flux, OUT, IMAGE_2D, \
        "power that a texel reflects, W", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(RSM, RSM_POSITION, rsm_position, OUT, IMAGE_2D, \
        "where (M, m); area of it, m^2", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(RSM, RSM_NORMAL, rsm_normal, OUT, IMAGE_2D, \
        "of the surface (M), on the light's side", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(RSM, DEPTH, depth, SCRATCH, IMAGE_2D, "reversed", .format = VK_FORMAT_D32_SFLOAT)
// clang-format on
enum { RSM_PORTS(TYN_PORT_ENUM), RSM_NUM_PORTS };
extern const tyn_pass_desc tyn_pass_rsm;
