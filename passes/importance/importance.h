// importance.h -- from which directions light matters for the picture.
//
// Elek et al. 2014, section 5.2: importance leaves the camera as light would and is moved from cell to
// cell of a grid in the camera's pyramid; what leaves the medium after its last scattering, by
// direction, is the map. Light seen straight through the medium is not in it: no method makes the
// background out of ordinates.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "importance_args.h"

typedef struct tyn_importance_params {
    int32_t cells;      // along each side of the grid, 8..32
    int32_t iterations; // hops from cell to cell, 1..128
    float smoothing;    // weight of the frames before, 0..0.95
    float floor;        // least value of the map, whose mean is 1
    uint32_t mode;      // set by the method: TYN_MEDIUM_*
    uint32_t scaled; // set by the method: 1 = scattering within the delta of the delta-scaled phase
                     // function is not scattering (it reaches the eye by other ways than ordinates)
    uint32_t time; // set by the method: of the frame. With smoothing another one is another step of
                   // the filter; without, 0
} tyn_importance_params;

enum {
    TYN_MEDIUM(TYN_BUNDLE_ENUM, IMPORTANCE), // IN
    IMPORTANCE_PORT_CAMERA,                  // IN buffer struct camera_block
    IMPORTANCE_PORT_HISTORY,                 // INOUT buffer struct importance_history
    IMPORTANCE_PORT_IMPORTANCE, // OUT 2D R32F: importance by the direction light comes from, latitude and
                                // longitude of M (environment_uv); mean over the sphere 1
    // OUT 3D RGBA32F, the grid: importance scattered, 1/m^3 per picture; times its mean cosine
    // about the column; sigma_t, 1/m.
    IMPORTANCE_PORT_FIELD,
    IMPORTANCE_PORT_GRID,  // OUT buffer struct importance_grid
    IMPORTANCE_PORT_CELLS, // SCRATCH buffer struct importance_cell[]
    IMPORTANCE_PORT_LIGHT, // SCRATCH buffer struct importance_light[]
    IMPORTANCE_PORT_LIGHT_OTHER,
    IMPORTANCE_PORT_TRACKS, // SCRATCH buffer vec2[]: sum of power times length, and times spread
    IMPORTANCE_PORT_SENT, // SCRATCH buffer float[]: what leaves the medium along a direction, 1/sr
    IMPORTANCE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_importance;
