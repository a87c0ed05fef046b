// path.h -- the unbiased path tracer: images.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/path/path_scene.h"

// Image. The INOUT ports are histories of the image's size (the last three of 1x1 without layers).
// clang-format off
#define PATH_PORTS(X) \
    TYN_PATH_SCENE(X, PATH), \
    X(PATH, CAMERA, camera, IN, BUFFER, "struct camera_block: rays of the pixels"), \
    X(PATH, MEAN, mean, INOUT, RGBA_2D, "running mean radiance, W/(m^2 sr)"), \
    X(PATH, LOW, low, INOUT, RGBA_2D, "what single precision loses of the mean"), \
    X(PATH, DEVIATION, deviation, INOUT, RGBA_2D, "running sum of squared deviations; A: running mean alpha"), \
    X(PATH, MEAN_SINGLE, mean_single, INOUT, RGBA_2D, "running mean of the first order"), \
    X(PATH, MEAN_MULTIPLE, mean_multiple, INOUT, RGBA_2D, "running mean of higher orders"), \
    X(PATH, MEAN_TRANSMITTANCE, mean_transmittance, INOUT, RGBA_2D, "running mean transmittance"), \
    X(PATH, RESUMED, resumed, OPTIONAL, IMAGE_2D, "radiance that is gone on from"), \
    X(PATH, RESUMED_LOW, resumed_low, OPTIONAL, IMAGE_2D, "as low"), \
    X(PATH, RESUMED_DEVIATION, resumed_deviation, OPTIONAL, IMAGE_2D, "as deviation"), \
    X(PATH, RESUMED_SINGLE, resumed_single, OPTIONAL, IMAGE_2D, "as mean_single"), \
    X(PATH, RESUMED_MULTIPLE, resumed_multiple, OPTIONAL, IMAGE_2D, "as mean_multiple"), \
    X(PATH, RESUMED_TRANSMITTANCE, resumed_transmittance, OPTIONAL, IMAGE_2D, \
        "as mean_transmittance"), \
    X(PATH, FIELD_RED, field_red, OPTIONAL, IMAGE_3D, \
        "over the media's box: fluence (x) and net flux along M's axes of red light that has scattered, W/m^2"), \
    X(PATH, FIELD_GREEN, field_green, OPTIONAL, IMAGE_3D, "the same"), \
    X(PATH, FIELD_BLUE, field_blue, OPTIONAL, IMAGE_3D, "the same"), \
    X(PATH, GUIDE_SCATTERED, guide_scattered, OPTIONAL, IMAGE_3D, \
        "likewise, mean of all channels: of light that has scattered, but not straight on"), \
    X(PATH, GUIDE_BEAMS, guide_beams, OPTIONAL, IMAGE_3D, "the same of all other light"), \
    X(PATH, RADIANCE, radiance, OUT, RGBA_2D, "radiance W/(m^2 sr), alpha"), \
    X(PATH, ERROR, error, OUT, RGBA_2D, "standard error of the radiance, W/(m^2 sr)"), \
    X(PATH, SINGLE, single, OUT, RGBA_2D, "first-order scattering, W/(m^2 sr)"), \
    X(PATH, MULTIPLE, multiple, OUT, RGBA_2D, "higher orders and emission, W/(m^2 sr)"), \
    X(PATH, TRANSMITTANCE, transmittance, OUT, RGBA_2D, "transmittance of the media"), \
    X(PATH, COUNTERS, counters, OUT, BUFFER, "collisions, cut paths, non-finite samples"), \
    X(PATH, PARTIALS, partials, SCRATCH, BUFFER, "statistics of each thread"), \
    X(PATH, LAYERS, layers, SCRATCH, BUFFER, "layers of each thread"), \
    X(PATH, QUEUE, queue, SCRATCH, BUFFER, "uint: how many slots threads have taken")
// clang-format on
TYN_PASS(PATH, path);
