// lattice_lamps.h -- unscattered light of lamps and surfaces in the cells of the lattice.
#pragma once
#include <tyndall/pass.h>
#include <tyndall/extend/lattice_shape.h>
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"

typedef struct tyn_lattice_lamps_params {
    tyn_lattice_shape shape;
    uint32_t mode;     // TYN_MEDIUM_*
    uint32_t num_fine; // lamps whose power is balanced one by one, 0 to 4: the first of `radials`
    uint32_t num_lamps;
    uint32_t vpls; // 1: there may be VPLs
} tyn_lattice_lamps_params;

// clang-format off
#define LATTICE_LAMPS_PORTS(X) \
    TYN_MEDIUM(X, LATTICE_LAMPS), \
    X(LATTICE_LAMPS, CELLS, cells, IN, IMAGE_3D, "of lattice_cells"), \
    TYN_RADIALS(X, LATTICE_LAMPS), \
    TYN_WALLS(X##_OPTIONAL, LATTICE_LAMPS), \
    TYN_SHADOWS(X##_OPTIONAL, LATTICE_LAMPS), \
    X(LATTICE_LAMPS, VPL_DISTANCES, vpl_distances, OPTIONAL, IMAGE_2D, "of vpl"), \
    X(LATTICE_LAMPS, ROOMS, rooms, OPTIONAL, BUFFER, "rooms.h: with walls and maps of VPLs"), \
    X(LATTICE_LAMPS, OTHERS, others, OPTIONAL, IMAGE_3D, "`source` of suns and ordinates, which is added to"), \
    X(LATTICE_LAMPS, SOURCE, source, OUT, RGBA_3D, \
        "unscattered fluence and flux of all lights, W/m^2; channels stacked along z"), \
    X(LATTICE_LAMPS, VPL_LIGHT, vpl_light, OUT, RGBA_3D, "unscattered fluence and flux of VPLs, W/m^2"), \
    X(LATTICE_LAMPS, POWER, power, OUT, BUFFER, "struct lattice_lamp_power per group of lights and channel"), \
    X(LATTICE_LAMPS, LOSSES, losses, SCRATCH, BUFFER, "four floats per light and channel: entering, emitted, lost, 0"), \
    X(LATTICE_LAMPS, LIT, lit, SCRATCH, RGBA_3D, "fluence and flux of each group of lights, before scaling"), \
    X(LATTICE_LAMPS, UNSHADOWED, unshadowed, SCRATCH, IMAGE_3D, \
        "fluence without shadows, before scaling", .format = VK_FORMAT_R32_SFLOAT)
// clang-format on
TYN_PASS(LATTICE_LAMPS, lattice_lamps);
