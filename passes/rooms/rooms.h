// rooms.h -- which cells of the lattice are joined by open links.
#pragma once
#include <tyndall/pass.h>
#include "rooms_args.h"

// Parts of the lattice that open links join; what is sealed is one of its own, which no light of virtual point lights
// (VPLs) elsewhere reaches.
typedef struct rooms_args tyn_rooms_params;

// clang-format off
#define ROOMS_PORTS(X) \
    X(ROOMS, WALL_LINKS, wall_links, IN, BUFFER, "of walls"), \
    X(ROOMS, VPLS, vpls, IN, BUFFER, "struct radial_vpls"), \
    X(ROOMS, VPL_DISTANCES, vpl_distances, IN, IMAGE_2D, "vpl_visibility.glsl: what VPLs see, m"), \
    X(ROOMS, ROOMS, rooms, OUT, BUFFER, "rooms.h: of what is outside, of each cell, of each VPL"), \
    X(ROOMS, FOREST, forest, SCRATCH, BUFFER, "rooms_forest.glsl")
// clang-format on
TYN_PASS(ROOMS, rooms);
