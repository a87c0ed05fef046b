// lattice.h -- the light that has scattered: one solve on a lattice of cubic cells for all lights.
//
// Five passes, so that what does not change is not done again:
//   lattice_cells   the medium averaged over the cells         (again when the medium changes)
//   lattice_source  unscattered sunlight per cell              (... or a sun changes)
//   lattice_ordinates  light of the sky's principal ordinates (... or the environment)
//   lattice_lamps   unscattered light of lamps and surfaces    (... or a lamp)
//   lattice         fluence and flux of the scattered light    (... or the environment changes)
// and two around the last for sequences: lattice_recall brings the last frame's solution to this
// frame's cells, lattice_keep puts this frame's away.
// None of them depends on the camera.
//
// Coefficients are those of delta scaling: f = g^2 for g > 0, else 0; g' = (g - f) / (1 - f),
// sigma_s' = (1 - f) sigma_s, sigma_t' = sigma_a + sigma_s'. Light scattered into the forward peak
// f counts as not scattered (Joseph, Wiscombe and Weinman 1976).
#pragma once
#include <tyndall/pass.h>
#include "scene/lattice_shape.h"
#include "shaders/common/bundles.h"

typedef struct tyn_lattice_params {
    tyn_lattice_shape shape; // shape.cells is the user's "lattice.cells"
    int32_t sweeps;          // 1..256
    int32_t cycles;          // V-cycles of the diffusion correction after each sweep, 0..8
    uint32_t anderson;       // 1: mix the last three sweeps
    uint32_t warm;           // for the method: 1 = add lattice_recall and lattice_keep
} tyn_lattice_params;

enum {
    LATTICE_PORT_CELLS,       // IN 3D, of lattice_cells
    LATTICE_PORT_SOURCE,      // IN optional 3D, of the last of lattice_source, _ordinates, _lamps
    LATTICE_PORT_ENVIRONMENT, // IN optional buffer struct env_block: `sky` enters from all sides
    LATTICE_PORT_GUESS,       // IN optional buffer, of lattice_recall: where the solve starts
    TYN_WALLS(TYN_BUNDLE_ENUM, LATTICE), // IN optional
    LATTICE_PORT_WALL_LIGHT, // IN optional buffer vec3[cell]: radiance that a cell's walls send out beside
                             // what they reflect of the lattice's light, RGB, W/(m^2 sr)
    LATTICE_PORT_MOMENTS, // OUT 3D RGBA32F, stacked: fluence phi and net flux (x, y, z) of the light that
                          // has scattered, came from the environment or was emitted, W/m^2
    LATTICE_PORT_COUNTERS, // OUT buffer struct counters_block
    LATTICE_PORT_LEAKS,    // OUT buffer: what left the box in the last sweep, for balance
    LATTICE_PORT_WALL_POWER, // OUT buffer vec2[channel][cell], with walls: power that the walls of a cell
    // absorb of the light that is in `moments`, and that `wall_light` brings, W
    // Scratch buffers, see lattice.c.
    LATTICE_PORT_STATE,
    LATTICE_PORT_EMITTED,
    LATTICE_PORT_MEAN_PSI,
    LATTICE_PORT_SWEPT,
    LATTICE_PORT_STENCIL_LO,
    LATTICE_PORT_STENCIL_HI,
    LATTICE_PORT_RHS,
    LATTICE_PORT_CORRECTION,
    LATTICE_PORT_RESULT_0, // of the last three sweeps
    LATTICE_PORT_RESULT_1,
    LATTICE_PORT_RESULT_2,
    LATTICE_PORT_CHANGE_0, // of each
    LATTICE_PORT_CHANGE_1,
    LATTICE_PORT_CHANGE_2,
    LATTICE_PORT_PARTIALS,
    LATTICE_PORT_WEIGHTS,
    LATTICE_PORT_ARRIVED,
    LATTICE_PORT_LAUNCHES,
    LATTICE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_lattice;
