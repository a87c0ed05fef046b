// export.h -- a result in an image of the host.
#pragma once
#include <tyndall/pass.h>

enum { TYN_EXPORT_FLOAT, TYN_EXPORT_HALF, TYN_EXPORT_ONE };

typedef struct tyn_export_params {
    uint32_t
        kind; // TYN_EXPORT_*: the host's image is rgba32f, rgba16f, or r32f, which takes the first channel
} tyn_export_params;

// clang-format off
#define EXPORT_PORTS(X) \
    X(EXPORT, RESULT, result, IN, IMAGE_2D, "an output, as large as the view"), \
    X(EXPORT, HOST, host, INOUT, RGBA_2D, "the host's image, overwritten")
// clang-format on
TYN_PASS(EXPORT, export);
