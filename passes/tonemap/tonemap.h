// tonemap.h -- scene-linear radiance to 8-bit sRGB for a screen or a PNG.
#pragma once
#include <tyndall/pass.h>

typedef struct tyn_tonemap_params {
    int32_t curve;     // TONEMAP_CURVE_*
    uint32_t dither;   // 1: ordered dither of +- half a step before rounding
    float exposure_ev; // set by the method: radiance is scaled by 2^exposure_ev
    uint32_t opaque;   // set by the method: alpha is 1; else colour is unpremultiplied
} tyn_tonemap_params;

enum { TONEMAP_CURVE_FILMIC = 0, TONEMAP_CURVE_LINEAR, TONEMAP_NUM_CURVES };

// clang-format off
#define TONEMAP_PORTS(X) \
    X(TONEMAP, RADIANCE, radiance, IN, IMAGE_2D, "scene-linear radiance, premultiplied, W/(m^2 sr)"), \
    X(TONEMAP, DISPLAY, display, OUT, IMAGE_2D, \
        "sRGB-encoded picture, straight alpha", .format = VK_FORMAT_R8G8B8A8_UNORM)
// clang-format on
TYN_PASS(TONEMAP, tonemap);
