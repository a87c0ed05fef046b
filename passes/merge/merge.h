// merge.h -- what one view reads of the light field: radiance that scatters towards the eye, per
// cell.
#pragma once
#include <tyndall/pass.h>

typedef struct tyn_merge_params {
    uint32_t channels; // of `moments`: 1 or 3
} tyn_merge_params;

enum {
    MERGE_PORT_MEDIUM,    // IN buffer struct medium_block
    MERGE_PORT_CAMERA,    // IN buffer struct camera_block
    MERGE_PORT_CELLS,     // IN 3D, of lattice_cells
    MERGE_PORT_MOMENTS,   // IN 3D, of lattice
    MERGE_PORT_INSCATTER, // OUT 3D RGBA32F (one channel: R32F), dims + 2: J = max(0, phi + 3 g' v.F) / (4 pi), W/(m^2 sr), v the
                          // direction from the cell to the eye; sample at lattice_inscatter_uvw
    MERGE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_merge;
