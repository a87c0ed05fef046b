// lattice_ordinates.h -- light of the sky's principal ordinates in the cells of the lattice.
#pragma once
#include <tyndall/pass.h>
#include <tyndall/extend/lattice_shape.h>
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"

typedef struct tyn_lattice_ordinates_params {
    tyn_lattice_shape shape;
    uint32_t mode;  // TYN_MEDIUM_*
    uint32_t grey;  // 1: sigma_s, sigma_a and g are the same in all channels
    uint32_t count; // tyn_columns_params.count
    // 1: the sky's mean is among the light of the cells, by `sky_seen`; else it is the lattice that has it.
    uint32_t mean;
} tyn_lattice_ordinates_params;

// clang-format off
#define LATTICE_ORDINATES_PORTS(X) \
    X(LATTICE_ORDINATES, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    TYN_COLUMNS(X, LATTICE_ORDINATES), \
    TYN_SKY_SEEN(X##_OPTIONAL, LATTICE_ORDINATES), \
    X(LATTICE_ORDINATES, CELLS, cells, IN, IMAGE_3D, "of lattice_cells"), \
    X(LATTICE_ORDINATES, SUNLIGHT, sunlight, OPTIONAL, IMAGE_3D, "`source` of lattice_source, which is added to"), \
    X(LATTICE_ORDINATES, SOURCE, source, OUT, RGBA_3D, \
        "unscattered fluence and flux of suns and ordinates, W/m^2; channels stacked along z"), \
    X(LATTICE_ORDINATES, EVEN, even, OUT, RGBA_3D, "what of `source` is the sky's mean; exists with `sky_seen`"), \
    X(LATTICE_ORDINATES, GUESS, guess, OUT, BUFFER, \
        "vec4[channel][cell]: what of the mean would have scattered if nothing absorbed it: where the solve may start"), \
    X(LATTICE_ORDINATES, MEAN_PSI, mean_psi, SCRATCH, BUFFER, \
        "float[direction][channel][cell]: the sky's mean along the lattice's lines")
// clang-format on
TYN_PASS(LATTICE_ORDINATES, lattice_ordinates);
