// radial_beam.h -- optical depth from local lights outwards, in a grid around each.
#pragma once
#include <tyndall/pass.h>
#include "scene_args.h"
#include "radial_args.h"

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
    RADIAL_BEAM_PORT_MEDIUM,  // IN buffer struct medium_block
    RADIAL_BEAM_PORT_DENSITY, // IN 3D: density, or sigma_s in mode COEFFICIENTS
    RADIAL_BEAM_PORT_SIGMA_A, // IN optional 3D: mode COEFFICIENTS, as the one below
    RADIAL_BEAM_PORT_G,
    RADIAL_BEAM_PORT_VPLS,    // IN optional buffer struct radial_vpls
    RADIAL_BEAM_PORT_RADIALS, // OUT buffer struct radial_block, as long as its lights need
    RADIAL_BEAM_PORT_COLUMN, // OUT 3D R32F (mode DENSITY): mean texture value between light and point
    RADIAL_BEAM_PORT_TAU_S, // OUT 3D RGBA32F (mode COEFFICIENTS): mean sigma_s, as the two below
    RADIAL_BEAM_PORT_TAU_A, // ... sigma_a
    RADIAL_BEAM_PORT_TAU_P, // ... (1 - f) sigma_s, f = g^2 for g > 0
    RADIAL_BEAM_PORT_LAMPS, // SCRATCH
    RADIAL_BEAM_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_radial_beam;

// A point or spot light of the scene as a radial light; `index` = its place among all lights that are no suns.
struct radial_light tyn_radial_of_lamp(const struct light_block *lamp, uint32_t index);

// Fills what the method sets: lamps sorted by their intensity, the first `fine` of them in fine grids.
void tyn_radial_beam_plan(tyn_radial_beam_params *params, const struct medium_block *medium,
                          const struct light_block *lights, uint32_t first_lamp,
                          uint32_t num_lights, uint32_t fine, uint32_t max_vpls);
