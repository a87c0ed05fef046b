// wall_light.h -- light of suns on the walls of a periodic lattice's cells, as radiance that they send out.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_wall_light_params {
    float extent[3];   // medium_block.extent, m
    uint32_t dims[3];  // cells of the lattice
    uint32_t mode;     // TYN_MEDIUM_*
    uint32_t num_suns; // 1..4
} tyn_wall_light_params;

// clang-format off
#define WALL_LIGHT_PORTS(X) \
    X(WALL_LIGHT, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    X(WALL_LIGHT, LIGHTS, lights, IN, BUFFER, "struct light_block[]"), \
    TYN_BEAMS(X, WALL_LIGHT), \
    TYN_GEOMETRY(X, WALL_LIGHT), \
    TYN_WALLS(X, WALL_LIGHT), \
    X(WALL_LIGHT, HITS, hits, IN, BUFFER, "of walls"), \
    X(WALL_LIGHT, WALL_LIGHT, wall_light, OUT, BUFFER, "radiance that the walls of a cell send out, W/(m^2 sr)")
// clang-format on
TYN_PASS(WALL_LIGHT, wall_light);
