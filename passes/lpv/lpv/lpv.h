// lpv.h -- light that has scattered: light propagation volumes (Billeter et al. 2012).
//
// A lattice of cubic cells holds the power that travels in each of them, in two bands of spherical harmonics. In each
// iteration it goes on to the 26 neighbours; what passes through a cell in all of them is its fluence. Coefficients are
// those of delta scaling, as everywhere on the lattice (passes/lpv/lpv.md).
#pragma once
#include <tyndall/pass.h>
#include <tyndall/extend/lattice_shape.h>
#include "shaders/common/bundles.h"

typedef enum tyn_lpv_inject {
    TYN_LPV_INJECT_CELLS,
    TYN_LPV_INJECT_SHADOW_MAP,
    TYN_LPV_INJECT_NONE
} tyn_lpv_inject;

typedef enum tyn_lpv_blockers {
    TYN_LPV_BLOCKERS_NONE,
    TYN_LPV_BLOCKERS_EXACT,
    TYN_LPV_BLOCKERS_FUZZY
} tyn_lpv_blockers;

typedef enum tyn_lpv_bounces { TYN_LPV_BOUNCES_ONE, TYN_LPV_BOUNCES_ALL } tyn_lpv_bounces;

typedef struct tyn_lpv_params {
    tyn_lattice_shape shape; // shape.cells is the user's "lpv.cells"
    int32_t iterations;      // 1..512
    int32_t extinction;      // LPV_EXTINCTION_*
    int32_t blockers;        // TYN_LPV_BLOCKERS_*
    int32_t inject;          // TYN_LPV_INJECT_*, for the method
    int32_t bounces;         // TYN_LPV_BOUNCES_*
    float own;               // "lpv.own", 0..1
    uint32_t reflect;        // for the method: 1 = add lpv_reflect
    uint32_t balance;        // 1: leaks and wall_power are summed
} tyn_lpv_params;

// clang-format off
#define LPV_PORTS(X) \
    X(LPV, CELLS, cells, IN, IMAGE_3D, "of lattice_cells"), \
    X(LPV, SOURCE, source, OPTIONAL, IMAGE_3D, "of the last of lattice_source, _ordinates, _lamps"), \
    X(LPV, REFLECTED, reflected, OPTIONAL, BUFFER, "of lpv_reflect"), \
    X(LPV, SCATTERED, scattered, OPTIONAL, BUFFER, "of lpv_scatter, in place of `source`"), \
    TYN_WALLS(X##_OPTIONAL, LPV), \
    X(LPV, BLOCKING, blocking, OPTIONAL, BUFFER, "of lpv_blockers"), \
    X(LPV, ENVIRONMENT, environment, OPTIONAL, BUFFER, \
        "struct env_block: its mean without suns enters at the box"), \
    X(LPV, MOMENTS, moments, OUT, RGBA_3D, \
        "stacked: fluence phi and net flux (x, y, z) of the light that has scattered, was reflected or emitted, or came " \
        "from the environment, W/m^2"), \
    X(LPV, COUNTERS, counters, OUT, BUFFER, "struct counters_block"), \
    X(LPV, LEAKS, leaks, OUT, BUFFER, "float[channel][cell], for a balance: net power from a cell out of the box, W"), \
    X(LPV, WALL_POWER, wall_power, OUT, BUFFER, \
        "vec2[channel][cell], for a balance: power that surfaces absorb of what goes to a cell, and 0, W"), \
    X(LPV, SENT_0, sent_0, SCRATCH, BUFFER, "vec4[shell][channel][cell]: what a cell sends, W"), \
    X(LPV, SENT_1, sent_1, SCRATCH, BUFFER, "the same, of the next iteration"), \
    X(LPV, SUM, sum, SCRATCH, BUFFER, "vec4[channel][cell]: power and its first moment in all iterations, W")
// clang-format on
TYN_PASS(LPV, lpv);
