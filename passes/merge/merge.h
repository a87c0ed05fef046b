// merge.h -- what one view reads of the light field: radiance that scatters towards the eye, per
// cell.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

typedef struct tyn_merge_params {
    uint32_t channels;      // of `moments`: 1 or 3
    float tint[3];          // of the one channel (see tyn_lattice_tint), else 1, 1, 1
    uint32_t mode;          // TYN_MEDIUM_*, read where there are ordinates, as the next
    uint32_t repeat[3];     // medium_block.repeat
    uint32_t marched_lamps; // local lights that the march itself does, the first ones
    float reach;            // ... and so far from the others it does a part of them, m; 0: none
    uint32_t grey;          // 1: sigma_s, sigma_a and g are equal in all channels (mode DENSITY)
} tyn_merge_params;

enum {
    MERGE_PORT_MEDIUM,                   // IN buffer struct medium_block
    MERGE_PORT_CAMERA,                   // IN buffer struct camera_block
    MERGE_PORT_CELLS,                    // IN 3D, of lattice_cells
    MERGE_PORT_MOMENTS,                  // IN 3D, of lattice
    TYN_COLUMNS(TYN_BUNDLE_ENUM, MERGE), // IN optional
    MERGE_PORT_TMS,                      // IN optional 3D, of scatter_lut
    MERGE_PORT_LUT_BLOCK, // IN optional buffer struct lut_block; with ordinates or radials
    TYN_RADIALS(TYN_BUNDLE_ENUM, MERGE), // IN optional
    MERGE_PORT_LUT,                      // IN optional 2D, of scatter_lut
    TYN_SHADOWS(TYN_BUNDLE_ENUM, MERGE), // IN optional
    MERGE_PORT_VPL_LIGHT,                // IN optional 3D, of lattice_lamps
    MERGE_PORT_INSCATTER, // OUT 3D RGBA32F (one channel: R32F), dims + 2: J = max(0, (phi + 3 g' v.F) / (4 pi)
    // + sum over ordinates of E e^-tau' k + local lights, see merge_radials.comp), W/(m^2 sr), v
    // the direction from the cell to the eye, k of tms.glsl; sample at lattice_inscatter_uvw
    MERGE_PORT_COUNTERS, // OUT buffer struct counters_block: cells that were clamped or not finite
    MERGE_PORT_FIELD,    // SCRATCH buffer: J of the cells
    MERGE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_merge;
