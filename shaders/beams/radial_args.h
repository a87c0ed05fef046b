// radial_args.h -- local lights and their grids. Included by C and GLSL; scalar layout.
//
// A local light shines from a point: a lamp of the scene, or a virtual point light (VPL). Its grid has an
// octahedral map of directions times shells around the light. Structs are whole rows of four words, so that
// they can be read as texels.
#ifndef TYN_RADIAL_ARGS_H
#define TYN_RADIAL_ARGS_H
#include "shaders/light/light_args.h"

#define TYN_RADIAL_LAMPS_MAX 64
#define TYN_RADIAL_VPLS_MAX 256

struct radial_vpls { // storage buffer "vpls"; the tail beyond `count` is not read
    tyn_uint count;  // 0 to TYN_RADIAL_VPLS_MAX
    tyn_uvec3 pad;
    TYN_STRUCT(light_block) list[TYN_RADIAL_VPLS_MAX];
};
TYN_ASSERT_SIZE(radial_vpls, 16400);

// A light and where in the textures its grid is. Nodes are the centres of texels; there is one more row of
// texels around each map, of what lies beyond the folded edges. Node k of a direction is at the distance
// begin + near (e^(k per_shell) - 1): even around the light, exponential farther away than `near`.
struct radial_grid {
    TYN_STRUCT(light_block) light;
    tyn_vec3 to_map
        [3]; // rows: M direction -> direction of the map, not normalised: narrow light and boxes
             // that are far away get most of the map
    tyn_vec3 base;      // texture coordinate of octahedral coordinate (0, 0), distance 0
    tyn_vec3 scale;     // per octahedral coordinate and per ln(1 + (r - begin) / near)
    tyn_uvec3 first;    // texel of the tile's border
    tyn_uint cells;     // of the map along each side, without the border
    tyn_uint shells;    // nodes along a direction, less one
    float begin;        // where the medium's box begins, m
    float inverse_near; // 1/m
    float per_shell;    // ln(1 + (r - begin) / near) from node to node
    tyn_uint inside;    // 1: the light is in the medium's box
};
TYN_ASSERT_SIZE(radial_grid, 160);

struct radial_block { // storage buffer "radials": lamps first, the strongest first of all
    tyn_uint count;
    tyn_uint num_lamps;
    tyn_uvec2 pad;
    TYN_STRUCT(radial_grid) list[TYN_RADIAL_LAMPS_MAX + TYN_RADIAL_VPLS_MAX];
};
TYN_ASSERT_SIZE(radial_block, 51216);

#endif
