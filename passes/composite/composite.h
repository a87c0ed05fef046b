// composite.h -- lays the medium over the host's picture.
#pragma once
#include <tyndall/pass.h>

typedef struct tyn_composite_params {
    uint32_t half_color; // 1: the host's image is rgba16f, 0: rgba32f
    uint32_t joint;      // 1: that image is twice as large as the medium's picture
    float depth[4];      // tyn_job.host_depth, with the two depths; joint only
} tyn_composite_params;

// clang-format off
#define COMPOSITE_PORTS(X) \
    X(COMPOSITE, RADIANCE, radiance, IN, IMAGE_2D, "radiance of the medium alone, W/(m^2 sr)"), \
    X(COMPOSITE, TRANSMITTANCE, transmittance, IN, IMAGE_2D, "transmittance to the host's surface"), \
    X(COMPOSITE, COLOR, color, INOUT, RGBA_2D, "the host's picture, linear; alpha is kept"), \
    X(COMPOSITE, HALF_DEPTH, half_depth, OPTIONAL, IMAGE_2D, "of halve_depth: where the medium's rays ended"), \
    X(COMPOSITE, FULL_DEPTH, full_depth, OPTIONAL, IMAGE_2D, "hardware depth of the host's surfaces")
// clang-format on
TYN_PASS(COMPOSITE, composite);
