// lattice.h -- the light that has scattered: one solve on a lattice of cubic cells for all lights.
//
// Five passes, so that what does not change is not done again:
//   lattice_cells   the medium averaged over the cells         (again when the medium changes)
//   lattice_source  unscattered sunlight per cell              (... or a sun changes)
//   lattice_ordinates  light of the sky's principal ordinates (... or the environment)
//   lattice_lamps   unscattered light of lamps and surfaces    (... or a lamp)
//   lattice         fluence and flux of the scattered light    (... or the environment changes)
// None of them depends on the camera.
//
// Coefficients are those of delta scaling: f = g^2 for g > 0, else 0; g' = (g - f) / (1 - f),
// sigma_s' = (1 - f) sigma_s, sigma_t' = sigma_a + sigma_s'. Light scattered into the forward peak
// f counts as not scattered (Joseph, Wiscombe and Weinman 1976).
#pragma once
#include <tyndall/pass.h>
#include <tyndall/extend/lattice_shape.h>
#include "shaders/common/bundles.h"

typedef struct tyn_lattice_params {
    tyn_lattice_shape shape; // shape.cells is the user's "lattice.cells"
    int32_t sweeps;          // 1..256
    int32_t cycles;          // V-cycles of the diffusion correction after each sweep, 0..8
    uint32_t anderson;       // 1: mix the last three sweeps
    uint32_t little_shared;  // 1: as tyn_capacity has it
} tyn_lattice_params;

// clang-format off
#define LATTICE_PORTS(X) \
    X(LATTICE, CELLS, cells, IN, IMAGE_3D, "of lattice_cells"), \
    X(LATTICE, SOURCE, source, OPTIONAL, IMAGE_3D, "of the last of lattice_source, _ordinates, _lamps"), \
    X(LATTICE, ENVIRONMENT, environment, OPTIONAL, BUFFER, \
        "struct env_block: its mean without suns enters at the box"), \
    X(LATTICE, GUESS, guess, OPTIONAL, BUFFER, "of lattice_ordinates: where the solve starts"), \
    TYN_WALLS(X##_OPTIONAL, LATTICE), \
    X(LATTICE, WALL_LIGHT, wall_light, OPTIONAL, BUFFER, \
        "vec3[cell]: radiance that a cell's walls send out beside what they reflect of the lattice's light, " \
        "RGB, W/(m^2 sr)"), \
    X(LATTICE, MOMENTS, moments, OUT, RGBA_3D, \
        "stacked: fluence phi and net flux (x, y, z) of the light that has scattered, came from the " \
        "environment or was emitted, W/m^2"), \
    X(LATTICE, COUNTERS, counters, OUT, BUFFER, "struct counters_block"), \
    X(LATTICE, LEAKS, leaks, OUT, BUFFER, "net power through the box of each line of the last sweep, W"), \
    X(LATTICE, WALL_POWER, wall_power, OUT, BUFFER, \
        "vec2[channel][cell], with walls: power that the walls of a cell absorb of the light that is in " \
        "`moments`, and that `wall_light` brings, W"), \
    X(LATTICE, STATE, state, SCRATCH, BUFFER, "moments at the start of a sweep"), \
    X(LATTICE, EMITTED, emitted, SCRATCH, BUFFER, "scattered radiance per sigma_s', linear in direction"), \
    X(LATTICE, MEAN_PSI, mean_psi, SCRATCH, BUFFER, "mean radiance in a cell by direction"), \
    X(LATTICE, SWEPT, swept, SCRATCH, BUFFER, "moments after the sweep"), \
    X(LATTICE, STENCIL_LO, stencil_lo, SCRATCH, BUFFER, "conductance to -x, -y, -z; absorption"), \
    X(LATTICE, STENCIL_HI, stencil_hi, SCRATCH, BUFFER, "conductance to +x, +y, +z; sum of all"), \
    X(LATTICE, RHS, rhs, SCRATCH, BUFFER, "of the diffusion correction, W"), \
    X(LATTICE, CORRECTION, correction, SCRATCH, BUFFER, "of the fluence, W/m^2"), \
    X(LATTICE, RESULT_0, result_0, SCRATCH, BUFFER, "corrected moments, of the last three sweeps"), \
    X(LATTICE, RESULT_1, result_1, SCRATCH, BUFFER, "corrected moments"), \
    X(LATTICE, RESULT_2, result_2, SCRATCH, BUFFER, "corrected moments"), \
    X(LATTICE, CHANGE_0, change_0, SCRATCH, BUFFER, "what a sweep changed"), \
    X(LATTICE, CHANGE_1, change_1, SCRATCH, BUFFER, "what a sweep changed"), \
    X(LATTICE, CHANGE_2, change_2, SCRATCH, BUFFER, "what a sweep changed"), \
    X(LATTICE, PARTIALS, partials, SCRATCH, BUFFER, "dot products by workgroup"), \
    X(LATTICE, WEIGHTS, weights, SCRATCH, BUFFER, "shares of earlier sweeps; workgroups that have added up theirs"), \
    X(LATTICE, ARRIVED, arrived, SCRATCH, BUFFER, "radiance that arrives at walls by direction"), \
    X(LATTICE, LAUNCHES, launches, SCRATCH, BUFFER, "workgroups of the dispatches of a further cycle")
// clang-format on
TYN_PASS(LATTICE, lattice);
