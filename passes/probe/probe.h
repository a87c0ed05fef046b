// probe.h -- the light field of the lattice at points.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_probe_params {
    uint32_t mode;          // TYN_MEDIUM_*
    uint32_t channels;      // of `moments`: 1 or 3
    float tint[3];          // of the one channel (tyn_lattice_shape.tint)
    uint32_t num_suns;      // 0..4
    uint32_t num_ordinates; // at most (tyn_columns_params.count); 0: there are none
    uint32_t local_lights;  // 1: there are lamps or VPLs
    // 1: without light that has not scattered: that of suns and ordinates, and of the mean of the sky
    // where there are ordinates, along them.
    uint32_t scattered_only;
    float world[3][3]; // the world's axes in M: what the flux is given along
} tyn_probe_params;

enum {
    PROBE_PORT_MEDIUM,                 // IN buffer struct medium_block
    PROBE_PORT_LIGHTS,                 // IN optional buffer struct light_block[]
    PROBE_PORT_MOMENTS,                // IN 3D, of lattice
    TYN_BEAMS(TYN_BUNDLE_ENUM, PROBE), // IN optional
    PROBE_PORT_ENVIRONMENT, // IN optional buffer struct env_block, what lattice was given
    TYN_COLUMNS(TYN_BUNDLE_ENUM, PROBE), // IN optional
    TYN_WALLS(TYN_BUNDLE_ENUM, PROBE),   // IN optional
    TYN_RADIALS(TYN_BUNDLE_ENUM, PROBE), // IN optional
    TYN_SHADOWS(TYN_BUNDLE_ENUM, PROBE), // IN optional
    PROBE_PORT_VPL_DISTANCES,            // IN optional 2D, of vpl: with walls and VPLs
    PROBE_PORT_ROOMS,                    // IN optional buffer, rooms.h: with these
    PROBE_PORT_CELLS,   // IN optional 3D, of lattice_cells: flux at the box's faces
    PROBE_PORT_POINTS,  // IN buffer vec3[], M, m
    PROBE_PORT_RESULTS, // OUT buffer tyn_probe_result[]
    PROBE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_probe;
