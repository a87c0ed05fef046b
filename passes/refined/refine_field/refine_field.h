// refine_field.h -- what probes found at the places of refine_points, as images in which paths end.
#pragma once
#include <tyndall/pass.h>

typedef struct tyn_refine_field_params {
    uint32_t size[3];  // texels
    float world[3][3]; // the world's axes in M
} tyn_refine_field_params;

// clang-format off
#define REFINE_FIELD_PORTS(X) \
    X(REFINE_FIELD, RESULTS, results, IN, BUFFER, "tyn_probe_result[], W/m^2, x fastest"), \
    X(REFINE_FIELD, RED, red, OUT, RGBA_3D, "fluence (x) and net flux along M's axes (y, z, w), W/m^2"), \
    X(REFINE_FIELD, GREEN, green, OUT, RGBA_3D, "the same"), \
    X(REFINE_FIELD, BLUE, blue, OUT, RGBA_3D, "the same")
// clang-format on
TYN_PASS(REFINE_FIELD, refine_field);
