// sky_seen.h -- what surfaces leave of the principal ordinates in the cells of the lattice.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/light/sky_map_args.h"

typedef struct tyn_sky_seen_params {
    float extent[3];  // medium_block.extent, m
    uint32_t dims[3]; // cells of the lattice (tyn_lattice_dims)
    uint32_t count;   // ordinates at most
    uint32_t fan;     // directions of each
} tyn_sky_seen_params;

// clang-format off
#define SKY_SEEN_PORTS(X) \
    X(SKY_SEEN, ORDINATES, ordinates, IN, BUFFER, "struct ordinates_block"), \
    X(SKY_SEEN, DIRECTIONS, directions, IN, BUFFER, "struct ordinates_block: parts of the ordinates"), \
    TYN_SKY_MAPS(X, SKY_SEEN), \
    TYN_WALLS(X##_OPTIONAL, SKY_SEEN), \
    X(SKY_SEEN, SKY_SEEN, sky_seen, OUT, BUFFER, "sky_seen.glsl: shares of the ordinates that cells see")
// clang-format on
TYN_PASS(SKY_SEEN, sky_seen);
