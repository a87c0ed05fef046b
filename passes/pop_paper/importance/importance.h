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
    uint32_t on;        // 1: ordinates are weighted with it
    uint32_t mode;      // set by the method: TYN_MEDIUM_*
    uint32_t scaled; // set by the method: 1 = scattering within the delta of the delta-scaled phase
                     // function is not scattering (it reaches the eye by other ways than ordinates)
    uint32_t time; // set by the method: of the frame. With smoothing another one is another step of
                   // the filter; without, 0
} tyn_importance_params;

// clang-format off
#define IMPORTANCE_PORTS(X) \
    TYN_MEDIUM(X, IMPORTANCE), \
    X(IMPORTANCE, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    X(IMPORTANCE, HISTORY, history, INOUT, BUFFER, "struct importance_history"), \
    X(IMPORTANCE, IMPORTANCE, importance, OUT, IMAGE_2D, \
        "importance by the direction light comes from, latitude and longitude of M (environment_uv); mean " \
        "over the sphere 1", .format = VK_FORMAT_R32_SFLOAT), \
    X(IMPORTANCE, FIELD, field, OUT, RGBA_3D, \
        "the grid: importance scattered, 1/m^3 per picture; times its mean cosine about the column; sigma_t, " \
        "1/m"), \
    X(IMPORTANCE, GRID, grid, OUT, BUFFER, "struct importance_grid"), \
    X(IMPORTANCE, CELLS, cells, SCRATCH, BUFFER, "struct importance_cell[]"), \
    X(IMPORTANCE, LIGHT, light, SCRATCH, BUFFER, "struct importance_light[]"), \
    X(IMPORTANCE, LIGHT_OTHER, light_other, SCRATCH, BUFFER, "struct importance_light[]: of every other iteration"), \
    X(IMPORTANCE, TRACKS, tracks, SCRATCH, BUFFER, "vec2[]: sum of power times length, and times spread"), \
    X(IMPORTANCE, SENT, sent, SCRATCH, BUFFER, "float[]: what leaves the medium along a direction, 1/sr")
// clang-format on
TYN_PASS(IMPORTANCE, importance);
