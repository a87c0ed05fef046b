// shdom_view.h -- what the solution of shdom sends towards the eye.
//
// The march of the picture is not delta scaled. So the light that the solver counts as going straight on in forward peaks is
// added: f sigma_s times the radiance that goes to the eye, which a ray through the cells finds. What scatters once comes
// from the whole phase function instead of its bands (Nakajima and Tanaka 1988).
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_shdom_view_params {
    int32_t bands;     // of shdom
    uint32_t channels; // of shdom: 1 or 3
    float tint[3];     // of the one channel
    uint32_t mode;     // TYN_MEDIUM_*
    uint32_t grey;     // 1: sigma_s, sigma_a and g are equal in all channels
    uint32_t num_suns; // the first ordinates, whose light that scatters once the march draws
    uint32_t lamps;    // likewise
} tyn_shdom_view_params;

// clang-format off
#define SHDOM_VIEW_PORTS(X) \
    X(SHDOM_VIEW, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    X(SHDOM_VIEW, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    X(SHDOM_VIEW, CELLS, cells, IN, IMAGE_3D, "of lattice_cells"), \
    X(SHDOM_VIEW, SENT_0, sent_0, IN, BUFFER, "of shdom, as the next"), \
    X(SHDOM_VIEW, SENT_1, sent_1, OPTIONAL, BUFFER, "of the second channel"), \
    X(SHDOM_VIEW, SENT_2, sent_2, OPTIONAL, BUFFER, "of the third"), \
    TYN_COLUMNS(X##_OPTIONAL, SHDOM_VIEW), \
    TYN_RADIALS(X##_OPTIONAL, SHDOM_VIEW), \
    X(SHDOM_VIEW, INSCATTER, inscatter, OUT, RGBA_3D, \
        "dims + 2: light towards the eye per sigma_s, W/(m^2 sr); sample at lattice_inscatter_uvw"), \
    X(SHDOM_VIEW, COUNTERS, counters, OUT, BUFFER, "struct counters_block: cells that were clamped or not finite"), \
    X(SHDOM_VIEW, TOWARDS, towards, SCRATCH, RGBA_3D, "source function towards the eye, delta scaled, W/(m^3 sr)"), \
    X(SHDOM_VIEW, EXTINCTION, extinction, SCRATCH, RGBA_3D, "delta scaled, 1/m"), \
    X(SHDOM_VIEW, SCATTERED, scattered, SCRATCH, RGBA_3D, \
        "what of it is not emission or drawn by the march, with the whole phase function for what scatters once"), \
    X(SHDOM_VIEW, SEEN, seen, SCRATCH, RGBA_3D, "with forward peaks, per sigma_s, W/(m^2 sr); a = 1 where there is medium")
// clang-format on
TYN_PASS(SHDOM_VIEW, shdom_view);
