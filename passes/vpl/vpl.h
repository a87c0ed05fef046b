// vpl.h -- virtual point lights: what surfaces reflect of the primary lights, and what they emit, as a few
// lights of a cosine lobe.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/light/rsm_args.h"

typedef struct tyn_vpl_params {
    int32_t count;      // "vpl.count": lights at most
    int32_t visibility; // "vpl.visibility": texels of the maps of what they see

    // Set by the method:
    uint32_t mode;     // TYN_MEDIUM_*
    uint32_t num_suns; // directional lights in "lights": lamps come after them
    uint32_t emitters; // 1: there are materials that emit; 2: some of them on both sides
    uint32_t num_triangles;
    uint32_t bounces;   // 1: what VPLs light sends on all it reflects, as VPLs too
    uint32_t num_tiles; // of the reflective shadow maps
    struct rsm_tile tiles[TYN_RSM_MAX_TILES];
} tyn_vpl_params;

enum {
    TYN_MEDIUM(TYN_BUNDLE_ENUM, VPL), // IN optional
    VPL_PORT_SUNS,                    // IN buffer struct light_block[]
    VPL_PORT_LIGHTS,               // IN buffer struct light_block[]: directional lights, then lamps
    TYN_RSM(TYN_BUNDLE_ENUM, VPL), // IN optional
    TYN_GEOMETRY(TYN_BUNDLE_ENUM, VPL),  // IN optional
    TYN_MATERIALS(TYN_BUNDLE_ENUM, VPL), // IN optional
    TYN_VPLS(TYN_BUNDLE_ENUM, VPL),      // OUT
    VPL_PORT_PLAN,                       // SCRATCH buffer struct vpl_plan
    VPL_PORT_WEIGHTS,                    // SCRATCH buffer float[]: of the elements
    VPL_PORT_BLOCKS, // SCRATCH buffer float[]: sums of blocks of elements, then what is before each
    VPL_PORT_STRATA, // SCRATCH buffer struct vpl_stratum[]
    VPL_PORT_BINS,   // SCRATCH buffer struct vpl_bins
    VPL_PORT_BIN_FLUX, // SCRATCH 2D RGBA32F: of bins, as rsm_args.h has it
    VPL_PORT_BIN_POSITION,
    VPL_PORT_BIN_NORMAL,
    VPL_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_vpl;
