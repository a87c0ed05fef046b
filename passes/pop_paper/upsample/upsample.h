// upsample.h -- what the merged grid sends to the eye, refined with the medium as guide.
//
// Joint bilateral upsampling in 3D (Elek et al. 2014, section 4.4; Kopf et al. 2007): between the eight
// nearest cells of the coarse grid those whose mean scattering coefficient is like that at the point
// count more, so that detail of the medium shows in light that was computed without it.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_upsample_params {
    int32_t cells; // along the longest side, at most; 8..256
    float range; // relative difference of sigma_s at which the weight falls to 61 %; 0 = trilinear
    uint32_t mode;    // set by the method, as all below: TYN_MEDIUM_*
    float extent[3];  // medium_block.extent, m
    uint32_t size[3]; // medium_block.size
} tyn_upsample_params;

// clang-format off
#define UPSAMPLE_PORTS(X) \
    TYN_MEDIUM(X, UPSAMPLE), \
    X(UPSAMPLE, MERGED, merged, IN, IMAGE_3D, "of merge_grids: light to the eye, W/(m^2 sr); mean sigma_s"), \
    X(UPSAMPLE, INSCATTER, inscatter, OUT, RGBA_3D, \
        "dims + 2, W/(m^2 sr): sample at lattice_inscatter_uvw; the ghost layer repeats the outer cells")
// clang-format on
TYN_PASS(UPSAMPLE, upsample);
