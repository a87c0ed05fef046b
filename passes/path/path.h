// path.h -- the unbiased path tracer: images.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/path/path_scene.h"

// Image. The INOUT ports are histories of the image's size (the last three of 1x1 without layers).
enum {
    TYN_PATH_SCENE(TYN_BUNDLE_ENUM, PATH), // IN
    TYN_GEOMETRY(TYN_BUNDLE_ENUM, PATH),   // IN optional; without nodes all triangles are tried
    TYN_MATERIALS(TYN_BUNDLE_ENUM, PATH),  // IN optional
    PATH_PORT_CAMERA,                      // IN buffer struct camera_block
    PATH_PORT_MEAN,                        // INOUT 2D RGBA32F: radiance; a = 1 - transmittance
    PATH_PORT_LOW,                         // INOUT: what single precision loses of it
    PATH_PORT_DEVIATION,                   // INOUT: sums of squared deviations
    PATH_PORT_MEAN_SINGLE,                 // INOUT
    PATH_PORT_MEAN_MULTIPLE,               // INOUT
    PATH_PORT_MEAN_TRANSMITTANCE,          // INOUT
    PATH_PORT_RADIANCE,                    // OUT 2D RGBA32F, W/(m^2 sr); alpha
    PATH_PORT_ERROR,                       // OUT 2D RGBA32F: one standard error of the mean
    PATH_PORT_SINGLE,                      // OUT 2D RGBA32F: first order (1x1 without layers)
    PATH_PORT_MULTIPLE,                    // OUT 2D RGBA32F: higher orders and emission
    PATH_PORT_TRANSMITTANCE,               // OUT 2D RGBA32F
    PATH_PORT_COUNTERS,                    // OUT buffer struct counters_block, of this record
    PATH_PORT_PARTIALS,                    // SCRATCH
    PATH_PORT_LAYERS,                      // SCRATCH
    PATH_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_path;
