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
    X(PATH, MEAN, mean, INOUT, IMAGE_2D, \
        "running mean radiance, W/(m^2 sr)", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(PATH, LOW, low, INOUT, IMAGE_2D, \
        "what single precision loses of the mean", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(PATH, DEVIATION, deviation, INOUT, IMAGE_2D, \
        "running sum of squared deviations; A: running mean alpha", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(PATH, MEAN_SINGLE, mean_single, INOUT, IMAGE_2D, \
        "running mean of the first order", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(PATH, MEAN_MULTIPLE, mean_multiple, INOUT, IMAGE_2D, \
        "running mean of higher orders", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(PATH, MEAN_TRANSMITTANCE, mean_transmittance, INOUT, IMAGE_2D, \
        "running mean transmittance", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(PATH, RESUMED, resumed, OPTIONAL, IMAGE_2D, "radiance that is gone on from"), \
    X(PATH, RESUMED_LOW, resumed_low, OPTIONAL, IMAGE_2D, "as low"), \
    X(PATH, RESUMED_DEVIATION, resumed_deviation, OPTIONAL, IMAGE_2D, "as deviation"), \
    X(PATH, RESUMED_SINGLE, resumed_single, OPTIONAL, IMAGE_2D, "as mean_single"), \
    X(PATH, RESUMED_MULTIPLE, resumed_multiple, OPTIONAL, IMAGE_2D, "as mean_multiple"), \
    X(PATH, RESUMED_TRANSMITTANCE, resumed_transmittance, OPTIONAL, IMAGE_2D, \
        "as mean_transmittance"), \
    X(PATH, RADIANCE, radiance, OUT, IMAGE_2D, \
        "radiance W/(m^2 sr), alpha", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(PATH, ERROR, error, OUT, IMAGE_2D, \
        "standard error of the radiance, W/(m^2 sr)", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(PATH, SINGLE, single, OUT, IMAGE_2D, \
        "first-order scattering, W/(m^2 sr)", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(PATH, MULTIPLE, multiple, OUT, IMAGE_2D, \
        "higher orders and emission, W/(m^2 sr)", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(PATH, TRANSMITTANCE, transmittance, OUT, IMAGE_2D, \
        "transmittance of the media", .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(PATH, COUNTERS, counters, OUT, BUFFER, "collisions, cut paths, non-finite samples"), \
    X(PATH, PARTIALS, partials, SCRATCH, BUFFER, "statistics of each thread"), \
    X(PATH, LAYERS, layers, SCRATCH, BUFFER, "layers of each thread"), \
    X(PATH, QUEUE, queue, SCRATCH, BUFFER, "uint: how many slots threads have taken")
// clang-format on
enum { PATH_PORTS(TYN_PORT_ENUM), PATH_NUM_PORTS };
extern const tyn_pass_desc tyn_pass_path;
