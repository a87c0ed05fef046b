// radial_beam.h -- optical depth from local lights outwards, in a grid around each.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"
#include "shaders/beams/radial_args.h"

typedef struct tyn_radial_beam_params {
    int32_t cells;         // "radial_beam.cells"
    int32_t further_cells; // "radial_beam.further_cells"
    int32_t vpl_cells;     // "radial_beam.vpl_cells"
    // Set by the method (tyn_radial_beam_plan).
    uint32_t mode; // TYN_MEDIUM_*
    uint32_t num_lamps;
    uint32_t num_fine; // the first of them have `cells`
    uint32_t max_vpls; // room for VPLs, 0 to TYN_RADIAL_VPLS_MAX
    // Cells at which a map is as fine as the medium; 2 where that is the same everywhere.
    uint32_t finest;
    struct radial_light lamps[TYN_RADIAL_LAMPS_MAX];
} tyn_radial_beam_params;

enum {
    TYN_MEDIUM(TYN_BUNDLE_ENUM, RADIAL_BEAM),  // IN
    RADIAL_BEAM_PORT_VPLS,                     // IN optional buffer struct radial_vpls
    TYN_RADIALS(TYN_BUNDLE_ENUM, RADIAL_BEAM), // OUT
    RADIAL_BEAM_PORT_LAMPS,                    // SCRATCH
    RADIAL_BEAM_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_radial_beam;

// A point or spot light of the scene as a radial light; `index` = its place among all lights that are no suns.
struct radial_light tyn_radial_of_lamp(const struct light_block *lamp, uint32_t index);

// Fills what the method sets: lamps sorted by their intensity, the first `fine` of them in fine grids.
void tyn_radial_beam_plan(tyn_radial_beam_params *params, const struct medium_block *medium,
                          const struct light_block *lights, uint32_t first_lamp,
                          uint32_t num_lights, uint32_t fine, uint32_t max_vpls);
