// merge_grids.h -- what all aligned grids send to the eye, in one grid along the medium's own axes.
//
// Elek et al. 2014, section 5.3: the aligned grids lie askew, so that theirs has cells of half their size. Radial
// grids of lamps come in by power as well: what they hold is r^2 L_acc, and 1 / r^2 is integrated over each
// cell.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "../common/propagate_args.h"

typedef struct tyn_merge_grids_params {
    int32_t finer;       // cells of the result per cell of the aligned grids, along an axis; 1..8
    uint32_t num_grids;  // of propagate_rect; set by the method, as all below
    uint32_t grid_cells; // of propagate_rect, along the longest side or across the light
    uint32_t grid_along; // of propagate_rect, along the light; 0 = cubes
    uint32_t channels;   // of propagate_rect and propagate_radial
    uint32_t num_lamps;  // grids of propagate_radial
    uint32_t lamp_cells; // of its maps, along a side
    uint32_t num_vpls;   // grids of another node of propagate_radial
    uint32_t vpl_cells;
    uint32_t mode;   // TYN_MEDIUM_*
    float extent[3]; // medium_block.extent, m
} tyn_merge_grids_params;

// clang-format off
#define MERGE_GRIDS_PORTS(X) \
    TYN_MEDIUM(X, MERGE_GRIDS), \
    X(MERGE_GRIDS, PLACES, places, OPTIONAL, BUFFER, "struct propagate_place[], of propagate_rect"), \
    X(MERGE_GRIDS, SEEN, seen, OPTIONAL, IMAGE_3D, "of propagate_rect: L_acc, 1/sr"), \
    X(MERGE_GRIDS, LAMP_PLACES, lamp_places, OPTIONAL, BUFFER, \
        "struct propagate_radial_place[], of propagate_radial"), \
    X(MERGE_GRIDS, LAMP_SEEN, lamp_seen, OPTIONAL, IMAGE_3D, "of propagate_radial: r^2 L_acc, 1/sr"), \
    X(MERGE_GRIDS, VPL_PLACES, vpl_places, OPTIONAL, BUFFER, "struct propagate_radial_place[]"), \
    X(MERGE_GRIDS, VPL_SEEN, vpl_seen, OPTIONAL, IMAGE_3D, "of propagate_radial: r^2 L_acc, 1/sr"), \
    X(MERGE_GRIDS, RESIDUUM, residuum, OPTIONAL, IMAGE_3D, "of residuum: light to the eye, W/(m^2 sr)"), \
    X(MERGE_GRIDS, MERGED, merged, OUT, RGBA_3D, \
        "cubic cells that span the medium's box (lattice.glsl): rgb = light to the eye per unit of sigma_s, " \
        "W/(m^2 sr); a = mean sigma_s of the cell and the channels, 1/m")
// clang-format on
TYN_PASS(MERGE_GRIDS, merge_grids);
