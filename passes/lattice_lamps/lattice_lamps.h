// lattice_lamps.h -- unscattered light of lamps and surfaces in the cells of the lattice.
#pragma once
#include <tyndall/pass.h>
#include "scene/lattice_shape.h"
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"

typedef struct tyn_lattice_lamps_params {
    tyn_lattice_shape shape;
    uint32_t mode;     // TYN_MEDIUM_*
    uint32_t num_fine; // lamps whose power is balanced one by one, 0 to 4: the first of `radials`
    uint32_t num_lamps;
    uint32_t vpls; // 1: there may be VPLs
} tyn_lattice_lamps_params;

enum {
    TYN_MEDIUM(TYN_BUNDLE_ENUM, LATTICE_LAMPS),  // IN
    LATTICE_LAMPS_PORT_CELLS,                    // IN 3D, of lattice_cells
    TYN_RADIALS(TYN_BUNDLE_ENUM, LATTICE_LAMPS), // IN
    TYN_WALLS(TYN_BUNDLE_ENUM, LATTICE_LAMPS),   // IN optional
    TYN_SHADOWS(TYN_BUNDLE_ENUM, LATTICE_LAMPS), // IN optional
    LATTICE_LAMPS_PORT_VPL_DISTANCES,            // IN optional 2D, of vpl
    LATTICE_LAMPS_PORT_ROOMS,  // IN optional buffer, rooms.h: with walls and maps of VPLs
    LATTICE_LAMPS_PORT_OTHERS, // IN optional 3D: `source` of suns and ordinates, which is added to
    LATTICE_LAMPS_PORT_SOURCE, // OUT 3D RGBA32F, stacked: fluence and flux of unscattered light, W/m^2
    LATTICE_LAMPS_PORT_VPL_LIGHT, // OUT 3D RGBA32F, only with `vpls`: what of it is theirs
    LATTICE_LAMPS_PORT_POWER,     // OUT buffer struct lattice_lamp_power per group and channel
    LATTICE_LAMPS_PORT_LIT,       // SCRATCH, as the next
    LATTICE_LAMPS_PORT_UNSHADOWED,
    LATTICE_LAMPS_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_lattice_lamps;
