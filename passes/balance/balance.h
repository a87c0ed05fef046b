// balance.h -- where the energy of the lattice goes.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_balance_params {
    uint32_t channels;
    float tint[3];
    uint32_t num_suns;
    uint32_t num_groups; // of local lights
    uint32_t vpls;       // 1: the last of them are virtual point lights
    uint32_t mode;       // TYN_MEDIUM_*
    float box[2][3];     // M: with surfaces, the box around everything
} tyn_balance_params;

// clang-format off
#define BALANCE_PORTS(X) \
    X(BALANCE, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    X(BALANCE, LIGHTS, lights, OPTIONAL, BUFFER, "struct light_block[]"), \
    X(BALANCE, CELLS, cells, IN, IMAGE_3D, "of lattice_cells"), \
    X(BALANCE, MOMENTS, moments, IN, IMAGE_3D, "of lattice"), \
    X(BALANCE, SOURCE, source, OPTIONAL, IMAGE_3D, "of the last of lattice_source, _ordinates, _lamps"), \
    X(BALANCE, POWER, power, OPTIONAL, BUFFER, "of lattice_source"), \
    X(BALANCE, LEAKS, leaks, IN, BUFFER, "of lattice"), \
    X(BALANCE, ENVIRONMENT, environment, OPTIONAL, BUFFER, \
        "struct env_block: its mean without suns enters at the box"), \
    X(BALANCE, ORDINATES, ordinates, OPTIONAL, BUFFER, "struct ordinates_block"), \
    X(BALANCE, DIRECTIONS, directions, OPTIONAL, BUFFER, \
        "struct ordinates_block: of all light of a sky that surfaces hide"), \
    X(BALANCE, WALL_POWER, wall_power, OPTIONAL, BUFFER, "of lattice"), \
    X(BALANCE, LAMP_POWER, lamp_power, OPTIONAL, BUFFER, "of lattice_lamps"), \
    TYN_BEAMS(X##_OPTIONAL, BALANCE), \
    TYN_RADIALS(X##_OPTIONAL, BALANCE), \
    TYN_GEOMETRY(X##_OPTIONAL, BALANCE), \
    TYN_MATERIALS(X##_OPTIONAL, BALANCE), \
    X(BALANCE, EMITTERS, emitters, OPTIONAL, BUFFER, "struct surface_table"), \
    X(BALANCE, FOUND, found, SCRATCH, BUFFER, "struct balance_light[]"), \
    X(BALANCE, BALANCE, balance, OUT, BUFFER, "tyn_balance, W")
// clang-format on
TYN_PASS(BALANCE, balance);
