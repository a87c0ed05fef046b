// residuum.h -- light that has lost its direction, moved on in one grid for all ordinates.
//
// Elek et al. 2014, section 5.4: once the mean cosine in all aligned grids is small, what is left in
// them is merged by power into one grid along the medium's axes and handed on there to the six
// neighbours in equal parts; what it sends to the eye is the same in all directions.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "../common/propagate_args.h"

typedef struct tyn_residuum_params {
    uint32_t on;         // for the method, no kernel of this pass reads it, as the two below
    float epsilon;       // mean cosine that counts as none
    int32_t after;       // iterations before, instead of Eq 10; 0 = Eq 10
    int32_t cells;       // along the longest side, 4..64
    int32_t iterations;  // 0..256
    uint32_t num_grids;  // set by the method, as all below
    uint32_t grid_cells; // of propagate_rect, along the longest side or across the light
    uint32_t grid_along; // of propagate_rect, along the light; 0 = cubes
    uint32_t channels;   // of propagate_rect
    uint32_t mode;       // TYN_MEDIUM_*
    float extent[3];     // medium_block.extent, m
} tyn_residuum_params;

// Eq 10: hops of length `hop` (m) after which light of mean cosine `a` has one below `epsilon`, in a medium
// of mean scattering coefficient sigma_s (1/m). Where it never does, UINT32_MAX; where the first
// scattering is enough (g <= 0), that many hops as are a mean free path.
uint32_t tyn_residuum_after(float a, float g, float sigma_s, float hop, float epsilon);

// clang-format off
#define RESIDUUM_PORTS(X) \
    TYN_MEDIUM(X, RESIDUUM), \
    X(RESIDUUM, PLACES, places, IN, BUFFER, "struct propagate_place[], of propagate_rect"), \
    X(RESIDUUM, LIGHT, light, IN, IMAGE_3D, "of propagate_rect: L per irradiance"), \
    X(RESIDUUM, RESIDUUM, residuum, OUT, RGBA_3D, \
        "cubic cells that span the medium's box (lattice.glsl): light to the eye per unit of sigma_s, W/(m^2 " \
        "sr)"), \
    X(RESIDUUM, STATE, state, OUT, BUFFER, \
        "vec4[], after the last iteration: light at the faces of a cell, its power per area of a face, W/m^2;" \
        " x fastest"), \
    X(RESIDUUM, STATE_OTHER, state_other, SCRATCH, BUFFER, "state of every other iteration"), \
    X(RESIDUUM, KEPT, kept, SCRATCH, BUFFER, "vec4[]: transmittance of half a cell"), \
    X(RESIDUUM, SUM, sum, SCRATCH, BUFFER, "vec4[]: light of all iterations, W/m^2")
// clang-format on
TYN_PASS(RESIDUUM, residuum);
