// lpv_reflect.h -- what surfaces reflect of suns and lamps, into the cells of a light propagation volume.
//
// Every texel of the reflective shadow maps is added to the cell in front of it, on its side of all walls that are known
// ("wall_links"), with a cosine lobe about its normal and
// less what the medium takes on the way from the light. Sums are whole numbers, in units of a bound of the sum of
// all: they do not depend on the order and cannot overflow.
#pragma once
#include <tyndall/pass.h>
#include <tyndall/extend/lattice_shape.h>
#include "shaders/common/bundles.h"
#include "shaders/light/rsm_args.h"

typedef struct tyn_lpv_reflect_params {
    tyn_lattice_shape shape;
    uint32_t mode;      // TYN_MEDIUM_*
    uint32_t num_tiles; // of the reflective shadow maps
    struct rsm_tile tiles[TYN_RSM_MAX_TILES];
} tyn_lpv_reflect_params;

// clang-format off
#define LPV_REFLECT_PORTS(X) \
    TYN_MEDIUM(X, LPV_REFLECT), \
    TYN_BEAMS(X##_OPTIONAL, LPV_REFLECT), \
    TYN_RADIALS(X##_OPTIONAL, LPV_REFLECT), \
    TYN_RSM(X, LPV_REFLECT), \
    TYN_WALLS(X##_OPTIONAL, LPV_REFLECT), \
    X(LPV_REFLECT, REFLECTED, reflected, OUT, BUFFER, \
        "float unit, W; uint pad[3]; ivec4[channel][cell]: power and its first moment in that unit"), \
    X(LPV_REFLECT, COUNTERS, counters, OUT, BUFFER, "struct counters_block"), \
    X(LPV_REFLECT, PARTIALS, partials, SCRATCH, BUFFER, "float[]: power of blocks of texels, W"), \
    X(LPV_REFLECT, TILES, tiles, SCRATCH, BUFFER, "struct rsm_tile[]")
// clang-format on
TYN_PASS(LPV_REFLECT, lpv_reflect);
