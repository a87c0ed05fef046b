// gradient.h -- radiance towards the eye from few samples that know its gradient.
//
// Ren, Zhou, Lin and Guo, "Gradient-based interpolation and sampling for real-time rendering of inhomogeneous, single-scattering
// media" (Pacific Graphics 2008), sections 4 and 5.
//
// Samples stand at the points of a grid; those with a large error are replaced by points of the next one, twice as fine, and so
// on. Which ones that are stays on the device: lists and indirect dispatches. A field of cells is made of the samples.
#pragma once
#include <tyndall/pass.h>
#include "gradient_args.h"
#include "shaders/common/bundles.h"

typedef struct tyn_gradient_params {
    int32_t cells;         // "gradient.cells": of the first grid along the longest side
    int32_t grid;          // "gradient.grid": of the finest
    int32_t field;         // "gradient.field": of the field
    int32_t medium;        // "gradient.medium": texels of what light is followed through
    float epsilon;         // "gradient.epsilon"
    int32_t lights;        // "gradient.lights": distant lights that stand for the environment
    int32_t interpolation; // "gradient.interpolation": GRADIENT_*
    int32_t weight;        // "gradient.weight": 0: (W_j - 1) / R_j^3; 1: W_j as printed
    int32_t extrapolation; // "gradient.extrapolation": 0: exponential; 1: linear
    float soft;            // "gradient.soft": edges of shadows, cells of the finest grid
    int32_t multiple;      // "gradient.multiple": 1: samples read the lattice
    // Set by the method.
    uint32_t mode;        // TYN_MEDIUM_*
    float extent[3];      // medium_block.extent, m
    float voxel;          // distance of the volume's points, m: Delta in the paper
    int32_t voxels;       // along the longest side: no more cells of the field are made
    uint32_t one_channel; // 1: the lattice's light has one channel, to be multiplied with `tint`
    float tint[3];
    uint32_t num_lights; // in the list, at most
    uint32_t lamps;      // 1: some of them are lamps
} tyn_gradient_params;

// Distance of the volume's points: of a medium of few voxels that of 64 along its longest side, or of up to 256 where it is
// flat.
float tyn_gradient_voxel(const float extent[3], const float voxel[3]);
// `cells` along the longest side, or more where the medium is flatter than a fourth, at most 256.
int32_t tyn_gradient_cells(const float extent[3], int32_t cells);
// Cells of the field along the longest side.
int32_t tyn_gradient_field(const tyn_gradient_params *params);
// Points of all grids together, at most so many samples.
uint32_t tyn_gradient_points(const tyn_gradient_params *params);

// clang-format off
#define GRADIENT_PORTS(X) \
    TYN_MEDIUM(X, GRADIENT), \
    X(GRADIENT, LIGHT_LIST, light_list, IN, BUFFER, "of light_list: all lights"), \
    TYN_SHADOWS(X##_OPTIONAL, GRADIENT), \
    TYN_SKY_MAPS(X##_OPTIONAL, GRADIENT), \
    X(GRADIENT, LIGHT_SHADES, light_shades, OPTIONAL, BUFFER, "of light_list: which of the sky's directions are of which light"), \
    X(GRADIENT, SCATTERED, scattered, OPTIONAL, IMAGE_3D, \
        "of merge: light of the lattice, which has scattered before; then all is delta scaled"), \
    TYN_WALLS(X##_OPTIONAL, GRADIENT), \
    X(GRADIENT, BRICKS, bricks, OPTIONAL, IMAGE_3D, "of medium: where there is none no field is made"), \
    X(GRADIENT, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    X(GRADIENT, INSCATTER, inscatter, OUT, RGBA_3D, \
        "cells + 2: light that is scattered towards the eye, per sigma_s (with `scattered`: per sigma_s'), W/(m^2 sr)"), \
    X(GRADIENT, COUNTERS, counters, OUT, BUFFER, "struct counters_block: samples, points followed"), \
    X(GRADIENT, SAMPLES, samples, OUT, BUFFER, "struct gradient_sample[point], level after level"), \
    X(GRADIENT, STATES, states, OUT, BUFFER, "uint[point]: GRADIENT_IS_*"), \
    X(GRADIENT, HEADS, heads, SCRATCH, BUFFER, "struct gradient_head"), \
    X(GRADIENT, ENTRIES, entries, SCRATCH, BUFFER, "uint[point]: of each level, points that are sampled, in any order")
// clang-format on
TYN_PASS(GRADIENT, gradient);
