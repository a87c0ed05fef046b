// columns_average.h -- a medium averaged for columns.
//
// A medium finer than two voxels a cell is averaged first, once, as columns a cell apart would miss most
// of it and sample it often: what comes out goes in to columns instead.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/scene_args.h"
#include "shaders/beams/columns_args.h"

typedef struct tyn_columns_average_params {
    uint32_t size[3]; // tyn_columns_average_size
    uint32_t mode;    // TYN_MEDIUM_*
} tyn_columns_average_params;

// Texels of the averaged medium: two a cell, but no more than the medium has. False if averaging is not
// worth while.
bool tyn_columns_average_size(const struct medium_block *medium, const uint32_t dims[3],
                              uint32_t size[3]);

// clang-format off
#define COLUMNS_AVERAGE_PORTS(X) \
    X(COLUMNS_AVERAGE, DENSITY, density, IN, IMAGE_3D, "density, or sigma_s of unequal media"), \
    X(COLUMNS_AVERAGE, SIGMA_A, sigma_a, OPTIONAL, IMAGE_3D, "of unequal media, 1/m"), \
    X(COLUMNS_AVERAGE, G, g, OPTIONAL, IMAGE_3D, "mode COEFFICIENTS: mean cosine"), \
    X(COLUMNS_AVERAGE, MEAN_DENSITY, mean_density, OUT, IMAGE_3D, "mode DENSITY: means of the density", .format = VK_FORMAT_R32_SFLOAT), \
    X(COLUMNS_AVERAGE, MEAN_SIGMA_S, mean_sigma_s, OUT, RGBA_3D, "of unequal media: means of sigma_s, 1/m"), \
    X(COLUMNS_AVERAGE, MEAN_SIGMA_A, mean_sigma_a, OUT, RGBA_3D, "of unequal media: means of sigma_a, 1/m"), \
    X(COLUMNS_AVERAGE, MEAN_G, mean_g, OUT, RGBA_3D, \
        "mode COEFFICIENTS: root of the part of sigma_s that goes straight on")
// clang-format on
TYN_PASS(COLUMNS_AVERAGE, columns_average);
