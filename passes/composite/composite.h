// composite.h -- lays the medium over the host's picture.
#pragma once
#include <tyndall/pass.h>

typedef struct tyn_composite_params {
    uint32_t half_color; // 1: the host's image is rgba16f, 0: rgba32f
} tyn_composite_params;

enum {
    COMPOSITE_PORT_RADIANCE = 0,
    COMPOSITE_PORT_TRANSMITTANCE,
    COMPOSITE_PORT_COLOR,
    COMPOSITE_NUM_PORTS
};

extern const tyn_pass_desc tyn_pass_composite;
