// light_field.h -- what probes found at the texels of a light field, as images.
#pragma once
#include <tyndall/pass.h>
#include "light_field_args.h"

typedef struct tyn_light_field_params {
    uint32_t half; // 1: the images are rgba16f, 0: rgba32f
    struct light_field_args args;
} tyn_light_field_params;

// clang-format off
#define LIGHT_FIELD_PORTS(X) \
    X(LIGHT_FIELD, RESULTS, results, IN, BUFFER, "tyn_probe_result[], W/m^2, x fastest"), \
    X(LIGHT_FIELD, RED, red, INOUT, RGBA_3D, \
        "overwritten: fluence (x) and net flux along the images' axes (y, z, w), W/m^2"), \
    X(LIGHT_FIELD, GREEN, green, INOUT, RGBA_3D, "the same"), \
    X(LIGHT_FIELD, BLUE, blue, INOUT, RGBA_3D, "the same")
// clang-format on
TYN_PASS(LIGHT_FIELD, light_field);
