// medium.h -- the medium as the solvers read it: resampled textures, min/max bricks, distances.
//
// There are no mip levels: the lattice averages over its own cells, which are not powers of two of the
// voxels, and nothing else reads the medium coarser.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"

typedef struct tyn_medium_params {
    uint32_t mode;      // TYN_MEDIUM_*
    uint32_t direct;    // 1: the atlas itself is the density texture, only bricks are made
    uint32_t emissive;  // 1: `emission` exists, of unequal media
    uint32_t colors;    // 1: `colors` is there; then media are unequal
    uint32_t size[3];   // medium_block.size
    uint32_t bricks[3]; // medium_block.bricks
    int32_t samples;    // along each axis of a voxel at the edge of a shape, 1..8
    int32_t storage;    // of the atlas: who fills it reads "medium.storage"
} tyn_medium_params;

// clang-format off
#define MEDIUM_PORTS(X) \
    X(MEDIUM, ATLAS, atlas, IN, IMAGE_3D, "density grids of all media"), \
    X(MEDIUM, SHAPES, shapes, IN, BUFFER, "struct shape_block[]"), \
    X(MEDIUM, COLORS, colors, OPTIONAL, IMAGE_3D, "grids of colours of all media, which count as unequal"), \
    X(MEDIUM, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    X(MEDIUM, DENSITY, density, OUT, IMAGE_3D, \
        "mean density per voxel; or sigma_s, 1/m, a = mean of the channels", .format = VK_FORMAT_R32_SFLOAT), \
    X(MEDIUM, SIGMA_A, sigma_a, OUT, RGBA_3D, "absorption, 1/m; a = mean of the channels"), \
    X(MEDIUM, G, g, OUT, RGBA_3D, "mean cosine, weighted with sigma_s; a = over the channels"), \
    X(MEDIUM, EMISSION, emission, OUT, RGBA_3D, "emission, W/(m^3 sr)"), \
    X(MEDIUM, BRICKS, bricks, OUT, IMAGE_3D, \
        "least and largest value over the brick: texture values (DENSITY), sigma_t of the largest channel in " \
        "1/m (unequal media). Holds for the trilinear textures and for the exact shapes", \
        .format = VK_FORMAT_R32G32_SFLOAT), \
    X(MEDIUM, DISTANCE, distance, OUT, IMAGE_3D, \
        "Chebyshev distance in bricks to the nearest brick that is not empty, 0 = is not, at most 255", \
        .format = VK_FORMAT_R32_SFLOAT), \
    X(MEDIUM, DISTANCE_SCRATCH, distance_scratch, SCRATCH, IMAGE_3D, \
        "distance over two axes", .format = VK_FORMAT_R32_SFLOAT)
// clang-format on
TYN_PASS(MEDIUM, medium);
