// light_field.h -- what probes found at the texels of a host's light field, as images.
#pragma once
#include <tyndall/pass.h>

typedef struct tyn_light_field_params {
    uint32_t half; // 1: the host's images are rgba16f, 0: rgba32f
} tyn_light_field_params;

// clang-format off
#define LIGHT_FIELD_PORTS(X) \
    X(LIGHT_FIELD, RESULTS, results, IN, BUFFER, "tyn_probe_result[], W/m^2, x fastest"), \
    X(LIGHT_FIELD, RED, red, INOUT, IMAGE_3D, \
        "overwritten: fluence (x) and net flux along the world's axes (y, z, w), W/m^2", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(LIGHT_FIELD, GREEN, green, INOUT, IMAGE_3D, "the same", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(LIGHT_FIELD, BLUE, blue, INOUT, IMAGE_3D, "the same", .format = VK_FORMAT_R32G32B32A32_SFLOAT)
// clang-format on
enum { LIGHT_FIELD_PORTS(TYN_PORT_ENUM), LIGHT_FIELD_NUM_PORTS };

extern const tyn_pass_desc tyn_pass_light_field;
