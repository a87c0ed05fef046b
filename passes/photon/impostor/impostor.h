// impostor.h -- the picture of the media as it was marched last, seen by another camera (Elek et al. 2012, Sec 4.4).
//
// The march stands on a plane through the middle of the media's box, at right angles to the way from which it was made.
#pragma once
#include <tyndall/pass.h>

typedef struct tyn_impostor_params {
    uint32_t on;    // "impostor.on"
    float angle;    // "impostor.angle", degrees
    float distance; // "impostor.distance"
    // Set by the method.
    uint32_t width, height;
    uint32_t background; // 1: the environment is seen behind
} tyn_impostor_params;

// clang-format off
#define IMPOSTOR_PORTS(X) \
    X(IMPOSTOR, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    X(IMPOSTOR, TAKEN, taken, IN, BUFFER, "struct camera_block: of the march"), \
    X(IMPOSTOR, CAMERA, camera, IN, BUFFER, "struct camera_block: of the picture"), \
    X(IMPOSTOR, ENVIRONMENT, environment, IN, BUFFER, "struct env_block"), \
    X(IMPOSTOR, ENV_MAP, env_map, OPTIONAL, IMAGE_2D, "latitude-longitude map, W/(m^2 sr)"), \
    X(IMPOSTOR, MARCHED, marched, IN, IMAGE_2D, "of raymarch: radiance of the media alone"), \
    X(IMPOSTOR, LEFT, left, IN, IMAGE_2D, "of raymarch: transmittance"), \
    X(IMPOSTOR, RADIANCE, radiance, OUT, RGBA_2D, "as raymarch has it"), \
    X(IMPOSTOR, TRANSMITTANCE, transmittance, OUT, RGBA_2D, "likewise")
// clang-format on
TYN_PASS(IMPOSTOR, impostor);
