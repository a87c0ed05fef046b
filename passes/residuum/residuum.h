// residuum.h -- light that has lost its direction, moved on in one grid for all ordinates.
//
// Elek et al. 2014, section 5.4: once the mean cosine in all aligned grids is small, what is left in
// them is merged by power into one grid along the medium's axes and handed on there to the six
// neighbours in equal parts; what it sends to the eye is the same in all directions.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/beams/propagate_args.h"

typedef struct tyn_residuum_params {
    uint32_t on;         // for the method, no kernel of this pass reads it, as the two below
    float epsilon;       // mean cosine that counts as none
    int32_t after;       // iterations before, instead of Eq 10; 0 = Eq 10
    int32_t cells;       // along the longest side, 4..64
    int32_t iterations;  // 0..256
    uint32_t num_grids;  // set by the method, as all below
    uint32_t grid_cells; // of propagate_rect, along the longest side
    uint32_t channels;   // of propagate_rect
    uint32_t mode;       // TYN_MEDIUM_*
    float extent[3];     // medium_block.extent, m
} tyn_residuum_params;

// Eq 10: hops of length `hop` (m) after which light of mean cosine `a` has one below `epsilon`, in a medium
// of mean scattering coefficient sigma_s (1/m). Where it never does, UINT32_MAX; where the first
// scattering is enough (g <= 0), that many hops as are a mean free path.
uint32_t tyn_residuum_after(float a, float g, float sigma_s, float hop, float epsilon);

enum {
    TYN_MEDIUM(TYN_BUNDLE_ENUM, RESIDUUM), // IN
    RESIDUUM_PORT_PLACES,                  // IN buffer, of propagate_rect
    RESIDUUM_PORT_LIGHT,                   // IN 3D, of propagate_rect
    RESIDUUM_PORT_RESIDUUM, // OUT 3D RGBA32F, cubic cells that span the medium's box (lattice.glsl): light
                            // to the eye per unit of sigma_s, W/(m^2 sr)
    RESIDUUM_PORT_STATE, // OUT buffer vec4[], after the last iteration: light at the faces of a cell, its
                         // power per area of a face, W/m^2; x fastest
    RESIDUUM_PORT_STATE_OTHER, // SCRATCH, so
    RESIDUUM_PORT_KEPT,        // SCRATCH buffer vec4[]: transmittance of half a cell
    RESIDUUM_PORT_SUM,         // SCRATCH buffer vec4[]: light of all iterations, W/m^2
    RESIDUUM_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_residuum;
