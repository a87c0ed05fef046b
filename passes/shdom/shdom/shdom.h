// shdom.h -- light that has scattered: spherical harmonics and discrete ordinates (Evans 1998).
//
// In each iteration the source function of the cells, in spherical harmonics, is evaluated towards the ordinates of a
// quadrature; radiance is followed along lines through the lattice, and comes back as spherical harmonics, of which the
// medium scatters so much of each band. Unscattered light comes along principal ordinates, to the cells. Forward peaks are
// delta scaled for the number of bands (passes/shdom/common/delta_bands.glsl).
#pragma once
#include <tyndall/pass.h>
#include <tyndall/extend/lattice_shape.h>
#include "shaders/common/bundles.h"

typedef struct tyn_shdom_params {
    tyn_lattice_shape shape; // shape.cells is the user's "shdom.cells"
    int32_t bands;           // 1..SHDOM_MAX_BANDS
    int32_t iterations;      // 1..512
    uint32_t mode;           // TYN_MEDIUM_*; set by the method, as the next
    uint32_t count;          // principal ordinates; 0: none are connected
    uint32_t lamps;
} tyn_shdom_params;

// clang-format off
#define SHDOM_PORTS(X) \
    X(SHDOM, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    TYN_COLUMNS(X##_OPTIONAL, SHDOM), \
    TYN_RADIALS(X##_OPTIONAL, SHDOM), \
    X(SHDOM, CELLS, cells, IN, IMAGE_3D, "of lattice_cells"), \
    X(SHDOM, SOURCE, source, OPTIONAL, IMAGE_3D, "of the last of lattice_ordinates and lattice_lamps"), \
    X(SHDOM, SENT_0, sent_0, OUT, BUFFER, \
        "float[coefficient][cell]: source function of the first channel in spherical harmonics, W/(m^3 sr)"), \
    X(SHDOM, SENT_1, sent_1, OUT, BUFFER, "of the second"), \
    X(SHDOM, SENT_2, sent_2, OUT, BUFFER, "of the third"), \
    X(SHDOM, MOMENTS, moments, OUT, RGBA_3D, \
        "stacked: fluence phi and net flux (x, y, z) of all light less `source`, W/m^2"), \
    X(SHDOM, COUNTERS, counters, OUT, BUFFER, "struct counters_block"), \
    X(SHDOM, DIRECTIONS, directions, SCRATCH, BUFFER, "vec4[ordinate]: direction of travel, weight, sr"), \
    X(SHDOM, BASIS, basis, SCRATCH, BUFFER, "float[coefficient][ordinate]"), \
    X(SHDOM, WEIGHTED, weighted, SCRATCH, BUFFER, "float[ordinate][coefficient], times the weight, sr"), \
    X(SHDOM, SKY, sky, SCRATCH, BUFFER, "float[principal ordinate][coefficient]"), \
    X(SHDOM, UNSCATTERED, unscattered, SCRATCH, BUFFER, "float[coefficient][cell]: of unscattered light, W/(m^2 sr)"), \
    X(SHDOM, RADIANCE, radiance, SCRATCH, BUFFER, "float[coefficient][cell]: of scattered light"), \
    X(SHDOM, EXTINCTION, extinction, SCRATCH, BUFFER, "float[cell]: delta scaled, 1/m"), \
    X(SHDOM, EMITTED, emitted, SCRATCH, BUFFER, "float[ordinate of a batch][cell]: source function, or radiance"), \
    X(SHDOM, LINES, lines, SCRATCH, BUFFER, "float[ordinate of a batch][slice][line]: radiance, W/(m^2 sr)")
// clang-format on
TYN_PASS(SHDOM, shdom);
