// vpl_bounce_args.h -- what VPLs' light meets, gathered in bins. Included by C and GLSL; scalar layout.
//
// A bin is a cell of a grid in the box around all surfaces and a main direction of their normals. Sums are
// whole numbers, so that their order does not matter.
#include "shaders/common/shared.h"

#define VPL_BIN_CELLS 8           // of the grid along each side
#define VPL_BINS 4096             // 8 directions, of which 6 are used, of 512 cells in Morton order
#define VPL_BIN_SIDE 64           // of the image of bins, along its Hilbert curve
#define VPL_BIN_UNIT 1073741824.0 // of the power of all VPLs

struct vpl_bin {
    tyn_uint flux[3]; // of VPL_BIN_UNIT
    tyn_uint best;    // 12 bits of brightness, 20 bits: the texel of the maps that is brightest
};
TYN_ASSERT_SIZE(vpl_bin, 16);

struct vpl_bins {
    tyn_vec3 power; // of all VPLs, W
    tyn_uint pad;
    TYN_STRUCT(vpl_bin) list[VPL_BINS];
};
TYN_ASSERT_SIZE(vpl_bins, 16 + 16 * 4096);

struct vpl_bounce_args {
    tyn_uint later; // 1: bins are what VPLs of the second reflection light
};
TYN_ASSERT_SIZE(vpl_bounce_args, 4);

struct vpl_distances_args {
    tyn_uint later;    // 1: only of the VPLs that were added last
    tyn_uint bounce;   // 1: what they light is put into bins
    float solid_angle; // of a texel in the middle of a map, sr
    tyn_uint media;
};
TYN_ASSERT_SIZE(vpl_distances_args, 16);
