// wall_light.h -- light of suns or of the sky, and of virtual point lights (VPLs), on the walls of the cells.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

// As radiance that they send out. Suns or the sky: not both.
typedef struct tyn_wall_light_params {
    float extent[3];    // medium_block.extent, m
    uint32_t dims[3];   // cells of the lattice
    uint32_t mode;      // TYN_MEDIUM_*
    uint32_t num_suns;  // 0..4: those whose light walls reflect here
    uint32_t sky_whole; // 1: ordinates carry the sky's mean, too
} tyn_wall_light_params;

// clang-format off
#define WALL_LIGHT_PORTS(X) \
    X(WALL_LIGHT, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    X(WALL_LIGHT, LIGHTS, lights, IN, BUFFER, "struct light_block[]"), \
    TYN_BEAMS(X##_OPTIONAL, WALL_LIGHT), \
    TYN_RADIALS(X##_OPTIONAL, WALL_LIGHT), \
    TYN_COLUMNS(X##_OPTIONAL, WALL_LIGHT), \
    TYN_SKY_SEEN(X##_OPTIONAL, WALL_LIGHT), \
    TYN_GEOMETRY(X, WALL_LIGHT), \
    TYN_WALLS(X, WALL_LIGHT), \
    X(WALL_LIGHT, HITS, hits, IN, BUFFER, "of walls"), \
    X(WALL_LIGHT, ROOMS, rooms, OPTIONAL, BUFFER, "of rooms"), \
    X(WALL_LIGHT, VPL_DISTANCES, vpl_distances, OPTIONAL, IMAGE_2D, \
        "of vpl: power that VPLs send is what walls get"), \
    X(WALL_LIGHT, WALL_LIGHT, wall_light, OUT, BUFFER, "radiance that the walls of a cell send out, W/(m^2 sr)"), \
    X(WALL_LIGHT, LIST, list, SCRATCH, BUFFER, "struct wall_light_list, uint[]: cells that have walls"), \
    X(WALL_LIGHT, ARRIVED, arrived, SCRATCH, BUFFER, \
        "vec3[cell]: irradiance by VPLs, W/m^2, times the area of walls over dx^2"), \
    X(WALL_LIGHT, POWER, power, OUT, BUFFER, "struct wall_light_power"), \
    X(WALL_LIGHT, FIRST, first, SCRATCH, BUFFER, "uint[1 + cells]: by room, the first VPL that shines there"), \
    X(WALL_LIGHT, PARTS, parts, SCRATCH, BUFFER, "vec3[]: sums of arrived by room and part of the lattice")
// clang-format on
TYN_PASS(WALL_LIGHT, wall_light);
