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

enum {
    COLUMNS_AVERAGE_PORT_DENSITY, // IN 3D: density, or sigma_s in mode COEFFICIENTS
    COLUMNS_AVERAGE_PORT_SIGMA_A, // IN optional 3D: mode COEFFICIENTS, as the one below
    COLUMNS_AVERAGE_PORT_G,
    COLUMNS_AVERAGE_PORT_MEAN_DENSITY, // OUT 3D R32F: mode DENSITY
    COLUMNS_AVERAGE_PORT_MEAN_SIGMA_S, // OUT 3D RGBA32F: mode COEFFICIENTS, as the two below
    COLUMNS_AVERAGE_PORT_MEAN_SIGMA_A,
    COLUMNS_AVERAGE_PORT_MEAN_G,
    COLUMNS_AVERAGE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_columns_average;
