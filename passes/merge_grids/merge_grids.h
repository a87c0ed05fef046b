// merge_grids.h -- what all aligned grids send to the eye, in one grid along the medium's own axes.
//
// Elek et al. 2014, section 5.3: the aligned grids lie askew, so that theirs has cells of half their size. Radial
// grids of lamps come in by power as well: what they hold is r^2 L_acc, and 1 / r^2 is integrated over each
// cell.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/beams/propagate_args.h"

typedef struct tyn_merge_grids_params {
    int32_t finer;       // cells of the result per cell of the aligned grids, along an axis; 1..8
    uint32_t num_grids;  // of propagate_rect; set by the method, as all below
    uint32_t grid_cells; // of propagate_rect, along the longest side
    uint32_t channels;   // of propagate_rect and propagate_radial
    uint32_t num_lamps;  // grids of propagate_radial
    uint32_t lamp_cells; // of its maps, along a side
    uint32_t num_vpls;   // grids of another node of propagate_radial
    uint32_t vpl_cells;
    uint32_t mode;   // TYN_MEDIUM_*
    float extent[3]; // medium_block.extent, m
} tyn_merge_grids_params;

enum {
    TYN_MEDIUM(TYN_BUNDLE_ENUM, MERGE_GRIDS), // IN
    MERGE_GRIDS_PORT_PLACES,                  // IN optional buffer, of propagate_rect
    MERGE_GRIDS_PORT_SEEN,                    // IN optional 3D, of propagate_rect
    MERGE_GRIDS_PORT_LAMP_PLACES,             // IN optional buffer, of propagate_radial
    MERGE_GRIDS_PORT_LAMP_SEEN,               // IN optional 3D, of propagate_radial
    MERGE_GRIDS_PORT_VPL_PLACES,              // so
    MERGE_GRIDS_PORT_VPL_SEEN,
    MERGE_GRIDS_PORT_RESIDUUM, // IN optional 3D RGBA32F: of residuum, added
    MERGE_GRIDS_PORT_MERGED, // OUT 3D RGBA32F, cubic cells that span the medium's box (lattice.glsl):
    // rgb = light to the eye per unit of sigma_s, W/(m^2 sr); a = mean sigma_s
    // of the cell and the channels, 1/m
    MERGE_GRIDS_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_merge_grids;
