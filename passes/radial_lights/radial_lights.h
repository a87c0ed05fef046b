// radial_lights.h -- local lights as they shine now, beside the grids that hold what the medium does to them.
//
// Apart from radial_beam, so that a lamp that flickers leaves its grid as it is.
#pragma once
#include <tyndall/pass.h>
#include "shaders/beams/radial_args.h"

typedef struct tyn_radial_lights_params {
    // Set by the method (tyn_radial_beam_plan).
    uint32_t num_lamps; // 0 to TYN_RADIAL_LAMPS_MAX
    uint32_t max_vpls;  // 0 to TYN_RADIAL_VPLS_MAX
    float colors[TYN_RADIAL_LAMPS_MAX]
                [4]; // of lamps, W/sr, in the order of their grids; [3] is not read
} tyn_radial_lights_params;

// clang-format off
#define RADIAL_LIGHTS_PORTS(X) \
    X(RADIAL_LIGHTS, GRIDS, grids, IN, BUFFER, "struct radial_block whose lamps have no colours"), \
    X(RADIAL_LIGHTS, RADIALS, radials, OUT, BUFFER, "struct radial_block"), \
    X(RADIAL_LIGHTS, COLORS, colors, SCRATCH, BUFFER, "vec4[]: of the lamps, W/sr")
// clang-format on
TYN_PASS(RADIAL_LIGHTS, radial_lights);
