// rooms.h -- which cells of the lattice are joined by open links.
#pragma once
#include <tyndall/pass.h>

// Parts of the lattice that open links join; what is sealed is one of its own, which no light of virtual point lights
// (VPLs) elsewhere reaches.
typedef struct tyn_rooms_params {
    float extent[3];  // medium_block.extent, m
    uint32_t dims[3]; // cells of the lattice
} tyn_rooms_params;

enum {
    ROOMS_PORT_WALL_LINKS,    // IN buffer, of walls
    ROOMS_PORT_VPLS,          // IN buffer struct radial_vpls
    ROOMS_PORT_VPL_DISTANCES, // IN 2D, vpl_visibility.glsl
    ROOMS_PORT_ROOMS,         // OUT buffer, rooms.h
    ROOMS_PORT_FOREST,        // SCRATCH
    ROOMS_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_rooms;
