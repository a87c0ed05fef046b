// probe.h -- the light field of the lattice at points.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "passes/probe/probe_local.h"

typedef struct tyn_probe_params {
    uint32_t mode;          // TYN_MEDIUM_*
    uint32_t channels;      // of `moments`: 1 or 3
    float tint[3];          // of the one channel (tyn_lattice_shape.tint)
    uint32_t num_suns;      // 0..4
    uint32_t num_ordinates; // at most (tyn_columns_params.count); 0: there are none
    uint32_t local_lights;  // TYN_PROBE_LOCAL_*: which of the grids of "radials" shine
    // 1: without light that has not scattered: that of suns and ordinates, and of the mean of the sky
    // where there are ordinates, along them.
    uint32_t scattered_only;
    // 1: in the place of the channels the means of all of them: red: of the lattice; green: of all other light; blue: 0.
    uint32_t parts;
    float world[3][3]; // the world's axes in M: what the flux is given along
} tyn_probe_params;

// clang-format off
#define PROBE_PORTS(X) \
    X(PROBE, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    X(PROBE, LIGHTS, lights, OPTIONAL, BUFFER, "struct light_block[]"), \
    X(PROBE, MOMENTS, moments, IN, IMAGE_3D, "of lattice"), \
    TYN_BEAMS(X##_OPTIONAL, PROBE), \
    X(PROBE, ENVIRONMENT, environment, OPTIONAL, BUFFER, \
        "struct env_block: its mean without suns enters at the box"), \
    TYN_COLUMNS(X##_OPTIONAL, PROBE), \
    TYN_WALLS(X##_OPTIONAL, PROBE), \
    TYN_RADIALS(X##_OPTIONAL, PROBE), \
    TYN_SHADOWS(X##_OPTIONAL, PROBE), \
    X(PROBE, VPL_DISTANCES, vpl_distances, OPTIONAL, IMAGE_2D, "of vpl: with walls and VPLs"), \
    X(PROBE, ROOMS, rooms, OPTIONAL, BUFFER, "of cells and VPLs: rooms.h"), \
    X(PROBE, CELLS, cells, OPTIONAL, IMAGE_3D, "of lattice_cells: flux at the box's faces"), \
    X(PROBE, POINTS, points, IN, BUFFER, "vec3[], m"), \
    X(PROBE, RESULTS, results, OUT, BUFFER, "tyn_probe_result[], W/m^2"), \
    X(PROBE, COUNTERS, counters, OUT, BUFFER, "struct counters_block: channels of points that were not finite")
// clang-format on
TYN_PASS(PROBE, probe);
