// rsm.h -- reflective shadow maps: what each light shines on, and the power reflected there; and of the sky, which shines from
// everywhere, places that stand for all surfaces.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/light/rsm_args.h"
#include "rsm_draw_args.h"
#include "rsm_sky_args.h"
#include "shaders/surfaces/surface_args.h"

typedef struct tyn_rsm_params {
    int32_t sky_texels; // "rsm.sky_texels"
    // Set by the method:
    uint32_t size[2]; // of the atlas, texels
    uint32_t num_triangles;
    float extent[3];              // medium_block.extent, m; 0 without media
    float near_lo[3], near_hi[3]; // tyn_frame_scene.near_lo, near_hi, m
    uint32_t num_tiles;           // by tyn_rsm_add
    struct rsm_tile tiles[TYN_RSM_MAX_TILES];
    struct rsm_draw_args draws[TYN_RSM_MAX_TILES];
    struct surface_range drawn[TYN_RSM_MAX_TILES][TYN_SURFACE_RANGES];
    uint32_t mode;           // TYN_MEDIUM_*
    struct rsm_sky_args sky; // by tyn_rsm_add_sky; texels 0: without the sky
} tyn_rsm_params;

// Adds the map of a light, or one face of it, with all triangles: `drawn` may leave out what is not
// in view. `kind`: TYN_SHADOW_*; a face of a CUBE ends where the angle to its axis is 45 degrees,
// even if the map goes on. `clip`: rows, world -> clip space. `light`: its place in "suns" or
// "lights". `texel`: of a sun its area across the light, m^2; of a lamp the solid angle of a texel in
// the middle, sr.
void tyn_rsm_add(tyn_rsm_params *params, const struct rsm_tile *tile, uint32_t kind,
                 const tyn_vec4 clip[4], uint32_t light, float texel);

// Adds the places under the sky below all maps: two tiles, of fronts and of backs, as lights TYN_RSM_SKY and the next. `fan`: of
// the sky's directions; `cells`: of the lattice that has columns, or NULL if nothing dims the sky. After num_triangles, extent,
// near_lo, near_hi and size.
void tyn_rsm_add_sky(tyn_rsm_params *params, uint32_t fan, const uint32_t cells[3]);

// clang-format off
#define RSM_PORTS(X) \
    TYN_GEOMETRY(X, RSM), \
    TYN_MATERIALS(X, RSM), \
    X(RSM, SUNS, suns, IN, BUFFER, "struct light_block[]"), \
    X(RSM, LIGHTS, lights, IN, BUFFER, "struct light_block[]: directional lights, then lamps"), \
    X(RSM, MEDIUM, medium, OPTIONAL, BUFFER, "struct medium_block: with the sky"), \
    TYN_SKY_MAPS(X##_OPTIONAL, RSM), \
    X(RSM, ORDINATES, ordinates, OPTIONAL, BUFFER, "struct ordinates_block: the sky's directions"), \
    X(RSM, COLUMNS, columns, OPTIONAL, BUFFER, "optical depths along the ordinates"), \
    TYN_RSM(X##_OUT, RSM), \
    X(RSM, AREAS, areas, SCRATCH, BUFFER, "rsm_sky_args.h: float[]"), \
    X(RSM, AREA_BLOCKS, area_blocks, SCRATCH, BUFFER, "rsm_sky_args.h: float[]"), \
    X(RSM, DEPTH, depth, SCRATCH, IMAGE_2D, "reversed", .format = VK_FORMAT_D32_SFLOAT)
// clang-format on
TYN_PASS(RSM, rsm);
