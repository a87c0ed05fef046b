// sky_seen.h -- what surfaces leave of the principal ordinates in the cells of the lattice.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/light/sky_map_args.h"
#include "sky_seen_args.h"

typedef struct sky_seen_args tyn_sky_seen_params;

// clang-format off
#define SKY_SEEN_PORTS(X) \
    X(SKY_SEEN, ORDINATES, ordinates, IN, BUFFER, "struct ordinates_block"), \
    X(SKY_SEEN, DIRECTIONS, directions, IN, BUFFER, "struct ordinates_block: parts of the ordinates; their light weighs them within an ordinate"), \
    TYN_SKY_MAPS(X, SKY_SEEN), \
    TYN_WALLS(X##_OPTIONAL, SKY_SEEN), \
    X(SKY_SEEN, SKY_SEEN, sky_seen, OUT, BUFFER, "sky_seen.glsl: shares of the ordinates that cells see")
// clang-format on
TYN_PASS(SKY_SEEN, sky_seen);
