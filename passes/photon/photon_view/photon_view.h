// photon_view.h -- what a view reads of the photons' light: radiance that scatters towards the eye.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_photon_view_params {
    int32_t sun;      // "photon_view.sun"
    int32_t sky;      // "photon_view.sky"
    uint32_t lobes;   // of a cell
    uint32_t mode;    // TYN_MEDIUM_*
    float axis[3];    // reference direction (M), of travel
    uint32_t has_sun; // 1: it has the first lobe
    uint32_t
        scaled; // 1: the light is that of a delta scaled medium; so is the result, per sigma_s'
} tyn_photon_view_params;

// clang-format off
#define PHOTON_VIEW_PORTS(X) \
    TYN_MEDIUM(X, PHOTON_VIEW), \
    X(PHOTON_VIEW, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    X(PHOTON_VIEW, FLUENCE, fluence, IN, IMAGE_3D, "of photon_upsample"), \
    X(PHOTON_VIEW, WAY, way, IN, IMAGE_3D, "of photon_upsample"), \
    X(PHOTON_VIEW, INSCATTER, inscatter, OUT, RGBA_3D, \
        "dims + 2: light that is scattered towards the eye, per sigma_s, W/(m^2 sr)"), \
    X(PHOTON_VIEW, COUNTERS, counters, OUT, BUFFER, "struct counters_block: cells that were not finite")
// clang-format on
TYN_PASS(PHOTON_VIEW, photon_view);
