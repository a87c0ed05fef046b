// radial_beam.h -- optical depth from local lights outwards, in a grid around each.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"
#include "shaders/beams/radial_args.h"

typedef struct tyn_radial_beam_params {
    int32_t cells;     // "radial_beam.cells"
    int32_t vpl_cells; // "radial_beam.vpl_cells"
    // Set by the method (tyn_radial_beam_plan).
    uint32_t mode; // TYN_MEDIUM_*
    uint32_t num_lamps;
    uint32_t num_fine; // the first of them have `cells`
    uint32_t max_vpls; // room for VPLs, 0 to TYN_RADIAL_VPLS_MAX
    // Cells at which a map is as fine as the medium; 2 where that is the same everywhere.
    uint32_t finest;
    struct light_block lamps[TYN_RADIAL_LAMPS_MAX]; // without colours, which change nothing here
} tyn_radial_beam_params;

// clang-format off
#define RADIAL_BEAM_PORTS(X) \
    TYN_MEDIUM(X, RADIAL_BEAM), \
    X(RADIAL_BEAM, VPLS, vpls, OPTIONAL, BUFFER, "struct radial_vpls"), \
    X(RADIAL_BEAM, GRIDS, grids, OUT, BUFFER, "struct radial_block: VPLs, lamps without colours, their grids"), \
    X(RADIAL_BEAM, RADIAL_COLUMN, radial_column, OUT, IMAGE_3D, \
        "mean density (or sigma_s) from a light, or from where its ray enters, to a node", \
        .format = VK_FORMAT_R32_SFLOAT), \
    X(RADIAL_BEAM, RADIAL_TAU_A, radial_tau_a, OUT, RGBA_3D, "mean sigma_a"), \
    X(RADIAL_BEAM, RADIAL_TAU_P, radial_tau_p, OUT, RGBA_3D, "mean sigma_s outside the forward peak"), \
    X(RADIAL_BEAM, COUNTERS, counters, OUT, BUFFER, "struct counters_block: nodes that were not finite"), \
    X(RADIAL_BEAM, LAMPS, lamps, SCRATCH, BUFFER, "struct light_block[]")
// clang-format on
TYN_PASS(RADIAL_BEAM, radial_beam);

// Fills what the method sets: lamps sorted by their intensity, the first `fine` of them in fine grids. Their colours (W/sr), in
// the same order, go into `colors`, which has room for TYN_RADIAL_LAMPS_MAX.
void tyn_radial_beam_plan(tyn_radial_beam_params *params, float (*colors)[4],
                          const struct medium_block *medium, const struct light_block *lamps,
                          uint32_t num_lamps, uint32_t fine, uint32_t max_vpls);
