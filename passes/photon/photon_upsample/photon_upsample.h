// photon_upsample.h -- the cache of photons at the places of finer cells.
#pragma once
#include <tyndall/pass.h>
#include <tyndall/extend/lattice_shape.h>
#include "shaders/common/bundles.h"

typedef struct tyn_photon_upsample_params {
    tyn_lattice_shape shape; // of the cache
    uint32_t lobes;          // of a cell
    int32_t cells;           // "photon_upsample.cells": of the result, along the longest side
    int32_t filter;          // "photon_upsample.filter"
    int32_t lobe;            // "photon_upsample.lobe"
    uint32_t mode;           // TYN_MEDIUM_*
    float majorant;          // of the medium, 1/m
    uint32_t weighted;       // 1: the light of a cell is the mean over its medium
    uint32_t scaled;         // 1: the light is that of a delta scaled medium
} tyn_photon_upsample_params;

// clang-format off
#define PHOTON_UPSAMPLE_PORTS(X) \
    TYN_MEDIUM(X, PHOTON_UPSAMPLE), \
    X(PHOTON_UPSAMPLE, CELLS, cells, IN, IMAGE_3D, "of lattice_cells: the medium in the cache's cells"), \
    X(PHOTON_UPSAMPLE, LIGHT, light, IN, BUFFER, "of photon_cache"), \
    X(PHOTON_UPSAMPLE, FLUENCE, fluence, OUT, RGBA_3D, \
        "of each lobe, stacked along z: fluence, W/m^2, and the penetration depth, scatterings"), \
    X(PHOTON_UPSAMPLE, WAY, way, OUT, RGBA_3D, "its net flux over its fluence")
// clang-format on
TYN_PASS(PHOTON_UPSAMPLE, photon_upsample);
