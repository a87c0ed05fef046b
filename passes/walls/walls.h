// walls.h -- which links between cells of the lattice the surfaces cut, and what they meet there.
//
// A cell lies wholly on the side of its centre. Light passes from cell to cell along links; a triangle
// that a link crosses stops it. Nothing leaks through closed meshes, and both ends of a link agree.
#pragma once
#include <tyndall/pass.h>
#include "bundles.h"

typedef struct tyn_walls_params {
    float extent[3];  // medium_block.extent, m
    uint32_t dims[3]; // cells of the lattice: tyn_lattice_dims
} tyn_walls_params;

enum {
    TYN_GEOMETRY(TYN_BUNDLE_ENUM, WALLS),  // IN
    TYN_MATERIALS(TYN_BUNDLE_ENUM, WALLS), // IN
    TYN_WALLS(TYN_BUNDLE_ENUM, WALLS),     // OUT
    // OUT buffer uint[link 0..13][cell]: the triangle that a cut link meets, in the low 24 bits,
    // and 255 times its share of the link in the others.
    WALLS_PORT_HITS,
    WALLS_PORT_NEAREST, // SCRATCH
    WALLS_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_walls;

// ---- wall_light -------------------------------------------------------------------------------------

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
    WALL_LIGHT_PORT_ROOMS,     // IN optional buffer, of rooms
    WALL_LIGHT_PORT_DISTANCES, // IN optional 2D, of vpl: power that VPLs send is what walls get
    WALL_LIGHT_PORT_LIGHT,     // OUT buffer vec3[cell]: LATTICE_PORT_WALL_LIGHT
    WALL_LIGHT_PORT_LIST,      // SCRATCH buffer, wall_light_args.h: cells that have walls
    WALL_LIGHT_PORT_ARRIVED,   // SCRATCH buffer vec3[cell]
    WALL_LIGHT_PORT_POWER,     // OUT buffer struct wall_light_power
    WALL_LIGHT_PORT_FIRST,     // SCRATCH buffer uint[1 + cells]
    WALL_LIGHT_PORT_PARTS,     // SCRATCH buffer vec3[]
    WALL_LIGHT_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_wall_light;

// ---- rooms ------------------------------------------------------------------------------------------

// Parts of the lattice that open links join; what is sealed is one of its own, which no light of virtual point lights
// (VPLs) elsewhere reaches.
typedef struct tyn_rooms_params {
    float extent[3];  // medium_block.extent, m
    uint32_t dims[3]; // cells of the lattice
} tyn_rooms_params;

enum {
    ROOMS_PORT_LINKS,     // IN buffer, of walls
    ROOMS_PORT_VPLS,      // IN buffer struct radial_vpls
    ROOMS_PORT_DISTANCES, // IN 2D, vpl_visibility.glsl
    ROOMS_PORT_ROOMS,     // OUT buffer, rooms.h
    ROOMS_PORT_FOREST,    // SCRATCH
    ROOMS_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_rooms;

// Triangles that the pass can tell apart.
enum { TYN_WALLS_MAX_TRIANGLES = 1 << 24 };
