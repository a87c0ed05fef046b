// vpl.h -- virtual point lights: what surfaces emit and reflect of the primary lights, once and again, as a few
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
    float near_lo[3], near_hi[3]; // tyn_frame_scene.near_lo, near_hi
    float sky_irradiance;         // on an open plane, summed over channels, W/m^2
    uint32_t num_tiles;           // of the reflective shadow maps
    struct rsm_tile tiles[TYN_RSM_MAX_TILES];
} tyn_vpl_params;

// clang-format off
#define VPL_PORTS(X) \
    TYN_MEDIUM(X##_OPTIONAL, VPL), \
    X(VPL, SUNS, suns, IN, BUFFER, "struct light_block[]"), \
    X(VPL, LIGHTS, lights, IN, BUFFER, "struct light_block[]: directional lights, then lamps"), \
    TYN_RSM(X##_OPTIONAL, VPL), \
    TYN_GEOMETRY(X##_OPTIONAL, VPL), \
    TYN_MATERIALS(X##_OPTIONAL, VPL), \
    X(VPL, VPLS, vpls, OUT, BUFFER, "struct radial_vpls"), \
    X(VPL, VPL_DISTANCES, vpl_distances, OUT, IMAGE_2D, \
        "of the first surface in every direction of a VPL, m", .format = VK_FORMAT_R32_SFLOAT), \
    X(VPL, VPL_PLANES, vpl_planes, OUT, RGBA_2D, "of these surfaces: normal towards the VPL (M), distance of it, m"), \
    X(VPL, PLAN, plan, SCRATCH, BUFFER, "struct vpl_plan"), \
    X(VPL, WEIGHTS, weights, SCRATCH, BUFFER, "float[]: of the elements"), \
    X(VPL, BLOCKS, blocks, SCRATCH, BUFFER, "float[]: sums of blocks of elements, then what is before each"), \
    X(VPL, STRATA, strata, SCRATCH, BUFFER, "struct vpl_stratum[]"), \
    X(VPL, BINS, bins, SCRATCH, BUFFER, "struct vpl_bins"), \
    X(VPL, BIN_FLUX, bin_flux, SCRATCH, RGBA_2D, "power of bins, W (rsm_args.h)"), \
    X(VPL, BIN_POSITION, bin_position, SCRATCH, RGBA_2D, "where (M, m)"), \
    X(VPL, BIN_NORMAL, bin_normal, SCRATCH, RGBA_2D, "normal (M)")
// clang-format on
TYN_PASS(VPL, vpl);
