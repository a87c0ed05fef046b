// medium.h -- the medium as the solvers read it: resampled textures, min/max bricks, distances.
//
// There are no mip levels: the lattice averages over its own cells, which are not powers of two of the
// voxels, and nothing else reads the medium coarser.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"

enum { TYN_MEDIUM_STORAGE_AUTO, TYN_MEDIUM_STORAGE_HALF, TYN_MEDIUM_STORAGE_FLOAT };

typedef struct tyn_medium_params {
    uint32_t mode;      // TYN_MEDIUM_*
    uint32_t direct;    // 1: the atlas itself is the density texture, only bricks are made
    uint32_t emissive;  // 1: `emission` exists in mode COEFFICIENTS
    uint32_t size[3];   // medium_block.size
    uint32_t bricks[3]; // medium_block.bricks
    int32_t samples;    // along each axis of a voxel at the edge of a shape, 1..8
    int32_t storage;    // TYN_MEDIUM_STORAGE_*, of the atlas: what fills it reads this
} tyn_medium_params;

enum {
    MEDIUM_PORT_ATLAS,                   // IN 3D
    MEDIUM_PORT_SHAPES,                  // IN buffer struct shape_block[]
    TYN_MEDIUM(TYN_BUNDLE_ENUM, MEDIUM), // the block IN, the rest OUT
    MEDIUM_PORT_BRICKS, // OUT 3D RG32F: least and largest value over the brick: texture values
    // (DENSITY), sigma_t of the largest channel in 1/m (COEFFICIENTS). Holds for
    // the trilinear textures and for the exact shapes
    MEDIUM_PORT_DISTANCE, // OUT 3D R32F: Chebyshev distance in bricks to the nearest brick that is not
                          // empty, 0 = is not, at most 255
    MEDIUM_PORT_DISTANCE_SCRATCH, // SCRATCH
    MEDIUM_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_medium;
