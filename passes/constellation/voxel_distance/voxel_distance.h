// voxel_distance.h -- for each voxel the Euclidean distance to the nearest one that is not empty, beside the density.
//
// Exact, from the centres of voxels, in metres, also where their sides differ. After "Distance transforms of sampled
// functions" (Felzenszwalb and Huttenlocher, Theory of Computing 8, 2012): along x the distance to the nearest voxel of
// the row, then along y and z the lower envelope of the parabolas that the voxels of a column stand for. Each step is
// linear in the number of voxels. Depends on the media alone.
#pragma once
#include <tyndall/pass.h>
#include "voxel_distance_args.h"

typedef struct tyn_voxel_distance_params {
    // Set by the method.
    uint32_t mode;     // TYN_MEDIUM_*
    uint32_t emissive; // 1: media emit light; a voxel that only does is not empty
    float voxel[3];    // medium_block.voxel, m
    // 0: distances to the centres of voxels that are not empty. 1: to where the density is no longer 0 that is blended
    // between centres: such a voxel and its 26 neighbours.
    uint32_t reach;
} tyn_voxel_distance_params;

// clang-format off
#define VOXEL_DISTANCE_PORTS(X) \
    X(VOXEL_DISTANCE, DENSITY, density, IN, IMAGE_3D, "density, or sigma_s of unequal media, 1/m"), \
    X(VOXEL_DISTANCE, SIGMA_A, sigma_a, OPTIONAL, IMAGE_3D, "of unequal media, 1/m"), \
    X(VOXEL_DISTANCE, EMISSION, emission, OPTIONAL, IMAGE_3D, "of unequal media, W/(m^3 sr)"), \
    X(VOXEL_DISTANCE, VOXELS, voxels, OUT, IMAGE_3D, \
        "density and distance to the nearest voxel that is not empty, m (mode DENSITY); or sigma_t of each channel, " \
        "1/m, and the distance", .format = VK_FORMAT_R32G32_SFLOAT), \
    X(VOXEL_DISTANCE, ALONG_X, along_x, SCRATCH, IMAGE_3D, \
        "squared distance within the row, units", .format = VK_FORMAT_R32_SFLOAT), \
    X(VOXEL_DISTANCE, ALONG_Y, along_y, SCRATCH, IMAGE_3D, \
        "squared distance within the slice, units", .format = VK_FORMAT_R32_SFLOAT), \
    X(VOXEL_DISTANCE, ENVELOPE, envelope, SCRATCH, BUFFER, \
        "uint[voxel]: the voxels of a column whose parabolas are its lower envelope")
// clang-format on
TYN_PASS(VOXEL_DISTANCE, voxel_distance);
