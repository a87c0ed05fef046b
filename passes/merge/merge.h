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
    uint32_t tabled;        // 1: some phase function of the medium is a table (`phases`)
} tyn_merge_params;

// clang-format off
#define MERGE_PORTS(X) \
    X(MERGE, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    X(MERGE, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    X(MERGE, CELLS, cells, IN, IMAGE_3D, "of lattice_cells"), \
    X(MERGE, MOMENTS, moments, IN, IMAGE_3D, "of lattice"), \
    TYN_COLUMNS(X##_OPTIONAL, MERGE), \
    TYN_SKY_SEEN(X##_OPTIONAL, MERGE), \
    X(MERGE, EVEN, even, OPTIONAL, IMAGE_3D, "the sky's mean in the cells, of lattice_ordinates"), \
    X(MERGE, TMS, tms, OPTIONAL, IMAGE_3D, "kernels, of scatter_lut"), \
    X(MERGE, LUT_BLOCK, lut_block, OPTIONAL, BUFFER, "struct lut_block; with ordinates or radials"), \
    TYN_RADIALS(X##_OPTIONAL, MERGE), \
    X(MERGE, LUT, lut, OPTIONAL, IMAGE_2D, "forward scattering, of scatter_lut"), \
    TYN_SHADOWS(X##_OPTIONAL, MERGE), \
    X(MERGE, PHASES, phases, OPTIONAL, BUFFER, "tables of phase functions"), \
    X(MERGE, VPL_LIGHT, vpl_light, OPTIONAL, IMAGE_3D, "of lattice_lamps"), \
    X(MERGE, INSCATTER, inscatter, OUT, RGBA_3D, \
        "(one channel: R32F), dims + 2: J = max(0, (phi + 3 g' v.F) / (4 pi) + sum over ordinates of E " \
        "e^-tau' k + local lights, see merge_radials.comp), W/(m^2 sr), v the direction from the cell to the " \
        "eye, k of tms.glsl; sample at lattice_inscatter_uvw"), \
    X(MERGE, COUNTERS, counters, OUT, BUFFER, "struct counters_block: cells that were clamped or not finite"), \
    X(MERGE, FIELD, field, SCRATCH, BUFFER, "what each cell scatters towards the eye, before the clamp at 0")
// clang-format on
TYN_PASS(MERGE, merge);
