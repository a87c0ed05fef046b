// wall_light.h -- light of suns and of virtual point lights (VPLs) on the walls of the cells.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

// Light of suns and of virtual point lights (VPLs) on the walls of the cells, as radiance that they send out.
typedef struct tyn_wall_light_params {
    float extent[3];   // medium_block.extent, m
    uint32_t dims[3];  // cells of the lattice
    uint32_t mode;     // TYN_MEDIUM_*
    uint32_t num_suns; // 0..4: those whose light walls reflect here
} tyn_wall_light_params;

enum {
    WALL_LIGHT_PORT_MEDIUM,                    // IN buffer struct medium_block
    WALL_LIGHT_PORT_LIGHTS,                    // IN buffer struct light_block[]
    TYN_BEAMS(TYN_BUNDLE_ENUM, WALL_LIGHT),    // IN optional
    TYN_RADIALS(TYN_BUNDLE_ENUM, WALL_LIGHT),  // IN optional: their VPLs shine on walls
    TYN_GEOMETRY(TYN_BUNDLE_ENUM, WALL_LIGHT), // IN
    TYN_WALLS(TYN_BUNDLE_ENUM, WALL_LIGHT),    // IN
    WALL_LIGHT_PORT_HITS,
    WALL_LIGHT_PORT_ROOMS,         // IN optional buffer, of rooms
    WALL_LIGHT_PORT_VPL_DISTANCES, // IN optional 2D, of vpl: power that VPLs send is what walls get
    WALL_LIGHT_PORT_WALL_LIGHT,    // OUT buffer vec3[cell]: LATTICE_PORT_WALL_LIGHT
    WALL_LIGHT_PORT_LIST,          // SCRATCH buffer, wall_light_args.h: cells that have walls
    WALL_LIGHT_PORT_ARRIVED,       // SCRATCH buffer vec3[cell]
    WALL_LIGHT_PORT_POWER,         // OUT buffer struct wall_light_power
    WALL_LIGHT_PORT_FIRST,         // SCRATCH buffer uint[1 + cells]
    WALL_LIGHT_PORT_PARTS,         // SCRATCH buffer vec3[]
    WALL_LIGHT_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_wall_light;
