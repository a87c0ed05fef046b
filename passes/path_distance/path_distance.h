// path_distance.h -- where surfaces are, in the middles of the pixels.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_path_distance_params {
    uint32_t width, height; // of the picture
} tyn_path_distance_params;
enum {
    PATH_DISTANCE_PORT_CAMERA,                    // IN buffer struct camera_block
    TYN_GEOMETRY(TYN_BUNDLE_ENUM, PATH_DISTANCE), // IN
    PATH_DISTANCE_PORT_RADIANCE,                  // OUT 2D RG32UI: none, packed_colour.glsl
    PATH_DISTANCE_PORT_DISTANCES,                 // OUT 2D R32F, m; 0: none
    PATH_DISTANCE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_path_distance;
