// vpl_args.h -- what the kernels of pass vpl hand each other. Included by C and GLSL; scalar layout.
//
// Everything that may become a VPL is an element: a texel of a reflective shadow map, or one side of a
// triangle. Elements are in blocks of VPL_BLOCK; a map's run along its Hilbert curve.
#include "shaders/common/shared.h"
#include "shaders/light/rsm_args.h"

#define VPL_BLOCK 256
#define VPL_LANES 32                     // threads for a block: few, as they wait for each other
#define VPL_MAX_SOURCES (4 + 64 + 2 + 2) // suns, lamps, sides under the sky, sides that emit

struct vpl_tile {
    TYN_STRUCT(rsm_tile) map;
    tyn_uint first; // block
};
TYN_ASSERT_SIZE(vpl_tile, 20);

struct vpl_plan {
    tyn_uint num_blocks;
    tyn_uint num_tiles;
    tyn_uint front; // block from which on elements are fronts of triangles
    tyn_uint back;  // ... are backs; num_blocks: none
    tyn_uint num_sources;
    tyn_uint num_triangles;
    tyn_uint sources[VPL_MAX_SOURCES]; // first blocks: of each light's maps, of fronts, of backs
    TYN_STRUCT(vpl_tile) tiles[TYN_RSM_MAX_TILES];
};
TYN_ASSERT_SIZE(vpl_plan, 24 + 288 + 20 * 390);

// A VPL stands for the elements with cumulated weights in [from, to), partly where they reach beyond,
// and lies on the surface of the element at the weight `at`.
struct vpl_stratum {
    float from, to, at;
};
TYN_ASSERT_SIZE(vpl_stratum, 12);

struct vpl_args {
    tyn_uint count; // VPLs at most
    tyn_uint num_suns;
    tyn_uint media; // 1: there is a medium
    tyn_uint
        append; // 1: VPLs are added to those that are there; 2: in place of those that were added last
    tyn_vec3 near_lo, near_hi; // M: VPLs are close together near this box
    float sky_irradiance;      // on an open plane, summed over channels, W/m^2
};
TYN_ASSERT_SIZE(vpl_args, 44);
