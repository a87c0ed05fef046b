// balance.h -- where the energy of the lattice goes.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_balance_params {
    uint32_t channels;
    float tint[3];
    uint32_t num_suns;
    uint32_t num_groups; // of local lights
    uint32_t mode;       // TYN_MEDIUM_*
    float box[2][3];     // M: with surfaces, the box around everything
} tyn_balance_params;

enum {
    BALANCE_PORT_MEDIUM,      // IN buffer struct medium_block
    BALANCE_PORT_LIGHTS,      // IN optional buffer struct light_block[]
    BALANCE_PORT_CELLS,       // IN 3D, of lattice_cells
    BALANCE_PORT_MOMENTS,     // IN 3D, of lattice
    BALANCE_PORT_SOURCE,      // IN optional 3D, of the last of lattice_source, _ordinates, _lamps
    BALANCE_PORT_POWER,       // IN optional buffer, of lattice_source
    BALANCE_PORT_LEAKS,       // IN buffer, of lattice
    BALANCE_PORT_ENVIRONMENT, // IN optional buffer struct env_block, what lattice was given
    BALANCE_PORT_ORDINATES,   // IN optional buffer struct ordinates_block
    BALANCE_PORT_WALL_POWER,  // IN optional buffer, of lattice
    BALANCE_PORT_LAMP_POWER,  // IN optional buffer, of lattice_lamps
    // With surfaces, of which no axis repeats:
    TYN_BEAMS(TYN_BUNDLE_ENUM, BALANCE),     // IN optional
    TYN_RADIALS(TYN_BUNDLE_ENUM, BALANCE),   // IN optional
    TYN_GEOMETRY(TYN_BUNDLE_ENUM, BALANCE),  // IN optional
    TYN_MATERIALS(TYN_BUNDLE_ENUM, BALANCE), // IN optional
    BALANCE_PORT_EMITTERS,                   // IN optional buffer struct surface_table
    BALANCE_PORT_FOUND,                      // SCRATCH buffer struct balance_light[]
    BALANCE_PORT_BALANCE,                    // OUT buffer tyn_balance
    BALANCE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_balance;
